#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Compares a .vdb, whose box starts anywhere, with the dense file that it is converted to, whose box
# starts at 0: voxels at the same place in the world are the same.
# Usage: converted.sh PROGRAM SCRATCH FIXTURES
set -euo pipefail
program=$1 scratch=$2 fixtures=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
"$program" convert "$fixtures/ball.vdb" ball.nii -q
"$program" diff "$fixtures/ball.vdb" ball.nii --ignore-active -q
"$program" diff ball.nii "$fixtures/ball.vdb" --ignore-active -q
"$program" diff "$fixtures/ball.vdb" ball.nii --ignore-active --json -q >diff.json
grep -q '"transform_equal": true' diff.json

# NIfTI has places as 32-bit floats: as far as it tells, they are the same, and so is every voxel.
cp "$fixtures/cube_8x8x8_uint8.raw" .
"$program" convert cube_8x8x8_uint8.raw far.vdb --spacing 0.1,0.3,0.7 --origin 1000.1,-333.3,77.7 -q
"$program" convert far.vdb far.nii -q 2>/dev/null
"$program" diff far.vdb far.nii >said || { cat said; exit 1; }
grep -q '^  transform     equal within rounding, up to [0-9.e-]* voxels apart$' said || { cat said; exit 1; }
"$program" diff far.nii far.vdb -q
# Doubles hold more: one that went through floats lies elsewhere, by as much as is said.
"$program" convert far.nii back.vdb -q
code=0
"$program" diff far.vdb back.vdb >said || code=$?
[[ $code == 2 ]] && grep -q 'transform     different, up to ' said && grep -q 'Max error = 0$' said || { cat said; exit 1; }

# Integers that no double holds are what they are.
integers() { # FILE TYPE VALUE...
    local text="{'descr': '<$2', 'fortran_order': False, 'shape': (1, 1, $(($# - 2))), }" value i
    printf '\x93NUMPY\x01\x00\x76\x00%-117s\n' "$text" >"$1"
    for value in "${@:3}"; do
        for i in 0 8 16 24 32 40 48 56; do printf "\\x$(printf %02x $((value >> i & 255)))"; done
    done >>"$1"
}
differ() { # CODE A B TEXT
    local code=0
    "$program" diff "$2" "$3" >said 2>&1 || code=$?
    [[ $code == "$1" ]] && grep -qF -- "$4" said || { echo "diff $2 $3: got $code; expected $1"; cat said; exit 1; }
}
for type in i8 u8; do
    integers a.$type.npy $type 7 $((1 << 53)) 5
    integers b.$type.npy $type 7 $(((1 << 53) + 1)) 5
    differ 2 a.$type.npy b.$type.npy "Max error = 1 @ (1,0,0), in the world (1,0,0); values are 9007199254740992 vs 9007199254740993"
    differ 2 b.$type.npy a.$type.npy "FAILURE"
    differ 0 b.$type.npy b.$type.npy "PASS"
done
integers c.npy u8 7 $(((1 << 63) + 5)) 5
integers d.npy u8 7 $(((1 << 63) + 4)) 5
differ 2 c.npy d.npy "values are 9223372036854775813 vs 9223372036854775812"
differ 0 c.npy c.npy "PASS"
# A copy has all digits, where its format holds them; one that has lost some is told from what it
# was made of.
for file in b.i8.npy b.u8.npy; do
    "$program" convert $file same.vdb -q 2>/dev/null
    differ 0 $file same.vdb "PASS"
done
"$program" convert c.npy same.npy -q
cmp c.npy same.npy
"$program" convert c.npy lossy.vdb -q 2>/dev/null
differ 2 c.npy lossy.vdb "FAILURE"
for options in "--tolerance 0.9" "--tolerance-value 50"; do
    # shellcheck disable=SC2086
    "$program" delta cube_8x8x8_uint8.raw lossy.vdb $options -q >/dev/null
    differ 2 cube_8x8x8_uint8.raw lossy.vdb "FAILURE"
done
