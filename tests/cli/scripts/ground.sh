#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The shadow on a ground: in channels, and under the picture.
# Usage: ground.sh PROGRAM OIIOTOOL SCRATCH FIRE.vdb
source "${BASH_SOURCE%/*}/pictures.sh"
begin "$@"
fire=$4

draw() { # picture options
    "$program" render -q "$fire" -o "$1.exr" --float --size 32x24 --frame-width 40 --view iso --grid density \
        --tf grey --range 0,1 --lighting scatter --light=-1,-3,0.5:1,0.5,0.2:3 --light 2,-2,1:0.2,0.5,1 "${@:2}"
}
# The largest of a picture's first channel.
largest() { most "$1" | cut -d' ' -f1; }
alpha() { "$oiiotool" -q "$1.exr" --ch A --chnames Y -o "$1_alpha.exr"; }

draw plain
draw channels --ground 0,-7,0 --aov shadow
draw under --ground 0,-7,0
draw up --ground 0,-7,0:0,2,0
draw slope --ground 0,-7,0:0.3,2,0

"$oiiotool" -q channels.exr --ch R,G,B,A -d float -o beside.exr
same plain beside 0 || fail "channels: got another picture beside the shadow; expected the same"
same under up 0 || fail "up: got another shadow; expected that of what is up"
! same under slope 1e-3 || fail "slope: got the same shadow as of what is up"
for channel in R G B; do
    "$oiiotool" -q channels.exr --ch shadow.$channel --chnames Y -o "$channel.exr"
    red=$(largest "$channel")
    holds "$red > 0.3 && $red <= 1" || fail "shadow.$channel: got at most $red; expected a shadow"
done
! same R B 0.05 || fail "shadow: got red as blue; expected what each light loses"
for picture in plain under; do
    "$oiiotool" -q "$picture.exr" --ch R,G,B -o "${picture}_light.exr"
    alpha "$picture"
done
same plain_light under_light 0 || fail "under: got other light; expected more alpha alone"
"$oiiotool" -q under_alpha.exr plain_alpha.exr --sub -o added.exr
holds "$(largest added) > 0.3" || fail "under: got $(largest added) more alpha; expected a shadow"

# What is up may be --up; the volume's box is from -6 to 6, and a ball in it.
draw z_up --ground 0,0,-7 --up 0,0,1 --direction 0,1,-1 --light 1,2,-3
draw z_plain --up 0,0,1 --direction 0,1,-1 --light 1,2,-3
alpha z_up
alpha z_plain
"$oiiotool" -q z_up_alpha.exr z_plain_alpha.exr --sub -o z_added.exr
holds "$(largest z_added) > 0.1" || fail "z_up: got $(largest z_added) more alpha; expected a shadow"

# Over a plate what is lit stays as it is, and what is not grows darker.
draw plate --ground 0,-7,0 --background 1,1,1
draw bare --background 1,1,1
"$oiiotool" -q bare.exr plate.exr --sub --ch R -o darker.exr
"$oiiotool" -q plate.exr --ch R --crop 1x1+0+0 -o corner.exr
holds "$(largest darker) > 0.2" || fail "plate: got $(largest darker) less light; expected a shadow"
holds "$(largest corner) == 1" || fail "plate: got $(largest corner) in a corner; expected 1"
