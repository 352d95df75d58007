#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Samples of several grids: what is in the file, what is shown of it, and the same bytes however
# many threads make it.
# Usage: sample_grids.sh PROGRAM OIIOTOOL SCRATCH
set -euo pipefail
program=$1 oiiotool=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
failed=0
fail() { echo "$*"; failed=1; }

# Every grid with its type and class.
expect_grids() { # file, grids
    local got
    got=$("$program" info "$1" --list | awk 'NR > 1 { print $1, $2, $3, $4 }' | sed 's/ (.*//')
    [[ $got == "$2" ]] || fail "$1: got grids '$got'; expected '$2'"
}
for sample in fire explosion; do
    "$program" synth $sample $sample.vdb --dims 48x48x48 --threads 1 -q
    "$program" synth $sample again.vdb --dims 48x48x48 --threads 2 -q
    cmp $sample.vdb again.vdb || fail "$sample: got other bytes from two threads"
done
expect_grids fire.vdb "density float fog volume
temperature float fog volume
flame float fog volume"
expect_grids explosion.vdb "density float fog volume
temperature float fog volume
Cd vec3s -"

draw() { # picture, file, options
    "$program" render "$2" -o "$1.exr" --float --size 48x48 --tf grey --range 0,1 "${@:3}" \
        2>"$1.txt" || fail "$1: got exit code $?; expected 0"
}
same() { "$oiiotool" -q "$1.exr" "$2.exr" --fail 0 --diff >/dev/null 2>&1; }
frame=(--target 24,24,24 --frame-width 48)
draw shown fire.vdb "${frame[@]}"
draw density fire.vdb "${frame[@]}" --grid density
draw flame fire.vdb "${frame[@]}" --grid flame
draw temperature fire.vdb "${frame[@]}" --grid temperature
same shown density || fail "fire.vdb: got something else than its density"
for grid in flame temperature; do
    ! same shown $grid || fail "fire.vdb: got its density for $grid"
done

# Colours are no volume.
if "$program" render explosion.vdb -o colors.exr --grid Cd 2>message; then
    fail "Cd: got a picture; expected a refusal"
fi
exit $failed
