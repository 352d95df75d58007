#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks the values that --mode xray and mip store, and what becomes of them in a .png: of a slab of
# 10x8x4 voxels of 255 in 12x10x8 voxels of 0.
# Usage: modes.sh PROGRAM OIIOTOOL SCRATCH
set -euo pipefail
program=$1 oiiotool=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
slab=slab_12x10x8_uint8.raw
"$program" synth slab "$slab" --dims 12x10x8 -q

render() { # OUTPUT OPTIONS...: a picture of one pixel a voxel, the volume in its middle
    "$program" render "$slab" -q --view front --frame-width 16 --size 16x16 -o "$@"
}
expect_pixel() { # FILE X Y VALUES
    local got
    got=$("$oiiotool" "$1" --cut "1x1+$2+$3" --printstats | sed -n 's/^ *Stats Max: \(.*\) (.*$/\1/p')
    [[ $got == "$4" ]] || { echo "$1 at $2,$3: got $got; expected $4"; exit 1; }
}
expect_metadata() { # FILE NAME VALUE, which is empty if there must be none
    local got
    got=$("$oiiotool" --info -v "$1" | sed -n "s/^ *deltasplat:$2: \"\(.*\)\"$/\1/p")
    [[ $got == "$3" ]] || { echo "$1, $2: got $got; expected $3"; exit 1; }
}

# Integrals in world units, as 32-bit floats without being asked: halves would round them.
render xray.exr --mode xray --spacing 1,1,2.5
expect_pixel xray.exr 8 8 "2550.000000 2550.000000 2550.000000 2550.000000"
expect_pixel xray.exr 0 0 "0.000000 0.000000 0.000000 0.000000"
render fine.exr --mode xray --spacing 1,1,1.001
expect_pixel fine.exr 8 8 "1021.020020 1021.020020 1021.020020 1021.020020"
expect_metadata xray.exr mode xray
expect_metadata xray.exr xrayScale ""
expect_metadata xray.exr method ""

# In a .png the largest is white, and the metadata say what that stands for.
render xray.png --mode xray --spacing 1,1,2.5 --background 0,0,0
expect_pixel xray.png 8 8 "1.000000 1.000000 1.000000 1.000000"
expect_pixel xray.png 0 0 "0.000000 0.000000 0.000000 1.000000"
expect_metadata xray.png xrayScale 2550

# Largest values: where there are voxels, if of 0, and nothing beside the volume.
render mip.exr --mode mip
expect_pixel mip.exr 8 8 "255.000000 255.000000 255.000000 1.000000"
expect_pixel mip.exr 2 8 "0.000000 0.000000 0.000000 1.000000"
expect_pixel mip.exr 0 8 "0.000000 0.000000 0.000000 0.000000"
expect_metadata mip.exr mode mip
render mip.png --mode mip
expect_pixel mip.png 8 8 "1.000000 1.000000 1.000000 1.000000"
expect_pixel mip.png 2 8 "0.000000 0.000000 0.000000 1.000000"
expect_pixel mip.png 0 8 "0.000000 0.000000 0.000000 0.000000"

# A transfer function's colours, whatever its opacities.
cat >red.json <<'END'
[{"Name": "red", "RGBPoints": [0, 0, 0, 1, 255, 1, 0, 0], "Points": [0, 0, 0.5, 0, 255, 0, 0.5, 0]}]
END
render red.png --mode mip --tf red.json
expect_pixel red.png 8 8 "1.000000 0.000000 0.000000 1.000000"
expect_pixel red.png 2 8 "0.000000 0.000000 1.000000 1.000000"
