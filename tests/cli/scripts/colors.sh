#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Colour management, beside what another program makes of the same with the same configuration.
# Usage: colors.sh PROGRAM OIIOTOOL SCRATCH DATA
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"
data=$4
config=$data/config.ocio
"$program" synth engine engine_32x32x32_uint8.raw --dims 32x32x32 -q
unset OCIO

render() { # FILE OPTIONS...
    "$program" render engine_32x32x32_uint8.raw -qq --view iso --size 64x48 --color-by index -o "$@"
}
with_ocio() { OCIO=$config "$@"; }

# Light in other colours, all of it or a region, and what is known of their primaries.
render plain.exr --float --background 0.2,0.1,0.4,0.7 --aov emission
"$oiiotool" -q --colorconfig "$config" plain.exr --ch R,G,B,A --colorconvert:unpremult=1 lin_srgb ACEScg \
    -d float -o expected.exr
render acescg.exr --float --background 0.2,0.1,0.4,0.7 --ocio "$config" --colorspace ACEScg --aov emission
"$oiiotool" -q acescg.exr --ch R,G,B,A -d float -o got.exr
expect_same got expected 1e-5
expect_different got plain 1e-2
"$oiiotool" -q plain.exr --ch emission.R,emission.G,emission.B --chnames R,G,B \
    --colorconfig "$config" --colorconvert lin_srgb ACEScg -d float -o expected_emission.exr
"$oiiotool" -q acescg.exr --ch emission.R,emission.G,emission.B --chnames R,G,B -d float -o emission.exr
expect_same emission expected_emission 1e-5
with_ocio render part.exr --float --background 0.2,0.1,0.4,0.7 --colorspace ACEScg --region 30x20+10+12
"$oiiotool" -q part.exr --cut 30x20+10+12 -o part_cut.exr
"$oiiotool" -q got.exr --cut 30x20+10+12 -o got_cut.exr
expect_same part_cut got_cut
expect_metadata acescg.exr colorSpace ACEScg
info=$("$oiiotool" --info -v acescg.exr)
[[ $info == *"chromaticities: 0.713, 0.293, 0.165, 0.83"* ]] || fail "acescg.exr: got other primaries"

# What a display shows: that of sRGB what is shown without one.
for format in png tif jpg; do
    render bare.$format --background 0.2,0.1,0.4 --dither 0
    with_ocio render shown.$format --background 0.2,0.1,0.4 --dither 0 --display sRGB
    expect_same shown.$format bare.$format 0.005
    with_ocio render half.$format --background 0.2,0.1,0.4 --dither 0 --display-view Half
    expect_different half.$format bare.$format 0.1
done
"$oiiotool" -q bare.png --mulc 0.5,0.5,0.5,1 -o half_expected.png
expect_same half.png half_expected.png 0.01

# A look of display values.
cp "$data/swap.cube" .
render swapped.png --background 0.2,0.1,0.4 --dither 0 --look swap.cube
"$oiiotool" -q bare.png --ch B,G,R,A --chnames R,G,B,A -o swap_expected.png
expect_same swapped.png swap_expected.png 0.005

# Braces in a table that cannot be read, or in its name, are no format of a message.
printf 'LUT_1D_SIZE 2\n0 0 0\n1 1 1\n{:x \033[31mRED\a\n' >brace.cube
mkdir 'a{b}'
cp brace.cube swap.cube 'a{b}'
for file in brace.cube 'a{b}/brace.cube'; do
    expect_code 3 "$program" render engine_32x32x32_uint8.raw -o no.png --size 9x9 -q --look "$file"
    [[ $(wc -l <stderr.txt) == 1 && $(<stderr.txt) == *"got $file: "* ]] ||
        fail "$file: got $(<stderr.txt); expected one line that names it"
    ! grep -q $'\033' stderr.txt || fail "$file: got its escapes"
done
expect_files "" 'no.png*'
render braced.png --background 0.2,0.1,0.4 --dither 0 --look 'a{b}/swap.cube'
expect_same braced.png swapped.png
