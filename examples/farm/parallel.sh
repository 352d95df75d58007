#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A sequence by GNU parallel, on this machine or (--sshloginfile) on several that share the folder:
# as many tasks at once as JOBS, one thread each. Sent again, it goes on where it was stopped.
# Usage: parallel.sh INPUT OUTPUT FRAMES [OPTIONS...]
#        parallel.sh in/smoke.####.vdb out/smoke.####.exr 100 --size 1024x1024
set -euo pipefail
input=$1 output=$2 frames=$3
shift 3
program=${DELTASPLAT:-deltasplat} chunk=${CHUNK:-10} jobs=${JOBS:-$(nproc)}
first_pass=${FIRST_PASS:-$output.json}

"$program" render "$input" --frames "1-$frames" --first-pass "$first_pass" "$@"
seq 1 "$chunk" "$frames" |
    parallel --jobs "$jobs" --halt now,fail=1 --joblog parallel.log --quote \
        "$program" render "$input" -o "$output" --first-pass "$first_pass" \
        --frames "{}-{= \$_ = \$_ + $chunk - 1; \$_ = $frames if \$_ > $frames =}" \
        --skip-existing --keep-going --threads 1 -q "$@"
