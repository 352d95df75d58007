#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Sequences: frames are shown alike, the same in one go, in parts and on any number of threads; what
# becomes of frames that are not there, cannot be read or are made already.
# Usage: sequence.sh PROGRAM OIIOTOOL SCRATCH
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"

# A cube of 8x8x8 voxels of value 100, from frame to frame in a larger volume with a brighter voxel
# farther away.
make_frame() { # NUMBER SIDE VALUE
    local file=f_$2x$2x$2_uint8.raw y z
    local row='\144\144\144\144\144\144\144\144'
    head -c $(($2 * $2 * $2)) /dev/zero >"$file"
    for z in 0 1 2 3 4 5 6 7; do
        for y in 0 1 2 3 4 5 6 7; do
            printf "$row" | dd of="$file" bs=1 seek=$(((z * $2 + y) * $2)) conv=notrunc status=none
        done
    done
    printf "\\$(printf %o "$3")" |
        dd of="$file" bs=1 seek=$(($2 * $2 * $2 - 1)) conv=notrunc status=none
    "$program" convert "$file" "in.$1.vdb" --background 0 -qq
}
make_frame 0008 10 110
make_frame 0009 14 160
make_frame 0010 20 255
frames=(render in.####.vdb --frames 8-10 --size 48x48 -qq)
ran() { # LIKE: frames made with other options are the same, byte for byte
    for number in 0008 0009 0010; do
        same "all.$number.exr" "$1.$number.exr" ||
            fail "$1.$number.exr is not all.$number.exr"
    done
}

# Nothing changes but what changes in the data: the cube is where it was, and as bright.
"$program" "${frames[@]}" -o all.####.exr
expect_files "all.0008.exr all.0009.exr all.0010.exr" 'all.*'
cube=10x10+4+34
"$program" "${frames[@]}" -o lit.####.exr --shade
for name in all lit; do
    for number in 0008 0009; do
        "$oiiotool" -q $name.$number.exr --cut $cube $name.0010.exr --cut $cube --fail 0 --diff \
            >/dev/null || fail "$name: frame $number shows the cube otherwise than frame 0010"
    done
done
[[ $("$oiiotool" all.0010.exr --cut $cube --printstats | grep -c "Stats Max: 0.000000") == 0 ]] ||
    fail "the cube is not where it is looked for"
"$program" render in.0008.vdb --size 48x48 -qq -o alone.exr
! same alone.exr all.0008.exr ||
    fail "got a frame as it is by itself; expected what it is in the sequence"

# So are the greys of values, each picture's own or those of all.
greys=(render in.####.vdb --size 48x48 -qq)
for mode in mip xray; do
    "$program" "${greys[@]}" --frames 8-10 --mode $mode -o $mode.####.png --first-pass $mode.json
    for number in 0008 0009; do
        "$oiiotool" -q $mode.$number.png --cut $cube $mode.0010.png --cut $cube --fail 0 --diff \
            >/dev/null || fail "--mode $mode: frame $number has other greys than frame 0010"
    done
    "$program" "${greys[@]}" --frames 9 --mode $mode -o task.####.png --first-pass $mode.json
    same task.0009.png $mode.0009.png || fail "--mode $mode: a task has other greys than all"
    "$program" render in.0008.vdb --size 48x48 -qq --mode $mode -o alone.png
    ! same alone.png $mode.0008.png || fail "--mode $mode: got greys of one frame, not of all"
done

# Depths are counted from one place, though each frame by itself begins where its volume does.
"$program" "${frames[@]}" --aov depth -o far.####.exr
depth() { "$oiiotool" -q "$1" --ch Z --cut 1x1+9+39 --printstats | awk '/Avg/ { printf "%.2f", $3 }'; }
[[ $(depth far.0008.exr) == 15.95 && $(depth far.0010.exr) == 15.95 ]] || fail "the cube is farther away in frame 10"
# What is each frame's own is said.
expect_code 0 "$program" render in.####.vdb --frames 8-10 --size 8x8 --color-by z -o own.####.png
expect_said "deltasplat: warning: --color-by z: colours span each frame's own voxels, so that what stands still may change from frame to frame"
expect_code 0 "$program" render in.####.vdb --frames 8-10 --size 8x8 --mode mip --depth-shade 0.5 -o own.####.png
expect_said "deltasplat: warning: --depth-shade: spans each frame's own voxels, so that what stands still may change from frame to frame"
# The log and the first pass are no pictures.
expect_code 2 "$program" render in.0008.vdb -o one.png --log one.png
expect_said "deltasplat: --output: got one.png; expected another file than --log"
expect_code 2 "$program" render in.####.vdb --frames 8-9 --first-pass p.0008.png -o p.####.png
expect_said "deltasplat: --output: got p.0008.png; expected another file than the first pass"
# Names of any frame are looked at before one is made, and a log that is none does not stay.
expect_code 2 "$program" render in.####.vdb --frames 8-10 --size 8x8 -o q.####.png --first-pass q.0009.png
expect_said "deltasplat: --output: got q.0009.png; expected another file than the first pass"
expect_code 2 "$program" render in.####.vdb --frames 8-10 --size 8x8 -o q.####.png --log q.0009.png
expect_said "deltasplat: --output: got q.0009.png; expected another file than --log"
expect_code 2 "$program" render in.####.vdb --frames 8-10 --size 8x8 -o q.png --contact-sheet 3x1 --first-pass q.png
expect_code 2 "$program" render in.####.vdb --frames 8-10 --size 8x8 -o q.####.png --stats q.####.json --first-pass q.0010.json
expect_said "deltasplat: --stats: got q.0010.json; expected another file than the first pass"
expect_code 2 "$program" render in.####.vdb --frames 8-10 --first-pass q.json --log q.json
expect_code 2 "$program" convert in.0008.vdb q.vdb --log q.vdb
expect_code 2 "$program" convert in.####.vdb q.####.vdb --frames 8-10 --log q.0010.vdb
expect_files "" 'q.*'
# What reading warns of is said of the first frame whose file it is about.
cp in.0009.vdb two.0009.vdb
"$program" synth fire two.0008.vdb --dims 16x16x16 -qq
expect_code 0 "$program" render two.####.vdb --frames 8-9 --size 8x8 -o q.####.png
expect_said 'deltasplat: warning: frame 8: two.0008.vdb: reading grid "density" of 3 scalar grids (--grid chooses another)'
expect_code 0 "$program" render two.####.vdb --frames 8-9 --size 8x8 --first-pass q.json
expect_said 'deltasplat: warning: frame 8: two.0008.vdb: reading grid "density" of 3 scalar grids (--grid chooses another)'
# Nothing to be done again but what is not there.
"$program" render in.####.vdb --frames 8-9 --size 8x8 -qq -o q.####.png --stats q.####.json
rm q.0009.json
"$program" render in.####.vdb --frames 8-9 --size 8x8 -qq -o q.####.png --stats q.####.json --skip-existing
[[ -s q.0009.json ]] || fail "--skip-existing: got no stats that were not there"
mv in.0009.vdb away.vdb
expect_code 0 "$program" render in.####.vdb --frames 8-9 --size 8x8 -qq -o q.####.png --skip-existing
mv away.vdb in.0009.vdb
rm q.* two.*
# What stands still is shown as it is by itself, the ramp that its values are fitted to included.
"$program" synth cloud still.vdb --dims 32x32x32 -qq
"$program" render still.vdb --size 48x48 --frame-width 40 -qq -o still.exr
"$program" render still.vdb --size 48x48 --frame-width 40 -qq --turntable 4 --frames 1 --first-pass q.json -o q.#.exr
same still.exr q.1.exr || fail "got a frame of a turntable other than the picture that it begins with"
"$program" render still.vdb --size 48x48 --frame-width 40 -qq --turntable 4 --frames 1 --first-pass q.json -o q.#.exr
same still.exr q.1.exr || fail "got another frame of a turntable by its first pass"
rm q.* still.*
# A variable that is not set is no value, and takes no other's place.
for option in --log --threads; do
    expect_code 2 "$program" $option= render in.0008.vdb -o q.png --size 8x8
    grep -q "^deltasplat: $option: got nothing; expected " stderr.txt || fail "$option= before: got $(cat stderr.txt)"
    expect_code 2 "$program" $option "" render in.0008.vdb -o q.png --size 8x8
done
for option in --camera --tf --stats --log --grid --first-pass --threads; do
    expect_code 2 "$program" render in.0008.vdb -o q.png --size 8x8 $option= --shade
    grep -q "^deltasplat: $option: got nothing; expected " stderr.txt ||
        fail "$option=: got $(cat stderr.txt)"
    # Grids may have no name, but of these files none has none.
    code=2
    if [[ $option == --grid ]]; then code=3; fi
    expect_code $code "$program" render in.0008.vdb -o q.png --size 8x8 $option ""
done
expect_files "" 'q.*'
expect_code 2 "$program" render in.0008.vdb -o p.####.png
expect_said "deltasplat: --output: got p.####.png without --frames; expected --frames with it, as in --frames 1-100"
expect_code 2 "$program" convert in.0008.vdb 'p.$F4.vdb'
expect_said 'deltasplat: OUTPUT: got p.$F4.vdb without --frames; expected --frames with it, as in --frames 1-100'
mkdir 'job##1'
for name in at@home.png 'job##1/pic#2.png' '50%done.png'; do
    expect_code 0 "$program" render in.0008.vdb -o "$name" -qq --size 8x8
done
expect_code 2 "$program" convert in.0008.vdb run.vdb --log run.vdb
expect_said "deltasplat: OUTPUT: got run.vdb; expected another file than --log"

# Whatever the threads, the order, the names, and which task of a farm has which.
"$program" "${frames[@]}" -o two.%04d.exr --threads 2
ran two
"$program" "${frames[@]}" -o one.@@@@.exr --threads 1
ran one
"$program" "${frames[@]}" --frames 10-8 -o 'turned.$F4.exr'
ran turned
"$program" "${frames[@]}" --first-pass first.json --frames 8-10 -o part.####.exr
rm part.*
for number in 8 9 10; do
    "$program" "${frames[@]}" --first-pass first.json --frames $number -o part.####.exr
done
ran part
# The look at all frames by itself.
"$program" "${frames[@]}" --first-pass alone.json
cmp alone.json first.json || fail "alone.json is not first.json"
"$program" "${frames[@]}" --first-pass alone.json
# Of other frames, or another thing, it is taken all the same, which is said.
"$program" render in.####.vdb --size 48x48 -qq --frames 8-9 --first-pass few.json
expect_code 0 "$program" render in.####.vdb --size 48x48 --frames 8-10 --first-pass few.json -o few.####.exr
expect_said "deltasplat: warning: --first-pass: few.json was made without frame 10, and is taken as it is"
expect_code 0 "$program" render in.####.vdb --size 48x48 --frames 8-9 --first-pass few.json -o few.####.exr --crop 0:5,:,:
expect_said 'deltasplat: warning: --first-pass: few.json was made with no options that choose what is read, and is taken as it is for "--crop 0:5,:,:"'
# Files of it that others have written are read with care.
few=(render in.####.vdb --size 8x8 --frames 8-9 -o few.####.exr --first-pass)
printf '{"deltasplat_first_pass":%s}' "$(printf '[%.0s' {1..200000}; printf ']%.0s' {1..200000})" >deep.json
expect_code 3 "$program" "${few[@]}" deep.json
expect_said "deltasplat: deep.json: got JSON of more than 32 levels; expected what --first-pass has written"
mkfifo pipe.json
expect_code 3 timeout 60 "$program" "${few[@]}" pipe.json
expect_said "deltasplat: pipe.json: got no regular file; expected a readable file"
{ printf '{"deltasplat_first_pass":['; head -c 4000000 /dev/zero | sed 's/\x0/1,/g'; printf '1]}'; } >wide.json
expect_code 1 "$program" "${few[@]}" wide.json --max-memory 200M
grep -q '^deltasplat: wide.json: needs .* of memory; expected at most .*, which --max-memory leaves' stderr.txt ||
    { cat stderr.txt; fail "wide.json is read without asking for memory"; }

# Where the number stands in a folder's name, links of such folders lead out of none.
mkdir -p up secret
cp in.0008.vdb secret/x.vdb
mkdir up/0009
cp in.0009.vdb up/0009/x.vdb
ln -s ../secret up/0008
expect_code 0 "$program" info 'up/####/x.vdb' --frames 8-9
expect_code 3 "$program" info 'up/####/x.vdb' --frames 8-9 --confine
expect_said "deltasplat: up/0008/x.vdb: got a folder outside of up, in which the pattern looks; expected folders inside of it (--confine)"
expect_code 0 "$program" info 'up/####/x.vdb' --frames 9 --confine

"$program" render in.####.vdb --size 48x48 -qq --frames 8-9 --first-pass made/here/few.json
[[ -s made/here/few.json ]] || fail "--first-pass: got no folder for it"
cp in.0008.vdb other.0008.vdb
expect_code 0 "$program" render other.####.vdb --size 48x48 --frames 8 --first-pass few.json -o few.####.exr
expect_said "deltasplat: warning: --first-pass: few.json was made of in.####.vdb, and is taken as it is for other.####.vdb"
# The same names in another folder may be another thing.
mkdir elsewhere
cp in.0009.vdb elsewhere/in.0008.vdb
expect_code 0 "$program" render elsewhere/in.####.vdb --size 48x48 --frames 8 --first-pass few.json -o few.####.exr
expect_said "deltasplat: warning: --first-pass: few.json was made of another in.0008.vdb than there is now, and is taken as it is"
cp in.0008.vdb elsewhere/in.0008.vdb
expect_code 0 "$program" render elsewhere/in.####.vdb --size 48x48 --frames 8 --first-pass few.json -o few.####.exr
! grep warning stderr.txt || fail "warned of a first pass of the same files in another folder"
expect_code 2 "$program" render in.0008.vdb --first-pass no.json
expect_said "deltasplat: --first-pass: got it without --frames; expected the frames of a sequence"
expect_code 3 "$program" "${greys[@]}" --frames 8 --mode mip --first-pass first.json -o g.####.png
said="deltasplat: first.json: got no values of black and white; expected what --first-pass has"
expect_said "$said written with the same --mode"
echo '{}' >other.json
expect_code 3 "$program" "${frames[@]}" --first-pass other.json -o part.####.exr
expect_said "deltasplat: other.json: got something else; expected what --first-pass has written"
for runs in '[[]]' '[[8]]' '[]' '{}' '[[8,1e300]]' '[[10,8]]'; do
    tr -d '\n ' <first.json | sed "s/\"frames\":\[\[8,10\]\]/\"frames\":$runs/" >other.json
    ! cmp -s <(tr -d '\n ' <first.json) other.json || fail "got no other frames: $runs"
    expect_code 3 "$program" "${frames[@]}" --first-pass other.json -o part.####.exr
    expect_said "deltasplat: other.json: got something else; expected what --first-pass has written"
done

# Frames without a file.
gaps=(render in.####.vdb --frames 7-12 --size 8x8)
expect_code 3 "$program" "${gaps[@]}" -o a.####.png --keep-going
expect_files "a.0008.png a.0009.png a.0010.png" 'a.*'
expect_said "deltasplat: 3 of 6 frames failed: 7, 11, 12"
expect_said "deltasplat: frame 7: in.0007.vdb: got no such file; expected a readable file"
expect_code 0 "$program" "${gaps[@]}" -o b.####.png --missing skip
expect_files "b.0008.png b.0009.png b.0010.png" 'b.*'
expect_said "deltasplat: warning: --missing: 3 of 6 frames have no file and are left out"
expect_code 0 "$program" "${gaps[@]}" -o c.####.png --missing hold
same c.0007.png c.0008.png || fail "frame 7 does not show the next"
same c.0012.png c.0010.png || fail "frame 12 does not show the one before"
# A task of a farm knows by the first pass what the frame before its own shows, and may have nothing
# to do.
"$program" "${gaps[@]}" -o h.####.exr --missing hold -qq --first-pass gaps.json
for number in 7 12; do
    "$program" "${gaps[@]}" --frames $number -o i.####.exr --missing hold -qq --first-pass gaps.json
done
same i.0012.exr h.0012.exr || fail "frame 12 by itself does not show the one before"
same i.0007.exr h.0007.exr || fail "frame 7 by itself does not show the next"
expect_code 0 "$program" "${gaps[@]}" --frames 12 -o j.####.exr --missing skip --first-pass gaps.json
expect_files "" 'j.*'
expect_said "deltasplat: warning: --missing: 1 of 1 frames have no file and are left out"
expect_code 3 "$program" "${gaps[@]}" --frames 12 -o j.png --contact-sheet 1x1 --missing skip --first-pass gaps.json
# What is black is stored as the others are.
"$program" "${gaps[@]}" -o k.####.exr --missing black -qq --pixel-aspect 2 --region 4x3+2+1
header() { "$oiiotool" --info -v "$1" | grep -E 'x +[0-9]+,|PixelAspect|worldTo|origin|full'; }
[[ $(header k.0007.exr | sed 's/^[^:]*//') == $(header k.0008.exr | sed 's/^[^:]*//') ]] ||
    fail "k.0007.exr has another header than k.0008.exr"
expect_code 3 "$program" render none.####.vdb --frames 1-3 -o d.####.png --missing skip
expect_code 3 "$program" render none.####.vdb --frames 1-3 -o d.####.png

# The look at all frames by itself is as strict, and counts them.
look=(render in.####.vdb --frames 7-12 --size 8x8 --first-pass look.json)
expect_code 3 "$program" "${look[@]}"
expect_said "deltasplat: in.0007.vdb: got no such file (3 of 6 frames have none); expected one of each, or --missing skip, hold or black"
expect_files "" 'look.json'
expect_code 3 "$program" "${look[@]}" --keep-going
expect_said "deltasplat: 3 of 6 frames failed: 7, 11, 12"
expect_files "look.json" 'look.json'
mv look.json kept.json
expect_code 0 "$program" "${look[@]}" --missing skip
expect_said "deltasplat: warning: --missing: 3 of 6 frames have no file and are left out"
cmp look.json kept.json || fail "look.json is another one with --missing skip"

# A frame that cannot be read.
cp in.0009.vdb whole.vdb
head -c 200 whole.vdb >in.0009.vdb
expect_code 3 "$program" "${frames[@]}" -o e.####.png --threads 1
expect_files "e.0008.png" 'e.*'
expect_said "deltasplat: 1 of 3 frames failed: 9; 1 was not tried"
expect_code 3 "$program" "${frames[@]}" --first-pass look2.json --threads 1
expect_said "deltasplat: 1 of 3 frames failed: 9; 1 was not tried"
expect_files "" 'look2.json'
expect_code 3 "$program" "${frames[@]}" -o e.####.png --keep-going
expect_files "e.0008.png e.0010.png" 'e.*'
expect_code 3 "$program" "${frames[@]}" -o part/####/e.png --keep-going
expect_files "part/0008 part/0010" 'part/*'
# A first pass names the frames that it has read.
expect_code 3 "$program" "${frames[@]}" --first-pass look2.json --keep-going
grep -q '"frames":\[\[8,8\],\[10,10\]\]' <<<"$(tr -d ' \n' <look2.json)" || fail "look2.json: got other frames"
rm look2.json
mv whole.vdb in.0009.vdb

# Folders of pictures are made, as for batches.
"$program" "${frames[@]}" -o made/by/####/e.png --stats made/s/####.json
expect_files "made/by/0008/e.png made/by/0009/e.png made/by/0010/e.png" 'made/by/*/*'
expect_files "made/s/0008.json made/s/0009.json made/s/0010.json" 'made/s/*'

# What is there stays, if it is whole.
cp e.0008.png kept.png
cp e.0010.png e.0009.png
cp e.0009.png other.png
head -c 300 e.0010.png >short && mv short e.0010.png
"$program" "${frames[@]}" -o e.####.png --skip-existing
cmp e.0008.png kept.png
cmp e.0009.png other.png
[[ $("$oiiotool" --info e.0010.png) ]] || fail "e.0010.png was not made anew"
# What is older than its input is made anew.
cp kept.png e.0009.png
touch -d '2001-01-01' e.0008.png e.0009.png e.0010.png
touch -d '2000-01-01' in.0008.vdb
"$program" "${frames[@]}" -o e.####.png --update
[[ e.0008.png -ot in.0010.vdb ]] || fail "e.0008.png was made anew"
! cmp -s e.0009.png kept.png || fail "e.0009.png was not made anew"

# Of cameras that are a file each, one that is not there costs its frame.
for number in 0008 0010; do cp all.$number.exr eye.$number.exr; done
expect_code 3 "$program" render in.####.vdb --frames 8-10 --camera eye.####.exr --size 48x48 -o seen.####.exr --keep-going
expect_files "seen.0008.exr seen.0010.exr" 'seen.*'
expect_said "deltasplat: 1 of 3 frames failed: 9"
expect_code 3 "$program" render in.####.vdb --frames 8-10 --camera eye.####.exr --size 48x48 -o none.####.exr
expect_files "" 'none.*'

# A transfer function for each frame shows one volume, read once, as each of them shows it by itself.
for frame in 1 2 3 4; do
    # Frames 1, 2 and 4 show the same voxels, and 3 others.
    echo "[{\"Name\": \"fade\", \"Points\": [0.$((frame == 3)), 0, 0.5, 0, 1, 0.0$frame, 0.5, 0],
        \"RGBPoints\": [0, 1, 0.$frame, 0, 1, 0.2, 1, 0.5]}]" >fade.$frame.json
done
faded=(render in.0010.vdb --size 48x48 -qq --range 0,1 --tf)
"$program" "${faded[@]}" fade.#.json --frames 1-4 -o faded.#.exr --stats faded.#.json
for frame in 1 2 3 4; do
    "$program" "${faded[@]}" fade.$frame.json -o alone.exr
    expect_same faded.$frame.exr alone.exr
    ! same faded.$frame.exr faded.$((frame % 4 + 1)).exr || fail "frames $frame and the next are one picture"
done
rm fade.1.json faded.*.exr
code=0
"$program" "${faded[@]}" fade.#.json --frames 1-4 -o faded.#.exr --keep-going 2>said.txt || code=$?
[[ $code == 3 ]] || fail "a frame without a transfer function: got exit code $code; expected 3"
expect_files "faded.2.exr faded.3.exr faded.4.exr" 'faded.*.exr'
expect_same faded.4.exr alone.exr
# Nor does one that cannot be read cost the others their pictures.
rm faded.*.exr
echo '[{"Name": "fade"' >fade.1.json
expect_code 3 "$program" "${faded[@]}" fade.#.json --frames 1-4 -o faded.#.exr --keep-going
expect_said "deltasplat: 1 of 4 frames failed: 1"
expect_files "faded.2.exr faded.3.exr faded.4.exr" 'faded.*.exr'
expect_same faded.4.exr alone.exr
# Functions may be those of a name in each file, and the name of one may have a number sign.
for number in 0008 0009 0010; do
    echo "[{\"Name\": \"none\", \"Points\": [0, 0, 0.5, 0], \"RGBPoints\": [0, 1, 1, 1]},
        {\"Name\": \"no #1\", \"Points\": [0, 0, 0.5, 0, 255, 0.2, 0.5, 0],
        \"RGBPoints\": [0, 1, 1, 1]}]" >both.$number.json
    sed "s/no #1/shown/" both.$number.json >shown.$number.json
done
named=(render in.####.vdb --frames 8-10 --size 48x48)
"$program" "${named[@]}" -qq --tf "both.0008.json:no #1" -o named.####.exr
"$program" "${named[@]}" -qq --tf shown.####.json:shown -o shown.####.exr
"$program" "${named[@]}" -qq --tf "both.####.json:no #1" -o both.####.exr
for number in 0008 0009 0010; do expect_same both.$number.exr named.$number.exr; done
for number in 0008 0009 0010; do expect_same shown.$number.exr named.$number.exr; done
# Frames that have none have not been looked at.
mv shown.0009.json away.json
"$program" "${named[@]}" -qq --tf shown.####.json:shown --first-pass shown.json
mv away.json shown.0009.json
expect_code 0 "$program" "${named[@]}" --tf shown.####.json:shown --first-pass shown.json -o shown.####.exr
expect_said "deltasplat: warning: --first-pass: shown.json was made without frame 9, and is taken as it is"

# A turn: every frame is as wide, and one of it is the one of all.
turn=(render in.0010.vdb --size 48x48 -qq --turntable 8)
"$program" "${turn[@]}" -o turn.#.exr
expect_files "turn.1.exr turn.2.exr turn.3.exr turn.4.exr turn.5.exr turn.6.exr turn.7.exr turn.8.exr" 'turn.*'
"$program" "${turn[@]}" --frames 3 -o quarter.#.exr
same quarter.3.exr turn.3.exr || fail "frame 3 is another one by itself"
widths=$(for i in 1 2 3 4 5 6 7 8; do
    "$oiiotool" --info -v turn.$i.exr | grep -o 'frame-width [0-9.e+-]*'; done | sort -u | wc -l)
[[ $widths == 1 ]] || fail "got frames of $widths widths; expected one"

# A frame that has not changed is the same picture, alone and behind others.
make_spot() { # NUMBER VALUES
    local file=spot.$1_24x40x40_uint8.raw
    head -c 38400 /dev/zero | tr '\0' '\144' >"$file"
    printf "$2" | dd of="$file" bs=1 seek=20000 conv=notrunc status=none
}
make_spot 0001 '\144'
make_spot 0002 '\310\310\310'
make_spot 0003 '\310\310\310'
spots=(render spot.####_24x40x40_uint8.raw --size 48x64 --range 0,255 --extinction 0.05)
"$program" "${spots[@]}" -o spot.####.exr --frames 1-3 --first-pass spot.json -qq
for number in 1 2 3; do
    "$program" "${spots[@]}" -o spot_alone.####.exr --frames $number --first-pass spot.json -qq
    same spot.000$number.exr spot_alone.000$number.exr || fail "frame $number is another one behind others"
done
same spot.0003.exr spot.0002.exr || fail "frame 3 is not the one before"
! same spot.0002.exr spot.0001.exr || fail "frame 2 does not show its spot"

# What cannot be meant.
usage() { # MESSAGE ARGUMENTS...
    expect_code 2 "$program" render "${@:2}"
    expect_said "deltasplat: $1"
}
usage "--frames: got 1-; expected frames such as 1-100, 1-100x2, 100-1, -5--1 or 1,4,10-20" \
    in.####.vdb -o g.####.png --frames 1-
usage "--frames: got 1-5x0; expected frames such as 1-100, 1-100x2, 100-1, -5--1 or 1,4,10-20" \
    in.####.vdb -o g.####.png --frames 1-5x0
usage "--frames: got 1-9999999; expected at most 1000000 frames" \
    in.####.vdb -o g.####.png --frames 1-9999999
usage 'g.####.foo: got extension ".foo"; expected .exr, .png, .tif or .jpg (numbers: .npy, .nrrd or .mha)' \
    in.####.vdb -o g.####.foo --frames 8-9
usage "INPUT: got in.0008.vdb with --frames; expected a name with ####, %04d, @ or \$F4 for the number" \
    in.0008.vdb -o g.####.png --frames 8-9
usage "--output: got g.png with --frames; expected a name with ####, %04d, @ or \$F4 for the number, such as g.####.png" \
    in.####.vdb -o g.png --frames 8-9
usage "INPUT: got in.####.vdb without --frames; expected --frames with it, as in --frames 1-100" \
    in.####.vdb -o g.png
usage "--keep-going: got it without --frames; expected the frames of a sequence" \
    in.0008.vdb -o g.png --keep-going
usage "--first-pass: got it without --frames; expected the frames of a sequence" \
    in.0008.vdb -o g.png --first-pass g.json
usage "--stats: got s.json with --frames; expected a name with ####, %04d, @ or \$F4 for the number, such as s.####.json" \
    in.####.vdb -o g.####.png --frames 8-9 --stats s.json
expect_files "" 'g.*'
