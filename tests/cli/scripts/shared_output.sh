#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Has --stats written into a file that others have open too: nothing that is there is lost.
# Usage: shared_output.sh PROGRAM SCRATCH
set -euo pipefail
program=$1 scratch=$2
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
"$program" synth slab slab_8x8x8_uint8.raw --dims 8x8x8 -q
for name in /dev/stdout /dev/fd/1 /proc/self/fd/1 /dev/stderr; do
    { echo before; "$program" convert slab_8x8x8_uint8.raw o.npy --stats $name; echo behind; } >log 2>&1
    [[ $(head -1 log) == before && $(tail -1 log) == behind ]] && grep -q '"lossless"' log ||
        { echo "$name:"; cat log; exit 1; }
done
