#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Batches: a picture of each file that a pattern finds is the one that a command for it alone makes;
# what names of outputs say; what becomes of files that cannot be rendered or are rendered already;
# the page of all.
# Usage: batch.sh PROGRAM OIIOTOOL SCRATCH
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"
files_in() { (cd "$1" && find . -type f | LC_ALL=C sort | cut -c3- | tr '\n' ' ' | sed 's/ $//'); }
expect_tree() { # NAMES FOLDER
    local got
    got=$(files_in "$2")
    [[ $got == "$1" ]] || fail "got files $got in $2; expected $1"
}

mkdir -p shots/fire
"$program" synth cloud shots/a.1.vdb --dims 24x24x24 --seed 1 -qq
"$program" synth cloud shots/a.2.vdb --dims 30x20x24 --seed 2 -qq
"$program" synth explosion shots/fire/a.10.vdb --dims 24x24x24 -qq
small=(--size 40x32 -qq)

# Each is the picture that it is by itself, however many are made at once.
for threads in 1 2; do
    "$program" render 'shots/**/*.vdb' -o "all$threads/{dir}/{name}.exr" --threads $threads "${small[@]}"
    expect_tree "a.1.exr a.2.exr fire/a.10.exr" all$threads
done
"$program" render 'shots/**/*.vdb' -o "png/{dir}/{name}.png" --background 0.1,0.2,0.3 "${small[@]}"
for name in a.1 a.2 fire/a.10; do
    "$program" render "shots/$name.vdb" -o one.exr "${small[@]}"
    same one.exr all1/$name.exr || fail "$name is another picture by itself"
    same all2/$name.exr all1/$name.exr || fail "$name is another picture with other threads"
    "$program" render "shots/$name.vdb" -o one.png --background 0.1,0.2,0.3 "${small[@]}"
    same one.png png/$name.png || fail "$name.png is another picture by itself"
done
! same all1/a.1.exr all1/a.2.exr || fail "two volumes have one picture"
expect_metadata all1/a.2.exr input "shots/a.2.vdb"

# Confined, they lie in the folder before the first wildcard, whatever folders are links.
mkdir -p linked_to/own secret
cp shots/a.1.vdb secret/x.vdb
cp shots/a.1.vdb linked_to/own/y.vdb
ln -s ../secret linked_to/a
ln -s own linked_to/b
"$program" render 'linked_to/*/*.vdb' -o 'loose/{dir}.exr' "${small[@]}"
expect_tree "a.exr b.exr own.exr" loose
expect_code 3 "$program" render 'linked_to/*/*.vdb' -o 'bound/{dir}.exr' "${small[@]}" --confine
expect_said "deltasplat: linked_to/a/x.vdb: got a folder outside of linked_to, in which the pattern looks; expected folders inside of it (--confine)"
expect_tree "b.exr own.exr" bound
expect_code 0 "$program" render 'linked_to/a/*.vdb' -o 'bound/{name}.exr' "${small[@]}" --confine

# Names of outputs.
"$program" render 'shots/?.[12].vdb' -o 'frames/f.{frame}.exr' --stats 'stats/{name}.json' "${small[@]}"
expect_tree "f.1.exr f.2.exr" frames
expect_tree "a.1.json a.2.json" stats
grep -q '"method"' stats/a.2.json || fail "stats/a.2.json tells nothing"
"$program" render 'shots/fire/*.vdb' -o 'grids/{name}.{grid}.exr' "${small[@]}"
expect_tree "a.10.density.exr a.10.temperature.exr" grids
"$program" render shots/fire/a.10.vdb -o one.exr --grid temperature "${small[@]}"
same one.exr grids/a.10.temperature.exr || fail "the grid's picture is another one by itself"
"$program" render 'shots/fire/*.vdb' -o 'grid/{name}.{grid}.exr' --grid temperature "${small[@]}"
expect_tree "a.10.temperature.exr" grid
"$program" synth slab volume_8x8x8_uint8.raw --dims 8x8x8 -qq
"$program" render 'volume_*.raw' -o '{{{name}}}.png' "${small[@]}"
expect_files "{volume_8x8x8_uint8}.png" '{*.png'

# A name with wildcards that is there is no pattern.
cp shots/a.1.vdb 'x[1]*.vdb'
"$program" render 'x[1]*.vdb' -o one.exr "${small[@]}"
same one.exr all1/a.1.exr || fail "x[1]*.vdb was not rendered"

