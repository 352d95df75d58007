#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A file that says that its values are labels is shown by their preset, unless something else is
# asked for; one that does not say so is not.
# Usage: labels_first.sh PROGRAM OIIOTOOL SCRATCH
set -euo pipefail
program=$1 oiiotool=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
"$program" synth engine engine_16x16x16_uint8.raw --dims 16x16x16 -q

draw() { # PICTURE VOLUME OPTIONS
    "$program" render -q -q "$2" -o "$1.exr" --float --size 40x40 --view iso "${@:3}"
}
same() { "$oiiotool" -q "$1.exr" "$2.exr" --fail 0 --diff >/dev/null 2>&1; }
check() { # PLAIN SAYING: the same volume, without and with the word
    draw plain "$1"
    draw preset "$1" --tf labels
    draw first "$2"
    draw ramp "$2" --range 0,200
    draw plain_ramp "$1" --range 0,200
    ! same plain preset || { echo "$1: got labels; expected a ramp"; exit 1; }
    same first preset || { echo "$2: got another picture; expected labels"; exit 1; }
    same ramp plain_ramp || { echo "$2: got no ramp by --range"; exit 1; }
}

# The intent's code is 1002, at byte 68.
"$program" convert engine_16x16x16_uint8.raw plain.nii -q -q
cp plain.nii labels.nii
printf '\352\003' | dd of=labels.nii bs=1 seek=68 conv=notrunc status=none
check plain.nii labels.nii
gzip -k labels.nii
draw packed labels.nii.gz
same packed preset || { echo "labels.nii.gz: expected labels"; exit 1; }

# Another intent is no word for it.
cp plain.nii other.nii
printf '\353\003' | dd of=other.nii bs=1 seek=68 conv=notrunc status=none
draw other other.nii
same other plain || { echo "other.nii: another intent, and no ramp"; exit 1; }

header='NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16 16 16\nencoding: raw\n'
printf "$header\n" | cat - engine_16x16x16_uint8.raw >plain.nrrd
printf "${header}Segment0_ID:=Segment_1\n\n" | cat - engine_16x16x16_uint8.raw >labels.seg.nrrd
check plain.nrrd labels.seg.nrrd
# In the data it is no key.
printf "$header\n" | cat - <(printf '\nSegment0_ID:=') engine_16x16x16_uint8.raw |
    head -c "$(stat -c %s plain.nrrd)" >data.nrrd
draw data data.nrrd
! same data preset || { echo "data.nrrd: got labels"; exit 1; }

# Names and colours of segments are those of the picture and its legend, through conversions and
# delta grids, and come back as 3D Slicer wrote them.
segments='Segment0_ID:=a\nSegment0_Name:=metal, cast\nSegment0_LabelValue:=115\nSegment0_Color:=1 0 0\n'
printf "${header}$segments\n" | cat - engine_16x16x16_uint8.raw >named.seg.nrrd
"$program" convert named.seg.nrrd named.vdb -q -q
"$program" delta named.vdb named_delta.vdb -q -q
"$program" restore named_delta.vdb again.vdb -q -q
"$program" convert again.vdb again.seg.nrrd -q -q
draw named named.seg.nrrd
! same named preset || { echo "named.seg.nrrd: got the preset's colours; expected its own"; exit 1; }
for file in named.vdb named_delta.vdb again.vdb again.seg.nrrd; do
    draw other $file
    same named other || { echo "$file: got another picture than of named.seg.nrrd"; exit 1; }
    text=$("$program" info $file -q)
    [[ $text == *"115 metal, cast"* ]] || { echo "$file: info names no label: $text"; exit 1; }
done
text=$(head -c 2000 again.seg.nrrd | tr -d '\0')
for line in 'Segment0_Name:=metal, cast' 'Segment0_LabelValue:=115' 'Segment0_Color:=1 0 0'; do
    [[ $text == *"$line"* ]] || { echo "again.seg.nrrd: no line $line"; exit 1; }
done

# Names of a table go where the format has a place for them.
printf '0 0 0 0 0 0 0 "Clear"\n115 255 0 0 1 1 1 "metal, cast"\n' >table.txt
for file in plain.nrrd:snap.seg.nrrd plain.nrrd:snap.vdb; do
    "$program" convert ${file%:*} ${file#*:} --labels table.txt -q -q
    draw snap ${file#*:}
    same named snap || { echo "${file#*:}: got another picture than of named.seg.nrrd"; exit 1; }
done
text=$("$program" convert snap.vdb snap.nii 2>&1)
[[ $text == *"snap.nii: names and colours of labels are left out"* ]] ||
    { echo "snap.nii: lost names without a word: $text"; exit 1; }
