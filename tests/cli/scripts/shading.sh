#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What is shaded unless something else is asked for, and what options of lights do.
# Usage: shading.sh PROGRAM OIIOTOOL SCRATCH
set -euo pipefail
program=$1 oiiotool=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
failed=0
fail() { echo "$*"; failed=1; }

"$program" synth engine engine_32x32x32_uint8.raw --dims 32x32x32
"$program" synth engine engine.vdb --dims 32x32x32

draw() { # picture options
    "$program" render -q -q "${input:-engine_32x32x32_uint8.raw}" -o "$1.exr" --float --view iso \
        --size 48x48 --frame-width 60 "${@:2}"
}
same() { "$oiiotool" -q "$1.exr" "$2.exr" --fail 0 --diff >/dev/null 2>&1; }
expect_same() { same "$1" "$2" || fail "$1 and $2: got different pictures; expected the same"; }
expect_different() { ! same "$1" "$2" || fail "$1 and $2: got one picture; expected two"; }

# Presets of CT are shaded, others are not, and a word about light is enough.
draw bone --tf ct-soft-tissue
draw bone_lit --tf ct-soft-tissue --shade
draw bone_plain --tf ct-soft-tissue --no-shade
expect_same bone bone_lit
expect_different bone bone_plain
draw grey --tf grey
draw grey_plain --tf grey --no-shade
draw grey_lit --tf grey --shade
draw grey_head --tf grey --light head
draw grey_none --tf grey --light head --no-shade
expect_same grey grey_plain
expect_same grey_lit grey_head
expect_same grey_plain grey_none
expect_different grey grey_lit

# A light on the camera is one in its direction, of any length, white and of strength 1.
draw grey_view --tf grey --light view:0,0,-3:1,1,1:1
draw grey_world --tf grey --light -2,-2,-2
draw grey_two --tf grey --light head:0.25 --light head:0.5,0.5,0.5:1.5
draw grey_side --tf grey --light view:1,0,0
"$oiiotool" -q grey_lit.exr grey_view.exr --fail 1e-5 --diff >/dev/null || fail "view: got another light"
"$oiiotool" -q grey_lit.exr grey_world.exr --fail 1e-5 --diff >/dev/null || fail "world: got another light"
"$oiiotool" -q grey_lit.exr grey_two.exr --fail 1e-3 --diff >/dev/null || fail "two: got another light"
expect_different grey_lit grey_side

# Without light there is what shines by itself: an ambient share of 1 is what is not shaded.
draw grey_ambient --tf grey --ambient 1 --diffuse 0 --specular 0
"$oiiotool" -q grey.exr grey_ambient.exr --fail 1e-3 --diff >/dev/null || fail "ambient: got another picture"

# Colours by place shine by themselves, unless that is asked otherwise.
draw place --tf ct-soft-tissue --color-by x
exit $failed