# What cannot be rendered does not keep the others from it, and all of it is told in the end.
cp -r shots broken
head -c 300 shots/a.1.vdb >broken/a.1.vdb
echo "no volume" >broken/note.txt
ln -s nowhere broken/gone.vdb
ln -s .. broken/fire/round
expect_code 3 "$program" render 'broken/**' -o 'made/{dir}/{name}.png' --size 40x32 \
    --background 0.1,0.2,0.3 --index made/index.html
expect_tree "a.2.png fire/a.10.png index.html" made
expect_said "deltasplat: 3 of 5 pictures failed: broken/a.1.vdb, broken/gone.vdb, broken/note.txt"
expect_said "deltasplat: broken/gone.vdb: got no such file; expected a readable file"
[[ $(grep -c 'no such file' stderr.txt) == 1 ]] || fail "a failure is said more than once"
page=made/index.html
[[ $(grep -c '<figure>' $page) == 2 && $(grep -c '<tr><td>' $page) == 3 ]] ||
    fail "$page has other pictures than two, or other failures than three"
grep -q '<tr><td>broken/gone.vdb</td><td>got no such file; expected a readable file</td></tr>' $page ||
    fail "$page does not say what is wrong with broken/gone.vdb"
dims=$("$program" info shots/a.2.vdb | sed -n 's/^ *dims *\([0-9]*\) x \([0-9]*\) x \([0-9]*\).*/\1×\2×\3/p')
grep -qF "<div class=\"quiet\">density, $dims<br>" $page || fail "$page does not say what a.2.vdb is"
# Its pictures are small copies of those that it leads to.
[[ $(grep -o 'href="[^"#]*"' $page | tr '\n' ' ') == 'href="a.2.png" href="fire/a.10.png" ' ]] ||
    fail "$page leads to other pictures"
grep -o 'base64,[^"]*' $page >links
head -1 links | cut -d, -f2 | base64 -d >thumbnail.jpg
"$oiiotool" -q made/a.2.png --ch R,G,B -o wanted.png
"$oiiotool" -q thumbnail.jpg wanted.png --fail 0.1 --failpercent 3 --diff >/dev/null ||
    fail "the thumbnail is another picture"
sed 's/base64,[^"]*//' $page >words
for word in http '<link' '@import' 'url(' "$scratch"; do
    ! grep -iF -- "$word" words || fail "the page holds '$word'"
done
for tag in html head body header main figure figcaption section table tr td div p a b span; do
    [[ $(grep -o "</$tag>" words | wc -l) == $(grep -oE "<$tag( [^>]*)?>" words | wc -l) ]] ||
        fail "closing tags of $tag are missing"
done

# Nor what leads to itself.
mkdir -p round/d1 round/d2/loop
ln -s loop round/d1/loop
cp shots/a.1.vdb round/d2/loop/x.vdb
expect_code 3 "$program" render 'round/d*/loop/x.vdb' -o 'rounds/{dir}.png' "${small[@]}"
expect_said "deltasplat: round/d1/loop: got Too many levels of symbolic links; expected a folder that can be read"
expect_tree "d2/loop.png" rounds

# Without what takes rights from root all folders can be read.
if setpriv --bounding-set=-dac_override,-dac_read_search --inh-caps=-dac_override,-dac_read_search \
    true 2>/dev/null || [[ $EUID != 0 ]]; then
    plain=()
    [[ $EUID != 0 ]] || plain=(setpriv --bounding-set=-dac_override,-dac_read_search
        --inh-caps=-dac_override,-dac_read_search)
    mkdir -p closed/in closed/out
    cp shots/a.1.vdb closed/out
    chmod 0 closed/in
    expect_code 3 "${plain[@]}" "$program" render 'closed/**/*.vdb' -o 'opened/{name}.png' "${small[@]}"
    expect_said "deltasplat: closed/in: got Permission denied; expected a folder that can be read"
    expect_tree "a.1.png" opened
    chmod 700 closed/in
else
    echo "no setpriv: no folder is closed"
fi

# What is there stays; the page has it all the same.
"$program" render 'shots/*.vdb' -o 'kept/{name}.png' "${small[@]}"
cp kept/a.1.png kept.png
cp kept.png kept/a.2.png
rm kept/a.1.png
"$program" render 'shots/*.vdb' -o 'kept/{name}.png' --index kept/index.html --skip-existing "${small[@]}"
same kept/a.1.png kept.png || fail "a.1.png was not made anew"
cmp kept/a.2.png kept.png
[[ $(grep -c '<img ' kept/index.html) == 2 && $(grep -c 'was there' kept/index.html) == 1 ]] ||
    fail "kept/index.html does not show what was there"
