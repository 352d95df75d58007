#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fire, colours and layers of several grids, by pictures that have to be the same.
# Usage: medium.sh PROGRAM OIIOTOOL SCRATCH FIRE.vdb
source "${BASH_SOURCE%/*}/pictures.sh"
begin "$@"
fire=$4

draw() { # picture options
    "$program" render -q -q "$fire" -o "$1.exr" --float --size 24x24 --frame-width 20 --view iso "${@:2}"
}

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

# Channels beside the picture, by their names and in floats.
draw aovs --grid density --tf grey --range 0,1 --emission-grid temperature --lighting scatter --light 1,-1,0 --light 0,-1,1 \
    --aov depth,front,back,position,normal,emission,ambient,direct,transmittance,samples \
    --depth-opacity 0.25
names=$("$oiiotool" --info -v aovs.exr | sed -n 's/^ *channel list: //p')
for channel in Z depth_front.Z ZBack P.X P.Y P.Z N.X N.Y N.Z emission.R ambient.G direct.B direct_1.R \
    direct_2.B transmittance samples; do
    [[ ", $names," == *", $channel,"* || ", $names," == *", $channel ("* ]] || fail "channels: got $names; expected $channel"
done
grep -q 'deltasplat:depthOpacity: "0.25"' <<<"$("$oiiotool" --info -v aovs.exr)" || fail "channels: got no opacity of depths"
"$oiiotool" -q aovs.exr --ch emission.R,emission.G,emission.B aovs.exr --ch direct.R,direct.G,direct.B \
    --add aovs.exr --ch ambient.R,ambient.G,ambient.B --add aovs.exr --ch R,G,B --fail 2e-2 --diff \
    >/dev/null || fail "channels of light: got another sum than the picture"

# Mattes of all layers, also of those that are empty, and of no fire.
draw mattes --layer r:grey --layer temperature:fire --layer g:grey --layer density:grey --range 0,4 --aov mattes
"$oiiotool" -q mattes.exr --ch matte_1 mattes.exr --ch matte_2 --add mattes.exr --ch matte_3 --add \
    mattes.exr --ch A --fail 1e-2 --diff >/dev/null || fail "mattes: got another sum than alpha"
"$program" render -q -q "${fire%/*}/layers.vdb" -o empty.exr --size 24x24 --layer density:grey \
    --layer none:grey --layer g:grey --range 0,4 --aov mattes
mattes=$(most empty | cut -d' ' -f5-7)
[[ $mattes =~ ^0\.1[0-9]*\ 0\.0*\ 0\.1[0-9]*$ ]] || fail "empty: got mattes up to $mattes; expected none of the second"

# What is cut off changes no colours of what is left: cut by a box or by a plane.
draw ramp --layer temperature:fire --emission-tf inferno --emission-range 0,1500 --target 0,0,0 \
    --crop :,0:,:
draw ramp_clip --layer temperature:fire --emission-tf inferno --emission-range 0,1500 \
    --target 0,0,0 --clip 0,0,0,0,1,0
expect_same ramp ramp_clip 2e-2

# Solid things: behind all, before all, and where half of it is.
solid() { "$oiiotool" -q --pattern "constant:color=$2" 24x24 1 --chnames Z -d float -o "$1.exr"; }
solid far 1e9
solid near 1e-3
draw plain --grid density --tf grey --range 0,1 --between 0
draw before_far --grid density --tf grey --range 0,1 --between 0 --holdout-depth far.exr
draw before_near --grid density --tf grey --range 0,1 --between 0 --holdout-depth near.exr
expect_same plain before_far 1e-4
[[ $(most before_near) == "0.000000 0.000000 0.000000 0.000000 " ]] ||
    fail "before_near: got something; expected nothing"
draw depth --grid density --tf grey --range 0,1 --between 0 --aov depth
"$oiiotool" -q depth.exr --ch Z -d float -o middle.exr
draw before_middle --grid density --tf grey --range 0,1 --between 0 --holdout-depth middle.exr
sum() { mean "$1" | cut -d' ' -f4; }
holds "$(sum before_middle) > 0.4 * $(sum plain) && $(sum before_middle) < 0.8 * $(sum plain)" ||
    fail "before_middle: got $(sum before_middle) of $(sum plain)"
