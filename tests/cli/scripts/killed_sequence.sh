#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Kills a sequence 100 times, at times that a fixed seed gives, each time to go on where it was:
# what has a final name is whole at any time, all frames are there in the end, as if nothing had
# been, and nothing else is.
# Usage: killed_sequence.sh PROGRAM OIIOTOOL SCRATCH
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"

"$program" synth cloud cloud.vdb --dims 24x24x24 -q
# The same command line each time, which frames tell of: all their bytes are compared.
mkdir one many
frames=(render ../cloud.vdb -o turn.####.exr --turntable 300 --size 32x32 --skip-existing --threads 2 -qq)
(cd one && "$program" "${frames[@]}")
[[ $(find one -type f | wc -l) == 300 ]] || fail "not all frames without kills"

cd many
RANDOM=14
kills=0
for ((i = 0; i < 100; ++i)); do
    "$program" "${frames[@]}" &
    job=$!
    # From before its first frame on; each time a few frames more.
    sleep "0.$(printf %03d $((RANDOM % 300 + 50)))"
    if kill -KILL $job 2>/dev/null; then kills=$((kills + 1)); fi
    wait $job 2>/dev/null || true
    broken=$(diff -rq . ../one | grep differ || true)
    [[ -z $broken ]] || fail "kill $i: $broken"
    # So that there is something to do.
    [[ $(find . -name 'turn.*' | wc -l) -lt 200 ]] || rm -f turn.0[01]*.exr
done
((kills > 0)) || fail "nothing was killed"
"$program" "${frames[@]}"
cd ..
diff -r one many >/dev/null || fail "in the end: $(diff -rq one many | head)"
