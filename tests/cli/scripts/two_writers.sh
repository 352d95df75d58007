#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Two processes that write the same sequence at the same time, as a farm's that has sent a task
# twice: both end well, and all frames are whole.
# Usage: two_writers.sh PROGRAM OIIOTOOL SCRATCH
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"

"$program" synth cloud cloud.vdb --dims 24x24x24 -q
mkdir one two
render() { "$program" render ../cloud.vdb -o turn.####.exr --turntable 40 --size 48x48 "$@" -qq; }
(cd one && render)
hashes() { "$oiiotool" --info --hash "$@" | sed -n 's/^ *SHA-1: //p'; }
(cd one && hashes turn.*) >one.txt
cd two
for options in "" --skip-existing; do
    rm -f turn.*
    jobs=()
    for writer in 1 2 3; do
        # shellcheck disable=SC2086 # none, or one
        render $options &
        jobs+=($!)
    done
    for job in "${jobs[@]}"; do wait "$job" || fail "a writer ends with $?"; done
    expect_files "" '.deltasplat.*'
    hashes turn.* | cmp - ../one.txt || fail "frames have other pixels"
done
