#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every command takes two blocks of voxels that lie as far apart as indices go for what they are, in
# little memory: in every mode and projection, and whatever a picture is made for.
# Usage: far_apart.sh PROGRAM SCRATCH far.vdb
set -euo pipefail
program=$1
scratch=$2
file=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
cp "$file" far.vdb
# Also what nobody asks for beforehand. Libraries take most of it.
ulimit -v 3000000
limit=(--max-memory 300M -q)

"$program" info far.vdb --json "${limit[@]}" >info.json
grep -q '1024' info.json
"$program" info far.vdb --list --max-memory 300M >/dev/null
"$program" convert far.vdb again.vdb "${limit[@]}"
"$program" diff far.vdb again.vdb -q --max-memory 300M >/dev/null
"$program" delta far.vdb delta.vdb "${limit[@]}"
"$program" restore delta.vdb restored.vdb "${limit[@]}"
"$program" diff far.vdb restored.vdb -q --max-memory 300M >/dev/null

# What a dense format would take is said at once.
code=0
"$program" convert far.vdb far.npy "${limit[@]}" 2>said || code=$?
[[ $code == 1 && ! -e far.npy ]]
grep -q 'far.npy: 1073741824x1073741824x1073741824 voxels, .* of which 1024 are active' said

for projection in ortho perspective latlong; do
    for mode in composite xray mip min average; do
        "$program" render far.vdb -o all.exr --view iso --projection $projection --mode $mode \
            --size 64x32 --max-memory 300M 2>said
        grep -q 'no more than dots' said
        [[ $(<said) != *'picture: empty'* && $(<said) != *'looks empty'* ]]
        grep -q '50 % of the voxels lie in 0:7,0:7,0:7, which --crop leaves' said
    done
    "$program" render delta.vdb -o delta.exr --view iso --projection $projection --size 64x32 \
        "${limit[@]}"
done

# From near one block is what it is without the other, but for the rounding of colours, whose unit
# goes by all of them. Seen along the diagonal the other one lies behind it.
"$program" render far.vdb -o near.exr --float --target 3.5,3.5,3.5 --frame-width 12 --view front \
    --size 48x48 --range 0,1 "${limit[@]}"
"$program" render far.vdb -o cropped.exr --float --target 3.5,3.5,3.5 --frame-width 12 \
    --view front --size 48x48 --range 0,1 --crop :100,:,: "${limit[@]}"
idiff -fail 0.00003 -failpercent 0 -warn 1 near.exr cropped.exr >/dev/null
for options in "--sky 0.6,0.8,0.9:3" "--surface --isovalue 0.25" "--aov depth,position" "--deep" \
    "--color-by x" "--shade" "--mode xray" "--mode mip --depth-shade 0.5" "--lighting scatter --light point:20,20,20:1e4" \
    "--lighting scatter --light point:5e8,1e9,5e8:1e6"; do
    # shellcheck disable=SC2086
    "$program" render far.vdb -o some.exr --target 3.5,3.5,3.5 --frame-width 12 --view iso \
        --size 48x48 --range 0,1 $options "${limit[@]}"
done
