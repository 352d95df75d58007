#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fire, colours and layers of several grids, by pictures that have to be the same.
# Usage: medium.sh PROGRAM OIIOTOOL SCRATCH FIRE.vdb
set -euo pipefail
program=$1 oiiotool=$2 scratch=$3 fire=$4
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
failed=0
fail() { echo "$*"; failed=1; }

draw() { # picture options
    "$program" render -q -q "$fire" -o "$1.exr" --float --size 24x24 --frame-width 20 --view iso "${@:2}"
}
same() { "$oiiotool" -q "$1.exr" "$2.exr" --fail "$3" --diff >/dev/null 2>&1; }
expect_same() { same "$1" "$2" "${3:-0}" || fail "$1 and $2: got different pictures"; }
expect_different() { ! same "$1" "$2" 1e-4 || fail "$1 and $2: got one picture; expected two"; }

draw smoke --grid density --tf grey --range 0,1
draw fire --grid density --tf grey --range 0,1 --emission-grid temperature
expect_different smoke fire

# 0.75 of 2000 K are 1500 K, and so is a layer shown as fire.
draw flame --grid density --tf grey --range 0,1 --emission-grid auto
draw celsius --grid density --tf grey --range 0,1 --emission-grid celsius --temperature-scale 1,600
expect_same fire flame 1e-6
expect_same fire celsius 1e-6
draw layers --layer density:grey --layer temperature:fire --range 0,1
expect_same fire layers

draw only --layer temperature:fire
expect_different only fire

# One fog in two halves.
draw whole --layer density:grey --range 0,1 --extinction 2
draw halves --layer density:grey --layer density:grey --range 0,1
expect_same whole halves 1e-4

# Colours by one grid or by three, and by its parts.
draw colored --grid density --tf grey --range 0,1 --color-grid Cd
draw three --grid density --tf grey --range 0,1 --color-grid r,g,b
expect_same colored three 1e-6
expect_different colored smoke
draw part --grid Cd.z --tf grey --range 0,4
draw float --grid b --tf grey --range 0,4
expect_same part float

# Extinction by values: 0.5 of a world unit each.
draw scaled --grid density --density-scale 0.6 --range 0,1 --unit-distance 3
draw scaled_half --grid density --density-scale 0.3 --extinction 2 --range 0,1
expect_same scaled scaled_half 1e-6
exit "$failed"
