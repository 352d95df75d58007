#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fire that lights the fog around it, and nothing else that does.
# Usage: fire_lights.sh PROGRAM OIIOTOOL SCRATCH FIRE.vdb
source "${BASH_SOURCE%/*}/pictures.sh"
begin "$@"
fire=$4

draw() { # picture options
    "$program" render -q "$fire" -o "$1.exr" --float --size 24x24 --frame-width 20 --view iso --grid density --tf grey \
        --range 0,1 --emission-grid temperature --lighting scatter "${@:2}"
}
part() { "$oiiotool" -q lit.exr --ch "$1.R,$1.G,$1.B" --chnames R,G,B -o "$1.exr"; }
red() { mean "$1" | cut -d' ' -f1; }

draw lit --emission-lights 4 --aov emission,direct,ambient
part emission
part direct
part ambient
holds "$(red direct) > 1e-3" || fail "direct: got $(red direct); expected lit fog"
holds "$(red ambient) == 0" || fail "ambient: got $(red ambient); expected none"

# With them there is no sky, unless one is asked for; without lights fire is all that is seen.
draw dark --light 1,0,0:0
"$oiiotool" -q dark.exr --ch R,G,B -o dark_light.exr
same dark_light emission 1e-5 || fail "dark: got more than fire"
draw sky --emission-lights 4 --sky 1,2,1:4
! same lit sky 1e-2 || fail "sky: got the same picture as without"

# As many lights as blocks are no other picture than more.
draw all --emission-lights 1000
draw more --emission-lights 4000
same all more 0 || fail "all: got another picture than of more lights"
