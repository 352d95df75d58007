#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A volume in a USD scene is the one that it refers to, where the scene has it, in each frame.
# Usage: scenes.sh PROGRAM OIIOTOOL SCRATCH FILES
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"
files=$4
show() { # INPUT NAME OPTION...
    "$program" render "$1" -o "$2.exr" --float -qq --size 48x48 "${@:3}"
}
cp "$files/scene.usda" .

# Volumes whose values lie where the scene moves them to.
raw="--dims 12x12x12 --type float32"
for i in 1 2; do
    mkdir v$i
    "$program" synth cloud v$i/density.raw $raw --seed $i
    "$program" convert v$i/density.raw $raw in.$i.vdb --background 0 -qq
done
"$program" convert v1/density.raw $raw at1.vdb --background 0 -qq --spacing 1,2,1
"$program" convert v2/density.raw $raw at2.vdb --background 0 -qq --spacing 1,2,1 --origin 3,0,0
view="--target 6,12,6 --frame-width 40 --range 0,1 --unit-distance 1"
show scene.usda one $view
show at1.vdb first $view
expect_same one first 1e-6
show scene.usda frame_# --frames 1-3 $view
show at2.vdb second $view
expect_same frame_1 first 1e-6
expect_same frame_2 second 1e-6
# Seen as wide as both frames need, which lie apart.
show scene.usda fit_# --frames 1-2 --range 0,1 --unit-distance 1
show in.1.vdb alone --range 0,1 --unit-distance 1
expect_different fit_1 alone 0.01

# One that stands still, from all sides.
sed 's/timeSamples = { 1: @in.1.vdb@.*}/timeSamples = { 1: @in.1.vdb@ }/; s/.timeSamples = { 1: (0, 0, 0).*/ = (3, 0, 0)/;
     s/filePath.timeSamples = { 1: \(@.*@\) }/filePath = \1/' scene.usda >still.usda
"$program" convert v1/density.raw $raw at3.vdb --background 0 -qq --spacing 1,2,1 --origin 3,0,0
show still.usda turn_# --turntable 3
show at3.vdb other_# --turntable 3
expect_same turn_2 other_2 1e-6

# Where z is up, views stand on that, and who looks straight down has y at the top.
sed 's/#usda 1.0/&\n( upAxis = "Z" )/' still.usda >upright.usda
show upright.usda upright
show at3.vdb standing --direction 0,1,0 --up 0,0,1
expect_same upright standing 1e-6
show upright.usda down --direction 0,0,-1
show at3.vdb flat
expect_same down flat 1e-6
above="--projection perspective --target 6,12,6"
show upright.usda above $above --eye 6,12,60
show at3.vdb over $above --direction 0,0,-1 --distance 54
expect_same above over 1e-6
show upright.usda below --direction 0,0,1
show upright.usda bottom --view bottom
expect_same below bottom 1e-6
# The ground is level there, however the camera is held.
ground="--lighting scatter --light 0.3,0.2,-1 --ground 6,12,-1"
show upright.usda ground --direction 0,0,-1 $ground
show upright.usda level --view top $ground
expect_same ground level 1e-6

# A frame without a file is missing.
expect_code 3 "$program" render scene.usda -o gone.#.exr --frames 3-4 -qq --size 8x8
expect_said "deltasplat: frame 4: scene.usda: got no filePath of a volume; expected a .vdb"
rm -f gone.*
expect_code 0 "$program" render scene.usda -o gone.#.exr --frames 3-4 -qq --size 8x8 --missing skip
[[ -e gone.3.exr && ! -e gone.4.exr ]] || fail "frame 4 is not left out"
expect_code 0 "$program" render scene.usda -o gone.#.exr --frames 3-4 -qq --size 8x8 --missing hold
[[ -e gone.4.exr ]] || fail "frame 4 does not show frame 3's file"

# What is read is not written.
expect_code 2 "$program" render scene.usda -o a.exr --stats scene.usda -qq
expect_said "deltasplat: --stats: got scene.usda; expected another file than the scene or the camera"
expect_code 0 "$program" render scene.usda -o a.exr -qq --size 8x8
expect_code 2 "$program" render scene.usda -o a.exr --camera a.exr -qq
expect_said "deltasplat: --output: got a.exr; expected another file than the scene or the camera"
cp in.1.vdb in.3.vdb
expect_code 2 "$program" render in.#.vdb -o gone.#.exr --camera gone.#.exr --frames 3 -qq
expect_said "deltasplat: frame 3: --output: got gone.3.exr; expected another file than the scene or the camera"

expect_code 3 "$program" render none.usda -o a.exr
expect_said "deltasplat: none.usda: got no such file; expected USD's text format (.usda)"
expect_code 3 "$program" render scene.usdc -o a.exr
expect_said "deltasplat: scene.usdc: got USD that is no text; expected .usda, as usdcat -o x.usda writes it"
mkdir elsewhere
sed 's|@in|@../in|g' scene.usda >elsewhere/scene.usda
expect_code 0 "$program" render elsewhere/scene.usda -o a.exr -qq --size 8x8
expect_code 3 "$program" render elsewhere/scene.usda -o a.exr -qq --size 8x8 --confine
grep -q "in.1.vdb outside of its folder" stderr.txt || fail "the scene is not confined"
# What is looked at is what is opened, whatever links are on the way: "link/.." is no folder's parent
# to USD, which takes names apart by their text.
mkdir -p up/sub/deep
cp in.1.vdb outside.vdb
cp in.1.vdb up/inside.vdb
ln -s sub/deep up/link
sed 's|@in.*vdb@|@link/../../outside.vdb@|' scene.usda >up/out.usda
grep -q '@link/../../outside.vdb@' up/out.usda || fail "up/out.usda does not lead out"
expect_code 0 "$program" render up/out.usda -o a.exr -qq --size 8x8
expect_code 3 "$program" render up/out.usda -o b.exr -qq --size 8x8 --confine
grep -q "outside.vdb outside of its folder" stderr.txt || fail "a scene is confined no longer behind a link"
[[ ! -e b.exr ]] || fail "b.exr shows what is outside"
sed 's|@in.*vdb@|@link/../inside.vdb@|' scene.usda >up/in.usda
expect_code 0 "$program" render up/in.usda -o a.exr -qq --size 8x8 --confine
