#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks what --exposure and --tone make of light in files of 8 and 16 bits, and of nothing else: of
# an opaque slab of 10x8x4 voxels in 12x10x8, four times as bright as white.
# Usage: tone.sh PROGRAM OIIOTOOL SCRATCH
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"
slab=slab_12x10x8_uint8.raw
"$program" synth slab "$slab" --dims 12x10x8 -q
cat >bright.json <<'END'
[{"Name": "bright", "ColorSpaceOfPoints": "linear", "RGBPoints": [0, 4, 1.2, 0.08, 255, 4, 1.2, 0.08],
  "Points": [0, 0, 0.5, 0, 255, 1, 0.5, 0]}]
END

render() { # OUTPUT OPTIONS...: a picture of one pixel a voxel, the volume in its middle
    "$program" render "$slab" -qq --tf bright.json --view front --frame-width 16 --size 16x16 \
        --dither 0 -o "$@"
}

# Light is stored as it is, and clipped where a file ends at white.
grey=(--background 0.18,0.18,0.18)
render plain.exr "${grey[@]}" --float
render plain.png "${grey[@]}"
expect_pixel plain.exr 8 8 "4.000000 1.200000 0.080000 1.000000"
expect_pixel plain.png 8 8 "1.000000 1.000000 0.313726 1.000000"
expect_pixel plain.png 0 0 "0.462745 0.462745 0.462745 1.000000"
expect_metadata plain.png exposure 0
expect_metadata plain.png tone standard

# Exposure is that of all light, the background's included; an .exr has none.
render darker.png "${grey[@]}" --exposure -1
expect_pixel darker.png 8 8 "1.000000 0.796079 0.219608 1.000000"
expect_pixel darker.png 0 0 "0.333333 0.333333 0.333333 1.000000"
expect_metadata darker.png exposure -1
render other.exr "${grey[@]}" --float --exposure -1 --tone filmic
expect_same other.exr plain.exr
expect_metadata other.exr exposure ""
expect_metadata other.exr tone ""

# Filmic rolls off what is bright and leaves middle grey where it is, in every format.
render filmic.png "${grey[@]}" --tone filmic
expect_pixel filmic.png 8 8 "1.000000 0.905882 0.619608 1.000000"
expect_pixel filmic.png 0 0 "0.462745 0.462745 0.462745 1.000000"
expect_metadata filmic.png tone filmic
render filmic.tif "${grey[@]}" --tone filmic
expect_same filmic.tif filmic.png
render both.png "${grey[@]}" --tone filmic --exposure -1
expect_pixel both.png 8 8 "0.980392 0.803922 0.400000 1.000000"
expect_pixel both.png 0 0 "0.282353 0.282353 0.282353 1.000000"

# A .jpg is over black first; without alpha what is black stays so.
render filmic.jpg --tone filmic --size 64x64 --frame-width 64
expect_pixel filmic.jpg 0 0 "0.000000 0.000000 0.000000"
# Without a background what is clear stays clear, and what is opaque is the same.
render clear.png --tone filmic
expect_pixel clear.png 0 0 "0.000000 0.000000 0.000000 0.000000"
expect_pixel clear.png 8 8 "1.000000 0.905882 0.619608 1.000000"

# Light that is thin shows over black what it shows on it.
sed 's/255, 1, 0.5, 0\]/255, 0.05, 0.5, 0]/' bright.json >thin.json
over=(--tf thin.json --tone filmic --bits 16)
render thin.png "${over[@]}"
render black.png "${over[@]}" --background 0,0,0
middle() { # FILE: its values, colours not multiplied by alpha
    "$oiiotool" --iconfig oiio:UnassociatedAlpha 1 "$1" --cut 1x1+8+8 --printstats |
        sed -n 's/^ *Stats Max: \(.*\) (.*$/\1/p'
}
echo "$(middle thin.png) $(middle black.png)" | awk '
    function linear(v) { return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ^ 2.4 }
    function off(a, b) { return a < b ? b - a : a - b }
    { bad = $4 < 0.5 || $4 > 0.9 || $8 != 1 }  # opacity is 0.19
    { for (i = 1; i < 4; ++i) bad = bad || off(linear($i) * $4, linear($(i + 4))) > 1e-4 }
    bad { print "thin.png and black.png: got " $0 "; expected one light"; exit 1 }'

# Ink is no light: letters over black are the same, whatever becomes of the light.
corner=(--size 200x120 --frame-width 60 --background 0,0,0 --annotate "a line" --scale-bar)
render ink.png "${corner[@]}"
render toned_ink.png "${corner[@]}" --tone filmic --exposure -3
for file in ink toned_ink; do "$oiiotool" -q $file.png --cut 200x30+0+0 -o ${file}_top.png; done
expect_same ink_top.png toned_ink_top.png
top=$("$oiiotool" ink_top.png --printstats | sed -n 's/^ *Stats Max: \([^ ]*\) .*/\1/p')
holds "$top > 0.8" || fail "ink_top.png: got $top; expected letters"

# Values stay values.
for mode in mip xray; do
    render values.png --mode $mode
    render same.png --mode $mode --exposure 2 --tone filmic
    expect_same values.png same.png
    expect_metadata same.png tone ""
done

# What halves do not hold is said, wherever it comes from; a .png promises no more than is so.
sed 's/, 4, 1.2/, 1e6, 1.2/g' bright.json >light.json
front=("$slab" --view front --frame-width 16 --size 16x16 -q)
clipped='are brighter than 65504, the most that halves hold, and clipped to it: --float keeps them'
says() { # OUTPUT LIGHT OPTIONS...
    expect_code 0 "$program" render "${front[@]}" -o "$1" --tf "$2" "${@:3}"
    grep -q "^deltasplat: warning: $1: [0-9]* pixels $clipped$" stderr.txt ||
        fail "$*: got $(<stderr.txt); expected a word of halves"
}
says_nothing() {
    expect_code 0 "$program" render "${front[@]}" -o "$1" --tf "$2" "${@:3}"
    ! grep -q 65504 stderr.txt || fail "$*: got $(<stderr.txt); expected no word of halves"
}
says half.exr light.json
expect_pixel half.exr 8 8 "65504.000000 1.200195 0.080017 1.000000"
says behind.exr bright.json --background 1e6,0,0
grep -q ": $((16 * 16 - 10 * 8)) pixels" stderr.txt || fail "behind.exr: got $(<stderr.txt)"
says part.exr light.json --region 8x8+4+4
says deep.exr light.json --deep
says_nothing whole.exr light.json --float
expect_pixel whole.exr 8 8 "1000000.000000 1.200000 0.080000 1.000000"
says_nothing deep_whole.exr light.json --deep --float
says_nothing bright.exr bright.json
expect_code 0 "$program" render "${front[@]}" -o light.png --tf light.json
grep -q 'an .exr with --float keeps them$' stderr.txt || fail "light.png: got $(<stderr.txt)"
expect_code 0 "$program" render "${front[@]}" -o bright.png --tf bright.json
grep -q 'an .exr keeps them$' stderr.txt || fail "bright.png: got $(<stderr.txt)"