touch -d '2001-01-01' kept/a.2.png
"$program" render 'shots/*.vdb' -o 'kept/{name}.png' --update "${small[@]}"
! same kept/a.2.png kept.png || fail "a.2.png was not made anew"

# Names that are no text; values as greys.
mkdir odd
cp shots/a.1.vdb $'odd/a b<i>\n\xff".vdb'
"$program" render 'odd/*' -o 'odd/{name}.exr' --mode mip --index 'odd/page.html' "${small[@]}"
[[ -e $'odd/a b<i>\n\xff".exr' ]] || fail "odd names are changed"
grep -qF '<b>a b&lt;i&gt;??".vdb</b>' odd/page.html || fail "the odd name is not spelt out"
grep -qF 'href="a%20b%3Ci%3E%0A%FF%22.exr"' odd/page.html || fail "the odd name leads nowhere"
grep -o 'base64,[^"]*' odd/page.html | cut -d, -f2 | base64 -d >grey.jpg
holds "$(most grey.jpg | cut -d' ' -f1) > 200" || fail "values are not shown"

# All in one picture, and the names of files in each; a cell is empty where a file failed.
cells=(--size 40x32 --background 0.1,0.2,0.3 --dither 0 -qq)
"$program" render 'shots/**/*.vdb' -o 'cell/{name}.png' "${cells[@]}"
"$program" render 'shots/**/*.vdb' -o sheet.png --contact-sheet 2x2 "${cells[@]}"
for cell in a.1+0+0 a.2+40+0 a.10+0+32; do
    "$oiiotool" -q sheet.png --cut "40x32+${cell#*+}" -o cell.png
    same cell.png "cell/${cell%%+*}.png" || fail "cell $cell is not its picture"
done
expect_code 3 "$program" render 'broken/*.vdb' -o sheet.png --contact-sheet 2x2 "${cells[@]}"
"$oiiotool" -q sheet.png --cut 40x32+40+0 -o cell.png
same cell.png cell/a.2.png || fail "the second of the broken ones is not in its cell"
"$oiiotool" -q sheet.png --cut 40x32+0+0 -o cell.png
grep -q "Constant: Yes" <<<"$("$oiiotool" --stats cell.png 2>&1)" ||
    fail "the cell of what failed is not empty"
# The same whichever failed: a scene that comes first as well.
mkdir scenes
echo garbage >scenes/aa.usda
cp scenes/aa.usda scenes/zz.usda
cp shots/a.1.vdb scenes/b.vdb
expect_code 3 "$program" render 'scenes/*' -o sheet.png --contact-sheet 2x2 --size 40x32 --bits 16 \
    --background 0.1,0.2,0.3 --shade --mode mip
expect_said "deltasplat: warning: --shade: has no effect with --mode mip"
[[ $("$oiiotool" --info sheet.png) == *" 80 x   64, "* ]] || fail "sheet.png is no sheet of four"
"$program" render scenes/b.vdb -o one.png --bits 16 --mode mip --background 0.1,0.2,0.3 --size 40x32 -qq
"$oiiotool" -q sheet.png --cut 40x32+40+0 -o cell.png
same cell.png one.png || fail "the second of the scenes is not in its cell"
expect_code 3 "$program" render 'scenes/*' -o 'scene/{name}.png' --size 40x32 --index scene/index.html
expect_tree "b.png index.html" scene
expect_said "deltasplat: 2 of 3 pictures failed: scenes/aa.usda, scenes/zz.usda"
for name in aa zz; do
    grep -q "^deltasplat: scenes/$name.usda:1: got " stderr.txt || fail "$name.usda is not told of"
    [[ $(grep -c "scenes/$name.usda:1: got " stderr.txt) == 1 ]] || fail "$name.usda is told of twice"
done
"$program" render 'shots/a.?.vdb' -o 'slate/{name}.png' --slate "${cells[@]}" --size 160x120
"$program" render shots/a.2.vdb -o one.png --annotate a.2.vdb "${cells[@]}" --size 160x120
same one.png slate/a.2.png || fail "the name of the file is not drawn"

# A warning that is the same of several is said once, and counted.
for i in 3 4 5; do cp shots/a.1.vdb shots/b.$i.vdb; done
"$program" render 'shots/*.vdb' -o 'jpg/{name}.jpg' --size 40x32 2>stderr.txt
said='a .jpg has no alpha, so what is clear is black; --background gives it another colour'
[[ $(grep -c "^deltasplat: warning: shots/.*: $said" stderr.txt) == 1 && $(wc -l <stderr.txt) == 2 ]] ||
    fail "got $(cat stderr.txt); expected two lines"
