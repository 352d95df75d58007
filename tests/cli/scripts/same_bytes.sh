#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks that the same command writes the same bytes, seconds later as well.
# Usage: same_bytes.sh PROGRAM SCRATCH EXTENSION
set -euo pipefail
program=$1 scratch=$2 extension=$3
rm -rf "$scratch"
for folder in one two; do
    mkdir -p "$scratch/$folder"
    cd "$scratch/$folder"
    "$program" synth cloud cloud.vdb --dims 32x32x32 -q
    "$program" render cloud.vdb -o "cloud.$extension" --size 100x80 --view iso -q -q
    # File formats keep time in seconds; wait for another one.
    [[ $folder == two ]] || sleep 1.1
done
cmp "$scratch/one/cloud.vdb" "$scratch/two/cloud.vdb"
cmp "$scratch/one/cloud.$extension" "$scratch/two/cloud.$extension"
