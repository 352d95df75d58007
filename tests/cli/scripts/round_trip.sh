#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes delta grids of files and restores them: nothing changes, whatever the number of threads, and
# the same command gives the same bytes. Delta grids render as their sources do, packed or not.
# Usage: round_trip.sh PROGRAM SCRATCH FILE...
set -euo pipefail
program=$1
scratch=$2
shift 2
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"

for file in "$@"; do
    cp "$file" .
    name=$(basename "$file")
    "$program" delta "$name" one.vdb --threads 1 -q
    "$program" delta "$name" two.vdb --threads 3 -q
    cmp one.vdb two.vdb
    "$program" delta one.vdb again.vdb --bits 8 2>said
    grep -q -- '--bits: has no effect on delta' said
    if [[ $name == *.vdb ]]; then
        # The precision that a grid asks for is its own, even where halves would do.
        "$program" convert "$name" floats.vdb --float -q
        "$program" delta floats.vdb floats_delta.vdb -q
        "$program" restore floats_delta.vdb floats_again.vdb -q
        for one in floats floats_again; do
            "$program" info "$one.vdb" --json | grep '"type"' >"$one.txt"
        done
        cmp floats.txt floats_again.txt
    fi
    "$program" delta "$name" voxels.vdb --no-pack --threads 1 -q
    "$program" delta "$name" two.vdb --no-pack --threads 3 -q
    cmp voxels.vdb two.vdb
    options=()
    [[ $name == *.raw ]] && options=(--dims 8x8x8 --type uint8)
    "$program" render "$name" -o source.exr --float -q
    for deltas in one voxels; do
        "$program" restore $deltas.vdb "restored.${name##*.}" --stats stats.json -q
        "$program" diff "$name" "restored.${name##*.}" "${options[@]}" -q
        "$program" diff one.vdb $deltas.vdb -q
        grep -q '"lossless": true' stats.json
        "$program" render $deltas.vdb -o delta.exr --float -q
        idiff -fail 0 -failpercent 0 -hardfail 0 -warn 0 source.exr delta.exr >/dev/null
    done
    rm -- *
done
echo "Equal after delta and restore: $# files"
