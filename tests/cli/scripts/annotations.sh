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
stats() { # FILE X Y WIDTH HEIGHT: the largest difference from plain.png in a part of the picture
    "$oiiotool" "$1" plain.png --sub --abs --cut "$4x$5+$2+$3" --printstats |
        sed -n 's/^ *Stats Max: \(.*\) (.*$/\1/p' | tr ' ' '\n' | sort -g | tail -1
}
expect() { # FILE X Y WIDTH HEIGHT changed|same
    local most
    most=$(stats "${@:1:5}")
    case $6 in
        same) [[ $most == 0.000000 ]] ;;
        changed) [[ $most > 0.2 ]] ;;
    esac || { echo "$*: differs by $most"; exit 1; }
}
corners() { # FILE UPPER-LEFT UPPER-RIGHT LOWER-LEFT LOWER-RIGHT
    expect "$1" 0 0 120 40 "$2"
    expect "$1" 160 0 140 130 "$3"
    expect "$1" 0 170 100 90 "$4"
    expect "$1" 190 220 110 40 "$5"
    expect "$1" 120 0 40 260 same
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