expect_said "deltasplat: warning: 4 other pictures: $said"
"$program" render 'shots/a.?.vdb' -o 'jpg/{name}.png' --size 40x32 --exposure 3 2>stderr.txt
grep -q '^deltasplat: warning: 1 other picture, in other numbers: [0-9.]* % of the pixels' stderr.txt ||
    fail "got $(cat stderr.txt); expected to be told of how many pictures"
rm shots/b.*

# Volumes without active voxels are told apart.
mkdir empty
head -c 512 /dev/zero >zero_8x8x8_uint8.raw
"$program" convert zero_8x8x8_uint8.raw empty/a.1.vdb --background 0 -qq
for i in 2 3; do cp empty/a.1.vdb empty/a.$i.vdb; done
cp shots/a.1.vdb empty/b.1.vdb
empty=(render 'empty/*.vdb' -o 'empty/{name}.png' --size 40x32 --index empty/index.html)
expect_code 0 "$program" "${empty[@]}"
expect_said 'deltasplat: warning: 2 other pictures: grid "zero_8x8x8_uint8": no active voxels'
[[ $(wc -l <stderr.txt) == 2 ]] || fail "got $(cat stderr.txt); expected two lines"
for choice in "" --skip-existing; do
    "$program" "${empty[@]}" $choice 2>stderr.txt
    [[ $(grep -c 'no active voxels' empty/index.html) == 3 ]] ||
        fail "empty/index.html ($choice) does not say what is empty"
    grep -q '<p class="quiet">4 pictures, 3 of them empty' empty/index.html ||
        fail "empty/index.html ($choice) does not count what is empty"
done

# A program that is ended leaves the pictures that are there, no other file, and no page.
cp -r shots many
for i in {3..40}; do cp shots/a.1.vdb many/b.$i.vdb; done
mkfifo progress
env --default-signal=TERM "$program" render 'many/**' -o 'some/{dir}/{name}.png' --index some.html \
    --size 300x300 --method traditional --resolution 8 --sigma 2 --threads 1 --log some.log --progress 2>progress &
