#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Interrupts a long rendering and checks that it ends as the signal says and leaves nothing.
# Usage: interrupt.sh PROGRAM SCRATCH SIGNAL
set -euo pipefail
program=$1 scratch=$2 signal=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
"$program" synth cloud cloud_96x96x96_uint8.raw --dims 96x96x96 -q
mkfifo progress
before=$(ls -A)

# A wide footprint on fine sheets takes many seconds, so the signal is always early enough. Shells
# have jobs in the background ignore SIGINT; env undoes that.
env --default-signal=INT,TERM,HUP "$program" render cloud_96x96x96_uint8.raw -o cloud.exr \
    --stats stats.json --method traditional --resolution 8 --sigma 2 --progress 2>progress &
job=$!
exec 3<progress
while read -r line <&3 && [[ $line != "Progress: 30%" && $line != "Progress: 40%" ]]; do :; done
kill "-$signal" "$job"
code=0
wait "$job" || code=$?
rest=$(grep -v '^Progress: ' <&3 || true)

declare -A expected=([INT]=130 [TERM]=143 [HUP]=129)
[[ $code == "${expected[$signal]}" ]] ||
    { echo "exit code: got $code; expected ${expected[$signal]}"; exit 1; }
[[ $rest == "deltasplat: interrupted" ]] || { echo "standard error: got $rest"; exit 1; }
[[ $(ls -A) == "$before" ]] || { echo "left behind: $(ls -A)"; exit 1; }
