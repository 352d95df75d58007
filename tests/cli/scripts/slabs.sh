#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Parts of a picture that processes render by themselves make the picture of one: its pixels, and
# what it says of itself. Parts that do not belong together are told apart.
# Usage: slabs.sh PROGRAM OIIOTOOL SCRATCH
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"

"$program" synth cloud cloud.vdb --dims 48x40x56 --seed 2 -q
"$program" synth engine engine_48x40x32_uint8.raw --dims 48x40x32 -q

# By different numbers of threads, the last part first.
split() { # PARTS NAME ARGUMENTS...
    local i
    for ((i = $1; i > 0; --i)); do
        "$program" render "${@:3}" -o "$2.$i.slabs" --slab-range "$i/$1" --threads "$i" -qq
    done
}
pixels() { "$oiiotool" --info --hash "$1" | sed -n 's/^ *SHA-1: //p'; }
equal() { # A B
    [[ $(pixels "$1") == "$(pixels "$2")" ]] || fail "$1 and $2: got other pixels"
}

scene=0
folds() { # ARGUMENTS...: as one process renders it
    scene=$((scene + 1))
    "$program" render "$@" -o "one$scene.exr" --float -qq
    split 3 "part$scene" "$@"
    "$program" fold part$scene.*.slabs -o "all$scene.exr" --float -qq
    equal "one$scene.exr" "all$scene.exr"
}
ball=(engine_48x40x32_uint8.raw --tf viridis --size 60x50)
cloud=(cloud.vdb --size 60x50)
folds "${cloud[@]}" --view iso
"$program" fold "part$scene.?.slabs" -o pattern.exr --float -qq
equal all$scene.exr pattern.exr
info=$("$program" info part$scene.1.slabs 2>&1 || true)
[[ $info == *"(fold reads .slabs)" ]] || fail "info of a part: got $info; expected to be told what reads it"
folds "${cloud[@]}" --projection perspective --view left --distance 50 --near 20
folds "${ball[@]}" --azimuth 30
folds "${ball[@]}" --projection perspective --view iso --fov 60
folds "${ball[@]}" --projection latlong --size 64x32 --eye 20,20,16
folds "${ball[@]}" --method sparse --resolution 2 --between 1
folds "${ball[@]}" --method traditional --overscan 4,2
folds "${ball[@]}" --shade --tolerance 0.1 --crop 4:40,:,2:20
folds "${cloud[@]}" --lighting scatter --light 1,-1,0
folds "${cloud[@]}" --color-by index --filter gauss
"$program" synth fire fire.vdb --dims 32x32x32 --seed 3 -q
folds fire.vdb --grid density --size 60x50 --view iso --tf fire --emission-grid flame
folds fire.vdb --size 60x50 --projection perspective --tf fire --emission-grid temperature
# Parts by themselves know nothing of what others cover.
for view in front back "iso --projection perspective"; do
    # shellcheck disable=SC2086
    folds "${ball[@]}" --extinction 50 --view $view
done
grep -q 'pixel data origin: x=-4, y=-2' <<<"$("$oiiotool" --info -v one7.exr)" || fail "no overscan"

# Parts of a delta grid read all of it, as any others do.
"$program" synth engine tall_64x64x128_uint8.raw --dims 64x64x128 --noise 0.05 -q
"$program" delta tall_64x64x128_uint8.raw tall.vdb --axis z --key-interval 16 -q
folds tall.vdb --tf viridis --size 60x50 --view front
folds tall.vdb --tf viridis --size 60x50 --view left --shade
expect_code 2 "$program" render tall.vdb -o p.slabs --slab-range 1/3 --first-pass tall.json
expect_said "deltasplat: --slab-range: got --first-pass besides; expected it alone: each part reads the whole volume"

# What a picture says of how it was made, but for the command lines.
said() { "$oiiotool" --info -v "$1" | grep -v -e '^Reading' -e ommandLine -e "^$1"; }

# Of the same picture everything that fold is asked as well.
split 2 p "${ball[@]}"
same_files() { # OUTPUT OPTIONS...
    "$program" render "${ball[@]}" -o "one.$1" "${@:2}" -qq
    "$program" fold p.2.slabs p.1.slabs -o "all.$1" "${@:2}" -qq
    equal "one.$1" "all.$1"
    local got
    got=$(diff <(said "one.$1") <(said "all.$1")) || fail "all.$1 says something else: $got"
}
same_files png --background 0.2,0.3,0.4 --exposure 1 --tone filmic --bits 16
same_files tif --region 20x10+5+7
same_files jpg --background 1,1,1
same_files exr --autocrop --compression piz --background 0,0,0,0.5
same_files exr --region 20x10+5+7
expect_code 0 "$program" fold p.1.slabs p.2.slabs -o dull.exr --tone filmic
expect_said "deltasplat: warning: --tone: has no effect on an .exr, which holds light as it is"
grep -q 'partCommandLine: "deltasplat render .*--slab-range 1/2' <<<"$("$oiiotool" --info -v all.png)" ||
    fail "all.png does not say how its parts were made"