job=$!
exec 3<progress
while read -r line <&3 && [[ $line != "Progress: 10%" ]]; do :; done
kill -TERM $job
code=0
wait $job || code=$?
[[ $code == 143 ]] || fail "got exit code $code; expected 143"
rest=$(grep -v '^Progress: ' <&3 || true)
[[ $rest == "deltasplat: interrupted" ]] || fail "got $rest; expected to be told of the interrupt"
exec 3<&-
expect_files "" 'some.html'
[[ -z $(find some -name '.*' -type f) ]] || fail "temporary files are left"
pictures=(some/*.png)
# A tenth of 41 has been made, and not all.
((${#pictures[@]} >= 4 && ${#pictures[@]} < 41)) || fail "got ${#pictures[@]} pictures; expected some"
for picture in "${pictures[@]}"; do
    "$oiiotool" -q "$picture" -o whole.png || fail "$picture is not whole"
done
grep -q 'end exit_code=143' some.log || fail "the log does not say how it ended"

# What cannot be meant: nothing is made, nor a folder.
usage() { # MESSAGE ARGUMENTS...
    expect_code 2 "$program" render "${@:2}"
    expect_said "deltasplat: $1"
}
known="{name}, {dir}, {frame} or {grid}"
usage "--output: got u.png with a pattern of inputs; expected a name with $known" 'shots/*.vdb' -o u.png
usage "--output: got {nam} (a brace by itself is {{); expected $known" 'shots/*.vdb' -o 'u/{nam}.png'
usage "--output: got nothing; expected FILE (see 'deltasplat render --help')" 'shots/*.vdb'
quoted="a pattern of inputs in quotes, such as '*.vdb'"
usage "--output: got u/{name}.png with shots/a.1.vdb; expected $quoted" shots/a.1.vdb -o 'u/{name}.png'
usage "--index: got it with shots/a.1.vdb; expected $quoted" shots/a.1.vdb -o u.png --index u.html
each="a file for each ({dir} tells folders apart, {grid} grids)"
cp shots/a.1.vdb shots/fire
cp shots/a.1.vdb plain.vdb
usage "--output: got u/a.1.png for shots/a.1.vdb and shots/fire/a.1.vdb; expected $each" \
    'shots/**/a.1.vdb' -o 'u/{name}.png'
usage "--output: got u/density.png for shots/a.1.vdb, density and shots/a.2.vdb, density; expected $each" \
    'shots/a.?.vdb' -o 'u/{grid}.png'
usage "--stats: got u/a.1.json for shots/a.1.vdb and shots/fire/a.1.vdb; expected $each" \
    'shots/**/a.1.vdb' -o 'u/{dir}/{name}.png' --stats 'u/{name}.json'
mkdir previews
for name in a a.preview; do cp shots/a.1.vdb previews/$name.vdb; done
usage "--progressive: got u/a.preview.png for previews/a.preview.vdb and previews/a.vdb; expected $each" \
    'previews/*.vdb' -o 'u/{name}.png' --progressive
usage "--stats: got u/a.preview.png for previews/a.vdb and previews/a.vdb; expected $each" \
    'previews/a.[v]db' -o 'u/{name}.png' --stats 'u/{name}.preview.png' --progressive
usage "--stats: got u.json with a pattern of inputs; expected a name with $known" \
    'shots/*.vdb' -o 'u/{name}.png' --stats u.json
usage "--output: got u/{frame}.png for plain.vdb; expected inputs with a number in their names for {frame}" \
    'pla*.vdb' -o 'u/{frame}.png'
usage "--index: got u.txt; expected .html" 'shots/*.vdb' -o 'u/{name}.png' --index u.txt
usage "--index: got u/{name}.html; expected one file" 'shots/*.vdb' -o 'u/{name}.png' --index 'u/{name}.html'
usage "--index: got u/a.1.html; expected another file than the pictures" \
    'shots/*.1.vdb' -o 'u/{name}.png' --stats 'u/{name}.html' --index u/a.1.html
usage "--output: got kept.png; expected another file than the inputs" 'kept*.png' -o '{name}.png'
mkdir images
cp kept.png images/a.png
ln images/a.png images/b.png
ln -s images linked
usage "--output: got images/../images/b.png; expected another file than the inputs" 'images/a*.png' \
    -o 'images/../images/b{dir}.png'
usage "--output: got linked/a.png; expected another file than the inputs" 'images/a*.png' -o 'linked/{name}.png'
usage "--volume: got 1; expected it with a .nii, .nrrd, .mha, .npy or .tif input" 'shots/*.vdb' -o 'u/{name}.png' --volume 1
usage "--contact-sheet: got 1x1 for 2 pictures; expected room for all of them" 'shots/*.vdb' -o u.png \
    --contact-sheet 1x1
usage "--output: got u/{name}.png with --contact-sheet; expected one file" 'shots/*.vdb' \
    -o 'u/{name}.png' --contact-sheet 2x2
usage "--index: got --contact-sheet besides; expected one of them" 'shots/*.vdb' -o u.png \
    --contact-sheet 2x2 --index u.html
usage "--skip-existing: got a sheet or movie of all frames; expected pictures of their own" 'shots/*.vdb' \
    -o u.png --contact-sheet 2x2 --skip-existing
for option in '--turntable 3' '--first-pass u.json' '--missing skip' '--movie u.mp4' '--fps 3' '--slab-range 1/2'; do
    # shellcheck disable=SC2086
    usage "${option%% *}: got it with a pattern of inputs; expected a sequence or one volume" \
        'shots/*.vdb' -o 'u/{name}.png' $option
done
usage "--bits: got 16; expected 8 in a .jpg" 'shots/*.vdb' -o 'u/{name}.jpg' --bits 16 --stats 'u/s/{name}.json'
usage "--frames: got it with a pattern of inputs; expected one or the other" \
    'shots/*.vdb' -o 'u/{name}.####.png' --frames 1-3
expect_code 3 "$program" render shots -o u.png
expect_said "deltasplat: shots: got a folder without DICOM files and images; expected a DICOM folder, a folder of images, or a file such as shots/a.1.vdb (render takes 'shots/*.vdb')"
expect_code 3 "$program" render 'shots/*.none' -o 'u/{name}.png'
expect_said "deltasplat: shots/*.none: got no file that fits; expected at least one"
expect_files "" 'u*'
# What is wrong with all of them is said once.
expect_code 3 "$program" render 'shots/*.vdb' -o 'u/{name}.png' --camera none.json
[[ $(<stderr.txt) == "deltasplat: none.json: "* && $(wc -l <stderr.txt) == 1 ]] ||
    fail "got $(<stderr.txt); expected to be told of none.json alone"
expect_code 3 "$program" render 'shots/*.vdb' -o 'u/{name}.png' --tf none.json
[[ $(<stderr.txt) == "deltasplat: none.json: "* && $(wc -l <stderr.txt) == 1 ]] ||
    fail "got $(<stderr.txt); expected to be told of none.json alone"
expect_files "" 'u*'
expect_code 4 "$program" render 'shots/*.vdb' -o "volume_8x8x8_uint8.raw/{name}.png" -qq
expect_files "" '.deltasplat*'
