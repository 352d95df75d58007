#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks the values that modes other than composite store, and what becomes of them in a .png: of a
# slab of 10x8x4 voxels of 255 in 12x10x8 voxels of 0.
# Usage: modes.sh PROGRAM OIIOTOOL SCRATCH
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"
slab=slab_12x10x8_uint8.raw
"$program" synth slab "$slab" --dims 12x10x8 -q

render() { # OUTPUT OPTIONS...: a picture of one pixel a voxel, the volume in its middle
    "$program" render "$slab" -q --view front --frame-width 16 --size 16x16 -o "$@"
}

# Integrals in world units, as 32-bit floats without being asked: halves would round them.
render xray.exr --mode xray --spacing 1,1,2.5
expect_pixel xray.exr 8 8 "2550.000000 2550.000000 2550.000000 2550.000000"
expect_pixel xray.exr 0 0 "0.000000 0.000000 0.000000 0.000000"
render fine.exr --mode xray --spacing 1,1,1.001
# 1020 x 1.001, as 32-bit floats have it.
expect_pixel fine.exr 8 8 "1021.020020 1021.020020 1021.020020 1021.020020"
expect_metadata xray.exr mode xray
expect_metadata xray.exr xrayScale ""
expect_metadata xray.exr method ""

# In a .png the largest is white, and the metadata say what that stands for.
render xray.png --mode xray --spacing 1,1,2.5 --background 0,0,0
expect_pixel xray.png 8 8 "1.000000 1.000000 1.000000 1.000000"
expect_pixel xray.png 0 0 "0.000000 0.000000 0.000000 1.000000"
expect_metadata xray.png xrayScale 2550

expect_metadata xray.png window 0,2550
# Greys of a window, opaque where the volume is (voxels whole) and nowhere else.
render window.png --mode xray --spacing 1,1,2.5 --window=-2550,7650 --dither 0
expect_pixel window.png 8 8 "0.501961 0.501961 0.501961 1.000000"
# A corner of air, beside the slab: nothing of it.
expect_pixel window.png 2 3 "0.250980 0.250980 0.250980 1.000000"
expect_pixel window.png 0 0 "0.000000 0.000000 0.000000 0.000000"
expect_metadata window.png window -2550,7650
expect_metadata window.png xrayScale 7650
render window.png --mode mip --window 51,255 --bits 16
expect_pixel window.png 8 8 "1.000000 1.000000 1.000000 1.000000"
expect_pixel window.png 2 8 "0.000000 0.000000 0.000000 1.000000"
expect_metadata window.png window 51,255

# Values below 0, as air has: black is the least, and what is beside the volume is clear.
air='\x18\xfc' tissue='\x64\x00'
for z in {0..7}; do
    for y in {0..15}; do
        for x in {0..15}; do
            (( x >= 4 && x < 12 && y >= 4 && y < 12 )) && printf "$tissue" || printf "$air"
        done
    done
done >hu_16x16x8_int16.raw
"$program" render hu_16x16x8_int16.raw -q --view front --frame-width 18 --size 18x18 -o hu.png --mode xray
expect_pixel hu.png 3 3 "0.000000 0.000000 0.000000 1.000000"
expect_pixel hu.png 0 9 "0.000000 0.000000 0.000000 0.000000"
middle=$("$oiiotool" hu.png --cut 1x1+9+9 --printstats | sed -n 's/^ *Stats Max: \([^ ]*\) .*/\1/p')
holds "$middle > 0.9" || fail "hu.png: got $middle in the middle; expected nearly white"

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

# Means and smallest values.
render average.exr --mode average
expect_pixel average.exr 8 8 "127.500000 127.500000 127.500000 1.000000"
expect_pixel average.exr 0 8 "0.000000 0.000000 0.000000 0.000000"
render min.exr --mode min
expect_pixel min.exr 8 8 "0.000000 0.000000 0.000000 1.000000"
expect_metadata min.exr mode min

# The slab's first slice is the second of seven steps of depth.
render shaded.exr --mode mip --depth-shade 0.7
expect_pixel shaded.exr 8 8 "204.000000 204.000000 204.000000 1.000000"
expect_metadata shaded.exr depthShade 0.7

# From an eye on the axis pixels in the middle go through both faces.
eye=(--projection perspective --distance 4000 --fov 0.23)
"$program" render "$slab" -q --view front --size 16x16 "${eye[@]}" -o eye.exr --mode xray
got=$("$oiiotool" eye.exr --cut 1x1+8+8 --printstats | sed -n 's/^ *Stats Max: \([0-9]*\.[0-9]\).*/\1/p')
[[ $got == 1020.0 ]] || fail "eye.exr: got $got; expected 1020.0"
"$program" render "$slab" -q --view front --size 16x16 "${eye[@]}" -o eye.png --mode xray
expect_pixel eye.png 8 8 "1.000000 1.000000 1.000000 1.000000"
expect_pixel eye.png 0 0 "0.000000 0.000000 0.000000 0.000000"

# A radiograph: 8 slices of -900 HU of 2.5 mm let exp(-0.02 * 0.1 * 20) through, and all of it what
# passes by. In a .png what lets little through is white.
thin=(hu_16x16x8_int16.raw -qq --view front --frame-width 32 --size 32x32 --spacing 1,1,2.5)
air='\x7c\xfc' tissue='\x64\x00'
for z in {0..7}; do
    for y in {0..15}; do
        for x in {0..15}; do
            (( x >= 4 && x < 12 && y >= 4 && y < 12 )) && printf "$tissue" || printf "$air"
        done
    done
