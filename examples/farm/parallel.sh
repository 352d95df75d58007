#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A sequence by GNU parallel, on this machine or (--sshloginfile) on several that share the folder:
# as many tasks at once as JOBS, one thread each. Sent again, it goes on where it was stopped.
# Usage: parallel.sh INPUT OUTPUT FIRST-LAST [OPTIONS...]
#        parallel.sh in/smoke.####.vdb out/smoke.####.exr 1-100 --size 1024x1024
set -euo pipefail
if [[ $# -lt 3 || ! $3 =~ ^[0-9]+-[0-9]+$ ]]; then
    sed -n 's/^# \(Usage: .*\)/\1/p' "$0" >&2
    exit 2
fi
input=$1 output=$2 first=$((10#${3%-*})) last=$((10#${3#*-}))
shift 3
program=${DELTASPLAT:-deltasplat} chunk=${CHUNK:-10} jobs=${JOBS:-$(nproc)}
name=$(basename "$output")
first_pass=${FIRST_PASS:-$(dirname "$output")/${name%%[#@%\$]*}first_pass.json}

"$program" render "$input" --frames "$first-$last" --first-pass "$first_pass" "$@"
seq "$first" "$chunk" "$last" |
    parallel --jobs "$jobs" --halt now,fail=1 --joblog parallel.log --quote \
        "$program" render "$input" -o "$output" --first-pass "$first_pass" \
        --frames "{}-{= \$_ = \$_ + $chunk - 1; \$_ = $last if \$_ > $last =}" \
        --skip-existing --keep-going --threads 1 -q "$@"
