#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks what --legend, --scale-bar, --axes and --annotate draw over pictures of every mode: in the
# corners only, and the same bytes whatever the number of threads.
# Usage: annotations.sh PROGRAM OIIOTOOL SCRATCH
set -euo pipefail
program=$1 oiiotool=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
"$program" synth engine engine_32x32x32_uint8.raw --dims 32x32x32 -q

render() { # OUTPUT OPTIONS...
    "$program" render engine_32x32x32_uint8.raw -q --view iso --size 300x260 -o "$@"
}
corners() { # FILE UPPER-LEFT UPPER-RIGHT LOWER-LEFT LOWER-RIGHT: "changed" or "same" each
    local parts=(120x40+0+0 140x130+160+0 100x90+0+170 110x40+190+220 40x260+120+0)
    local cuts=() expected=("${@:2}" same) part most i=0
    for part in "${parts[@]}"; do cuts+=(--dup --cut "$part" --printstats --pop); done
    # The largest difference from plain.png in each part of the picture.
    while read -r most; do
        case ${expected[i]} in
            same) [[ $most == 0.000000 ]] ;;
            changed) awk "BEGIN { exit !($most > 0.2) }" ;;
        esac || { echo "$1 ${parts[i]}: differs by $most; expected ${expected[i]}"; exit 1; }
        i=$((i + 1))
    done < <("$oiiotool" "$1" plain.png --sub --abs "${cuts[@]}" |
        sed -n 's/^ *Stats Max: \(.*\) (.*$/\1/p' |
        awk '{ m = $1; for (i = 2; i <= NF; ++i) if ($i > m) m = $i; print m }')
    [[ $i == 5 ]] || { echo "$1: $i parts compared"; exit 1; }
}

all=(--scale-bar --axes --annotate "a line" --annotate "another")
modes=(composite mip xray "composite --projection perspective" "mip --tf viridis"
       "composite --tf labels" "composite --background 1,1,1")
for mode in "${modes[@]}"; do
    legend=--legend
    [[ $mode != xray ]] || legend=
    render plain.png --mode $mode
    render drawn.png --mode $mode $legend "${all[@]}" --threads 1
    render again.png --mode $mode $legend "${all[@]}" --threads 3
    corners drawn.png changed "$([[ $legend ]] && echo changed || echo same)" changed changed
    # Command lines differ, pixels do not.
    [[ $("$oiiotool" --hash drawn.png again.png | grep -o 'SHA-1.*' | sort -u | wc -l) == 1 ]] ||
        { echo "$mode: threads make a difference"; exit 1; }
done

# Each has a corner of its own.
render plain.png
render one.png --annotate "a line"
corners one.png changed same same same
render one.png --legend
corners one.png same changed same same
render one.png --axes
corners one.png same same changed same
render one.png --scale-bar
corners one.png same same same changed

# A panorama has axes, those in its middle.
"$program" render engine_32x32x32_uint8.raw -q --projection latlong --axes --legend -o sides.png