done >hu_16x16x8_int16.raw
"$program" render "${thin[@]}" -o drr.exr --mode drr --mu-water 0.02 --photons 1e6
expect_pixel drr.exr 1 1 "1000000.000000 1000000.000000 1000000.000000 1.000000"
expect_pixel drr.exr 16 16 "644036.437500 644036.437500 644036.437500 1.000000"
expect_metadata drr.exr muWater 0.02
expect_metadata drr.exr photons 1e+06
"$program" render "${thin[@]}" -o drr.png --drr --background 1,0,0
expect_pixel drr.png 1 1 "0.000000 0.000000 0.000000 1.000000"
expect_pixel drr.png 16 16 "1.000000 1.000000 1.000000 1.000000"

# Numbers, one for each pixel: those of the .exr, row by row; nothing is no number.
numbers() { od -An -v -tf4 -w4 -j"$2" "$1" | tr -d ' '; } # FILE BYTES-BEFORE
at() { numbers "$1" "$2" | sed -n "$((16 * $4 + $3 + 1))p"; }  # FILE BYTES-BEFORE X Y
for name in npy nrrd mha tif; do render mip.$name --mode mip --float; done
[[ $(at mip.npy 128 8 8) == 255 && $(at mip.npy 128 2 8) == 0 && $(at mip.npy 128 0 8) == *nan* ]] ||
    fail "mip.npy holds other numbers"
for name in nrrd mha; do
    before=$(($(stat -c %s mip.$name) - 16 * 16 * 4))
    cmp <(tail -c +129 mip.npy) <(tail -c +$((before + 1)) mip.$name) || fail "mip.$name holds other numbers"
done
grep -aq '^sizes: 16 16 1$' mip.nrrd || fail "mip.nrrd has another size"
expect_pixel mip.tif 8 8 "255.000000"
render xray.npy --mode xray
[[ $(at xray.npy 128 0 0) == 0 ]] || fail "xray.npy: got $(at xray.npy 128 0 0) beside the volume; expected 0"
"$program" render "${thin[@]}" -o drr.npy --mode drr --mu-water 0.02 --photons 1e6
[[ $(numbers drr.npy 128 | sed -n "$((32 * 16 + 17))p") == 644036.4* ]] || fail "drr.npy holds other numbers"
expect_code 2 "$program" render "$slab" -o light.npy
expect_said "deltasplat: --output: got light.npy with --mode composite; expected a mode of numbers: xray, mip, min, average or drr"
expect_code 2 "$program" render "$slab" -o light.tif --float
expect_said "deltasplat: --float: got light.tif; expected an .exr file"
expect_code 2 "$program" render "$slab" -o all.nrrd --mode mip --projection latlong
expect_said "deltasplat: --output: got all.nrrd with --projection latlong; expected a flat picture, or .npy"
expect_code 2 "$program" render "$slab" -o axes.npy --mode mip --axes
expect_files "" '{light,all,axes}.*'

# A C-arm: what one voxel casts falls where the formula of docs/cameras.md has it, in each frame.
{ for i in {0..26}; do ((i == 13)) && printf '\x01' || printf '\x00'; done; } >ball_3x3x3_uint8.raw
cat >poses.csv <<'END'
primary,secondary,sid,sdd,pixel
0,0,1000,1500,1.5
90,0,1000,1500,1.5
0,-90,1000,1200,1.2
END
# The voxel lies 3.5 mm to the patient's left (x), 5.5 to the head (y) and 8.5 to the front (z).
arm=(ball_3x3x3_uint8.raw -qq --origin 2.5,4.5,7.5 --target 0,0,0 --size 64x48 --mode mip)
"$program" render "${arm[@]}" --poses poses.csv -o arm.#.npy
expect_files "arm.1.npy arm.2.npy arm.3.npy" 'arm.*'
brightest() { # FILE WIDTH
    numbers "$1" 128 | awk -v w="$2" '$1 !~ /nan/ && $1 > most { most = $1; n = NR - 1 } END { print n % w, int(n / w) }'
}
# From behind 32 - 3.5 * 1000 / 1008.5 and 24 - 5.5 * 1000 / 1008.5; from the right 32 + 8.5 * 1000 /
# 1003.5 and 24 - 5.5 * 1000 / 1003.5; from the head 32 - 3.5 * 1000 / 994.5 and 24 - 8.5 * 1000 / 994.5.
expected=("28 18" "40 18" "28 15")
for frame in 1 2 3; do
    got=$(brightest arm.$frame.npy 64)
    [[ $got == "${expected[frame - 1]}" ]] || fail "arm.$frame.npy: got the voxel at $got; expected ${expected[frame - 1]}"
done
"$program" render "${arm[@]}" --view back --sid 1000 --sdd 1500 --detector 96x72 -o arm.npy
cmp arm.npy arm.1.npy || fail "a pose is another picture than the options that it stands for"
"$program" render "${arm[@]}" --poses poses.csv -o arm.#.mha --frames 2
grep -aq '^ElementSpacing = 1.5 1.5 1.5$' arm.2.mha || fail "arm.2.mha has other pixels than the detector"
expect_code 2 "$program" render "${arm[@]}" --poses poses.csv -o arm.#.npy --frames 3-4
expect_said "deltasplat: --frames: got 4; expected 1 to 3, a line of --poses for each"
expect_code 2 "$program" render "${arm[@]}" --poses poses.csv -o arm.#.npy --sid 3
expect_said "deltasplat: --sid: got it and --poses; expected the camera one way or the other"
expect_code 3 "$program" render "${arm[@]}" --poses hu_16x16x8_int16.raw -o arm.#.npy
