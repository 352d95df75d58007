#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Interrupts the program while it writes its picture, at whatever moment: either the picture is
# there and the exit code is 0, or it is not there and the exit code is the signal's.
# Usage: interrupt_write.sh PROGRAM SCRATCH
set -euo pipefail
program=$1 scratch=$2
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
"$program" synth slab slab_8x8x8_uint8.raw --dims 8x8x8 -q
mkfifo progress

declare -A seen=()
once() { # moment: a line of progress, "temporary" or "final"
    rm -f out.exr
    "$program" render slab_8x8x8_uint8.raw -o out.exr --size 1200x1200 --float -v 2>progress &
    local job=$! code=0 line
    exec 3<progress
    case $1 in
        temporary) while kill -0 $job 2>/dev/null && ! compgen -G '.deltasplat.out.exr.*' >/dev/null; do :; done ;;
        final) while kill -0 $job 2>/dev/null && [[ ! -e out.exr ]]; do :; done ;;
        *) while read -r line <&3 && [[ $line != "Progress: $1%" ]]; do :; done ;;
    esac
    kill -TERM $job 2>/dev/null || true
    cat <&3 >rest
    wait $job || code=$?
    exec 3<&-
    case "$code $([[ -e out.exr ]] && echo there)" in
        "0 there") ! grep interrupted rest || { echo "$1: finished, but says interrupted"; exit 1; } ;;
        "143 ") grep -qx 'deltasplat: interrupted' rest || { echo "$1: said: $(cat rest)"; exit 1; } ;;
        *) echo "$1: exit code $code, picture: $(ls out.exr 2>&1)"; exit 1 ;;
    esac
    seen[$code]=1
    ! compgen -G '.deltasplat.*' || { echo "$1: temporary files left"; exit 1; }
}
for ((i = 0; i < 3; ++i)); do
    for moment in 90 temporary final; do once $moment; done
done
# "Progress: 90%" comes long before the picture is written, and a final name means success.
[[ -n ${seen[143]-} && -n ${seen[0]-} ]] || { echo "seen exit codes: ${!seen[*]}"; exit 1; }
