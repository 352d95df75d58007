#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A volume in a USD scene is the one that it refers to, where the scene has it, in each frame.
# Usage: scenes.sh PROGRAM OIIOTOOL FILES SCRATCH
set -euo pipefail
program=$1 oiiotool=$2 files=$3 scratch=$4
rm -rf "$scratch"
mkdir -p "$scratch/elsewhere"
cd "$scratch"
fail() { echo "$*"; exit 1; }
same() { # A B [LARGEST DIFFERENCE]
    "$oiiotool" -q "$1.exr" "$2.exr" --fail "${3:-0}" --diff >/dev/null || fail "$1 is not $2"
}
show() { # INPUT NAME OPTION...
    "$program" render "$1" -o "$2.exr" --float -qq --size 48x48 "${@:3}"
}
expect_code() { # CODE COMMAND...
    local code=0
    "${@:2}" 2>stderr.txt || code=$?
    [[ $code == "$1" ]] || { cat stderr.txt; fail "got exit code $code from ${*:2}; expected $1"; }
}
expect_said() { grep -qF -- "$1" stderr.txt || { cat stderr.txt; fail "expected to be told: $1"; }; }
cp "$files/scene.usda" .

# Volumes whose values lie where the scene moves them to.
raw="--dims 12x12x12 --type float32"
for i in 1 2; do
    mkdir v$i
    "$program" synth cloud v$i/density.raw --dims 12x12x12 --seed $i --type float32
done
raw="--dims 12x12x12 --type float32"
for i in 1 2; do
    "$program" convert v$i/density.raw $raw in.$i.vdb --background 0 -qq
done
"$program" convert v1/density.raw $raw at1.vdb --background 0 -qq --spacing 1,2,1
"$program" convert v2/density.raw $raw at2.vdb --background 0 -qq --spacing 1,2,1 --origin 3,0,0
view="--target 6,12,6 --frame-width 40 --range 0,1 --unit-distance 1"
show scene.usda one $view
show at1.vdb first $view
same one first 1e-6
show scene.usda frame.# --frames 1-3 $view
show at2.vdb second $view
same frame.1 first 1e-6
same frame.2 second 1e-6
# Seen as wide as both frames need, which lie apart.
show scene.usda fit.# --frames 1-2 --range 0,1 --unit-distance 1
show in.1.vdb alone --range 0,1 --unit-distance 1
(same fit.1 alone 1e-6 >/dev/null) && fail "frames are framed one by one"

# A frame without a file is missing.
expect_code 3 "$program" render scene.usda -o gone.#.exr --frames 3-4 -qq --size 8x8
expect_said "frame 4: scene.usda: got no filePath of a volume; expected a .vdb"
rm -f gone.*
expect_code 0 "$program" render scene.usda -o gone.#.exr --frames 3-4 -qq --size 8x8 --missing skip
[[ -e gone.3.exr && ! -e gone.4.exr ]] || fail "frame 4 is not left out"
expect_code 0 "$program" render scene.usda -o gone.#.exr --frames 3-4 -qq --size 8x8 --missing hold
[[ -e gone.4.exr ]] || fail "frame 4 does not show frame 3's file"

# What is read is not written.
expect_code 2 "$program" render scene.usda -o a.exr --stats scene.usda -qq
expect_said "--stats: got scene.usda; expected another file than the scene or the camera"
expect_code 0 "$program" render scene.usda -o a.exr -qq --size 8x8
expect_code 2 "$program" render scene.usda -o a.exr --camera a.exr -qq
expect_said "--output: got a.exr; expected another file than the scene or the camera"
cp in.1.vdb in.3.vdb
expect_code 2 "$program" render in.#.vdb -o gone.#.exr --camera gone.#.exr --frames 3 -qq
expect_said "--output: got gone.3.exr; expected another file than the scene or the camera"

expect_code 3 "$program" render none.usda -o a.exr
expect_said "none.usda: got no file that can be read; expected USD's text format (.usda)"
expect_code 3 "$program" render scene.usdc -o a.exr
expect_said "scene.usdc: got USD that is no text; expected .usda, as usdcat -o x.usda writes it"
sed 's|@in|@../in|g' scene.usda >elsewhere/scene.usda
expect_code 0 "$program" render elsewhere/scene.usda -o a.exr -qq --size 8x8
expect_code 3 "$program" render elsewhere/scene.usda -o a.exr -qq --size 8x8 --confine
expect_said "in.1.vdb outside of its folder"
