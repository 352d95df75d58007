#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The same camera, from a .json, a .usda, a matrix, options and another picture, sees the same; one
# that moves is in each frame where it should be.
# Usage: cameras.sh PROGRAM OIIOTOOL SCRATCH FILES
source "${BASH_SOURCE%/*}/pictures.sh"
begin "$@"
files=$4
"$program" synth engine volume_8x8x8_uint8.raw --dims 8x8x8
show() { # NAME OPTION...
    "$program" render volume_8x8x8_uint8.raw -o "$1.exr" --float -qq "${@:2}"
}

matrix=1,0,0,0,0,1,0,0,0,0,1,0,3.5,3.5,40,1
show json --camera "$files/camera_still.json"
show usda --camera "$files/camera.usda:/World/still" --size 36x24 --near 1
show matrix --camera-matrix $matrix --projection perspective --focal 50 --aperture 36 \
    --frame-offset=0.1,-0.1 --near 1 --size 36x24
show options --eye 3.5,3.5,40 --direction 0,0,-1 --projection perspective --focal 50 \
    --aperture 36 --frame-offset=0.1,-0.1 --near 1 --size 36x24
show middle --camera-matrix $matrix --projection perspective --focal 50 --aperture 36 --size 36x24
show picture --camera json.exr --near 1
expect_same usda json
expect_same matrix json
expect_same options json
expect_same picture json 1e-4
expect_different middle json 0.01

# Out of pictures from all sides.
for projection in ortho perspective; do
    for side in "0 0" "30 20" "45 0" "100 -35" "200 60" "315 10"; do
        read -r azimuth elevation <<<"$side"
        show side --azimuth "$azimuth" --elevation "$elevation" --projection $projection --size 24x24
        show again --camera side.exr
        expect_same again side 1e-3
    done
done

# Shifted by 9 pixels and by 6, the picture is that part of one without.
show shifted --camera-matrix $matrix --frame-width 12 --frame-offset=0.25,-0.25 --size 36x24
show larger --camera-matrix $matrix --frame-width 24 --size 72x48
"$oiiotool" -q larger.exr --crop 36x24+27+18 --origin +0+0 --fullpixels -o cropped.exr
expect_same cropped shifted 1e-5

# What is noted of a camera makes the same picture.
eval "options=($("$oiiotool" --info -v json.exr | sed -n 's/.*deltasplat:camera: "\(.*\)"/\1/p'))"
show noted "${options[@]}" --near 1
expect_same noted json 1e-5

# Wide pixels: a third of them, each with the middle of three.
show wide --frame-width 24 --size 32x96 --pixel-aspect 3 --resolution 2
show fine --frame-width 24 --size 96x96 --resolution 2
grep -q 'PixelAspectRatio: 3$' <<<"$("$oiiotool" --info -v wide.exr)" || fail "wide pixels are not noted"
for column in 3 13 16 22; do
    "$oiiotool" -q wide.exr --crop 1x96+$column+0 --origin +0+0 --fullpixels -o one.exr
    "$oiiotool" -q fine.exr --crop 1x96+$((3 * column + 1))+0 --origin +0+0 --fullpixels -o two.exr
    expect_same one two 3e-3
done

# Frames of one that moves; its frames may stand in several files.
show at2 --projection ortho --target 4.5,3.5,3.5 --frame-width 18 --size 24x24
show at3 --projection ortho --target 5.5,3.5,3.5 --frame-width 24 --size 24x24
for camera in camera_moving.json camera.usda:/World/moving; do
    rm -f frame_*.exr
    show frame_# --camera "$files/$camera" --frames 1-3 --size 24x24
    expect_same frame_2 at2 1e-5
    expect_same frame_3 at3 1e-5
    expect_different frame_1 at2 0.01
done
for frame in 2 3; do
    "$program" render volume_8x8x8_uint8.raw -o "shot.000$frame.exr" --float -qq --size 24x24 \
        --camera frame_$frame.exr
done
rm -f again_*.exr
show again_# --camera shot.####.exr --frames 2-3
expect_same again_2 frame_2 1e-4
expect_same again_3 frame_3 1e-4
# Frames with volumes of their own.
for frame in 1 2 3; do "$program" convert volume_8x8x8_uint8.raw in.$frame.vdb -qq; done
"$program" render in.#.vdb -o own_#.exr --camera "$files/camera_moving.json" --frames 1-3 -qq --float
"$program" render in.#.vdb -o part_#.exr --camera "$files/camera_moving.json" --frames 2 -qq --float
expect_same part_2 own_2
expect_different own_1 own_3 0.01

# The frame holds the centres of voxels; five voxels wider, all of them.
head -c 4096 /dev/zero | tr '\0' '\377' >full_16x16x16_uint8.raw
border() { # OPTIONS...: the largest alpha there
    "$program" render full_16x16x16_uint8.raw --tf grey --range 0,255 --size 64x64 --float -qq -o full.exr "$@"
    "$oiiotool" full.exr --cut 1x64+0+0 --printstats | sed -n 's/^ *Stats Max: .* \([^ ]*\) (.*$/\1/p'
}
holds "$(border) > 0.7" || fail "the frame is wider than the centres of voxels"
holds "$(border --frame-width 18) > 0.01" || fail "footprints end before the frame does"
holds "$(border --frame-width 20) < 1e-3" || fail "the frame does not hold all of the voxels"