# The promise of a tolerance is the same.
tolerant=(cloud.vdb --size 40x40 --tolerance 0.1 --method delta)
split 2 t "${tolerant[@]}"
expect_code 0 "$program" render "${tolerant[@]}" -o one.exr --background 1,1,1 --float
cp stderr.txt one.txt
expect_code 0 "$program" fold t.1.slabs t.2.slabs -o all.exr --background 1,1,1 --float
[[ $(grep ^tolerance one.txt) == "$(grep ^tolerance stderr.txt)" ]] ||
    fail "got another tolerance: $(cat stderr.txt)"
equal one.exr all.exr

# The same parts, byte for byte, of any number of threads.
"$program" render "${ball[@]}" -o again.slabs --slab-range 1/2 --threads 2 -qq
[[ $(tail -c 1000 again.slabs | cksum) == "$(tail -c 1000 p.1.slabs | cksum)" ]] ||
    fail "got another part on another number of threads"
# Several parts at once are one.
"$program" render "${ball[@]}" -o q.1.slabs --slab-range 1-2/3 -qq
"$program" render "${ball[@]}" -o q.3.slabs --slab-range 3/3 -qq
"$program" fold q.1.slabs q.3.slabs -o q.exr -qq
"$program" render "${ball[@]}" -o r.exr -qq
equal q.exr r.exr

# Where files lie is not what they are.
mkdir elsewhere
cp engine_48x40x32_uint8.raw elsewhere/
(cd elsewhere && "$program" render "${ball[@]}" -o ../e.2.slabs --slab-range 2/2 -qq)
expect_code 0 "$program" fold p.1.slabs e.2.slabs -o e.exr -qq
equal e.exr r.exr

# What does not belong together.
refused() { # MESSAGE PARTS...
    rm -f refused.exr
    expect_code 3 "$program" fold "${@:2}" -o refused.exr
    expect_said "deltasplat: $1"
    [[ ! -e refused.exr ]] || fail "refused.exr is there"
}
refused "parts: got none with 2/2; expected all 2 of a picture" p.1.slabs
refused "parts: got none with 1/2; expected all 2 of a picture" p.2.slabs
refused "p.1.slabs: got part 1/2; expected each once, and p.1.slabs is part 1/2" \
    p.1.slabs p.1.slabs p.2.slabs
refused "q.3.slabs: got part 3/3; expected one of 2, as in p.1.slabs" p.1.slabs q.3.slabs
split 2 o "${ball[@]}" --azimuth 20
refused "o.2.slabs: got --azimuth 20; expected no --azimuth, as in p.1.slabs" p.1.slabs o.2.slabs
head -c 61000 engine_48x40x32_uint8.raw >other_48x40x32_uint8.raw
head -c 440 /dev/zero | tr '\0' '\377' >>other_48x40x32_uint8.raw
split 2 o other_48x40x32_uint8.raw "${ball[@]:1}"
refused "o.2.slabs: got a picture of other voxels or colours; expected the same, as in p.1.slabs" \
    p.1.slabs o.2.slabs
whole="a whole part of a picture's slabs"
head -c $(($(stat -c %s p.2.slabs) - 100)) p.2.slabs >short.slabs
refused "short.slabs: got a file cut short; expected $whole" p.1.slabs short.slabs
cp p.2.slabs bad.slabs
printf 'bad' | dd of=bad.slabs bs=1 seek=$(($(stat -c %s bad.slabs) - 200)) conv=notrunc status=none
refused "bad.slabs: got damaged layers; expected $whole" p.1.slabs bad.slabs
cp p.2.slabs head.slabs
printf 'bad' | dd of=head.slabs bs=1 seek=500 conv=notrunc status=none
refused "head.slabs: got a damaged header; expected $whole" p.1.slabs head.slabs
sed '1s/slabs [0-9]*/slabs 999/' p.2.slabs >version.slabs
refused "version.slabs: got a part that another version has written; expected one of this version" \
    p.1.slabs version.slabs
split 1 wide "${ball[@]}" --overscan 2
expect_code 2 "$program" fold wide.1.slabs -o wide.png
expect_said "deltasplat: --output: got wide.png; expected an .exr file, for its parts have --overscan"
expect_files "" '.deltasplat.*'
