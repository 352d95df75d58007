#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Lengths are in the unit that a file names, through conversions; radiographs are the same whatever
# the unit is; what names none is said.
# Usage: units.sh PROGRAM OIIOTOOL SCRATCH
set -euo pipefail
program=$1 oiiotool=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
"$program" synth engine engine_12x12x12_uint8.raw --dims 12x12x12 -q

fail() { echo "$*"; exit 1; }
nrrd() { # FILE SPACE UNIT SIZE
    local units=
    [[ -z $3 ]] || units="space units: \"$3\" \"$3\" \"$3\"\n"
    local place="space directions: ($4,0,0) (0,$4,0) (0,0,$4)\n"
    printf "NRRD0004\ntype: uint8\ndimension: 3\n$2\n${units}sizes: 12 12 12\nencoding: raw\n$place\n" |
        cat - engine_12x12x12_uint8.raw >"$1"
}
same() { "$oiiotool" -q "$1" "$2" --fail 1e-6 --diff >/dev/null 2>&1; }

nrrd um.nrrd 'space: 3D-right-handed' um 380
nrrd mm.nrrd 'space: 3D-right-handed' mm 0.38
nrrd patient.nrrd 'space: LPS' microns 380
nrrd none.nrrd 'space: 3D-right-handed' '' 0.38
for pair in 'um.nrrd:380 x 380 x 380 um' 'mm.nrrd:0.38 x 0.38 x 0.38 mm' \
    'patient.nrrd:0.38 x 0.38 x 0.38 mm'; do
    text=$("$program" info "${pair%%:*}" -q)
    [[ $text == *"${pair#*:}"* ]] || fail "${pair%%:*}: got $text; expected ${pair#*:}"
done
text=$("$program" info none.nrrd -q)
[[ $text == *'0.38 x 0.38 x 0.38'* && $text != *'0.38 mm'* ]] || fail "none.nrrd: got $text"

# Through a grid and formats that other programs take for millimetres.
"$program" convert um.nrrd um.vdb -q -q
"$program" convert um.vdb um.nii -q -q
"$program" convert um.vdb um.mha -q -q
"$program" convert um.vdb again.nrrd -q -q
for file in um.nrrd um.vdb again.nrrd mm.nrrd; do
    "$program" render "$file" -o "${file/./_}.exr" --float --drr --size 30x30 -q -q
done
for file in um_vdb again_nrrd mm_nrrd; do
    same um_nrrd.exr $file.exr || fail "$file.exr: another radiograph than of um.nrrd"
done
for file in um.nii um.mha again.nrrd mm.nrrd; do
    "$program" diff um.nrrd $file -q || fail "$file: got another place than of um.nrrd"
done

# What is taken for millimetres is said.
text=$("$program" render none.nrrd -o none.exr --drr --size 8x8 2>&1)
[[ $text == *'none.nrrd: names no unit of length; --mode drr takes its lengths for millimetres'* ]] ||
    fail "none.nrrd: got $text"
text=$("$program" render um.nrrd -o um.exr --drr --size 8x8 2>&1)
[[ $text != *'names no unit'* ]] || fail "um.nrrd: got $text"
