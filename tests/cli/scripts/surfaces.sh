#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What is shown as a surface unless something else is asked for, and what its options do.
# Usage: surfaces.sh PROGRAM OIIOTOOL SCRATCH LEVEL_SET
set -euo pipefail
program=$1 oiiotool=$2 scratch=$3 level_set=$4
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
failed=0
fail() { echo "$*"; failed=1; }

"$program" synth engine engine_32x32x32_uint8.raw --dims 32x32x32

draw() { # picture options
    "$program" render "${input:-$level_set}" -o "$1.exr" --float --view iso --size 48x48 "${@:2}" \
        2>"$1.txt" || fail "$1: got exit code $?; expected 0"
}
same() { "$oiiotool" -q "$1.exr" "$2.exr" --fail 0 --diff >/dev/null 2>&1; }
expect_same() { same "$1" "$2" || fail "$1 and $2: got different pictures; expected the same"; }
expect_different() { ! same "$1" "$2" || fail "$1 and $2: got one picture; expected two"; }
expect_warning() { grep -qF -- "$2" "$1.txt" || fail "$1: got '$(cat "$1.txt")'; expected '$2'"; }
expect_silence() { [[ ! -s $1.txt ]] || fail "$1: got '$(cat "$1.txt")'; expected no warning"; }

# A level set is its surface, unless what it is made of is asked for.
draw plain
draw surface --surface
draw zero --isovalue 0
draw grown --isovalue 0.4
expect_same plain surface
expect_same plain zero
expect_different plain grown
expect_silence plain
expect_silence grown
draw fog --level-set fog
expect_different plain fog
draw fog_tf --tf grey
draw fog_range --range 0,1
draw fog_extinction --extinction 0.5
draw fog_place --color-by x
for picture in fog_tf fog_range fog_extinction fog_place; do expect_different plain "$picture"; done
draw color_of_fog --surface --tf viridis --range=-1,1
expect_different color_of_fog plain
draw kept --level-set keep
draw kept_surface --level-set keep --surface
expect_different plain kept
expect_same plain kept_surface
draw flat --no-shade
expect_different plain flat
# Modes of rays go through the fog that it was.
draw xray --mode xray
draw xray_fog --mode xray --level-set fog
expect_same xray xray_fog
draw xray_surface --mode xray --surface
expect_same xray xray_surface
expect_warning xray_surface "--surface: has no effect with --mode xray"

# Near the ends of the band voxels are missing, and made.
expect_silence plain
draw inner --isovalue=-0.9
expect_warning inner "grid \"surface\": the level set's band ends too near to the surface; "
draw outer --isovalue=1.4
expect_warning outer "the level set's band ends too near to the surface"
# Cut open it is solid.
draw cut --crop 0:12,:,:
expect_silence cut
draw all --isovalue=3.5
expect_warning all "all is inside, and shown is all of the volume, as a solid"

# A volume of one value passes none.
head -c 512 /dev/zero | tr '\0' '\7' >seven_8x8x8_uint8.raw
input=seven_8x8x8_uint8.raw
draw seven --isovalue 7
expect_warning seven "--isovalue: got 7, which a volume of value 7 never passes: all is inside"

# Any volume's values pass some.
input=engine_32x32x32_uint8.raw
draw engine --isovalue 90
draw engine_red --isovalue 90 --surface-color 0.8,0.1,0.1
draw engine_lit --isovalue 90 --light view:1,-1,-1
draw engine_tf --isovalue 90 --tf "$(dirname "$0")/../../../examples/engine.json"
expect_different engine engine_red
expect_different engine engine_lit
expect_different engine engine_tf
draw thin --isovalue 90 --extinction 0.01
expect_same engine thin
draw nowhere --isovalue 300
expect_warning nowhere "--isovalue: got 300, which values from 0 to 230 never pass: nothing is inside"
expect_warning nowhere "picture: empty, for the surface encloses none of the values 0 to 230"

# Opacity by gradients: none, all, and something between.
draw ramp --tf grey
draw ramp_all --tf grey --gradient-opacity 0:1
draw ramp_edges --tf grey --gradient-opacity 0:0,40:1
draw ramp_none --tf grey --gradient-opacity 0:0
"$oiiotool" -q ramp.exr ramp_all.exr --fail 1e-3 --diff >/dev/null || fail "factor 1: got another picture"
expect_different ramp ramp_edges
expect_warning ramp_none "picture: empty"
exit $failed
