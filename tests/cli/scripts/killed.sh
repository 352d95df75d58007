#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Kills the program while it writes: nothing is there under the final name, and the next run removes
# what was left, but not what a living one writes.
# Usage: killed.sh PROGRAM SCRATCH
set -euo pipefail
program=$1 scratch=$2
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
temporaries() { compgen -G '.deltasplat.*' | wc -l || true; }
wait_for_temporaries() { # number; gives up after so many looks
    for ((look = 0; look < 3000; ++look)); do
        [[ $(temporaries) != "$1" ]] || return 0
        sleep 0.01
    done
    echo "expected $1 temporary files: $(ls -A)"
    kill -KILL "${jobs[@]}"
    exit 1
}

# A pipe that nobody empties holds the program while it has a temporary file.
mkfifo progress
hold() { # writes out.raw, to stop in the middle
    "$program" synth cloud out.raw --dims 64x64x64 -v 2>&3 &
}
exec 3<>progress
# Fills the pipe, so that the first line of progress waits.
dd if=/dev/zero bs=4096 oflag=nonblock of=progress status=none 2>&- || true
jobs=()
for i in 1 2 3; do
    hold
    jobs+=($!)
done
wait_for_temporaries 3
kill -KILL "${jobs[@]}"
for job in "${jobs[@]}"; do wait "$job" 2>&- || true; done
[[ ! -e out.raw && $(temporaries) == 3 ]] || { echo "after kills: $(ls -A)"; exit 1; }

hold
living=$!
jobs=("$living")
# It removed those, and has its own, which the next one lets be.
wait_for_temporaries 1
"$program" synth slab out.raw --dims 64x64x64 -q
[[ -e out.raw && $(temporaries) == 1 ]] || { echo "beside a living one: $(ls -A)"; exit 1; }
kill -KILL $living
wait $living 2>&- || true
"$program" synth slab out.raw --dims 64x64x64 -q
[[ $(temporaries) == 0 ]] || { echo "in the end: $(ls -A)"; exit 1; }
