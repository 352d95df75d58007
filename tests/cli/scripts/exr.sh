#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# How pictures lie in an .exr, as another program reads it: windows, regions, overscan, how numbers
# are packed, colours, and where the matrices say that things are.
# Usage: exr.sh PROGRAM OIIOTOOL SCRATCH
source "${BASH_SOURCE%/*}/pictures.sh"
begin "$@"
engine=engine_32x32x32_uint8.raw
"$program" synth engine $engine --dims 32x32x32 -q

render() { # PICTURE OPTIONS...: off the frame's middle
    local float=--float
    [[ $1 == *.exr ]] || float=
    "$program" render $engine -qq --view iso --size 64x48 $float --target 30,10,16 -o "$@"
}
near=(--frame-width 90)
info() { "$oiiotool" --info -v "$1"; }
# WIDTHxHEIGHT+X+Y of the data window, and WIDTHxHEIGHT of the display window.
windows() {
    info "$1" | awk '
        NR == 2 { width = $3; height = $5; sub(",", "", height) }
        /pixel data origin:/ { gsub("[^0-9-]+", " "); x = $1; y = $2 }
        /full\/display size:/ { full = $3 "x" $5 }
        END { printf "%sx%s%+d%+d %s\n", width, height, x, y, full ? full : width "x" height }'
}
expect_windows() { # FILE WINDOWS
    [[ $(windows "$1") == "$2" ]] || fail "$1: got windows $(windows "$1"); expected $2"
}

# What is not clear, as another program trims it.
render whole.exr "${near[@]}"
render crop.exr "${near[@]}" --autocrop
"$oiiotool" -q whole.exr --trim -o trimmed.exr
expect_windows whole.exr "64x48+0+0 64x48"
expect_windows crop.exr "$(windows trimmed.exr)"
[[ $(windows crop.exr) != "64x48+0+0 64x48" ]] || fail "crop: got all of the picture"
"$oiiotool" -q crop.exr --croptofull -o full.exr
expect_same full whole
render none.exr "${near[@]}" --autocrop --extinction 0
expect_windows none.exr "1x1+0+0 64x48"
render channels.exr "${near[@]}" --autocrop --aov depth,transmittance
expect_windows channels.exr "$(windows trimmed.exr)"
render deep.exr "${near[@]}" --deep --autocrop --compression zips:2
expect_windows deep.exr "$(windows trimmed.exr)"

# Pixels of a region are those of the whole: of light alone, with channels, of values, deep, in
# files of 8 bits, from an eye.
expect_part() { # NAME SUFFIX OPTIONS...
    local name=$1 suffix=$2
    render "${name}_whole.$suffix" "${@:3}"
    render "${name}_part.$suffix" "${@:3}" --region 21x17+23+19
    if [[ $suffix == exr ]]; then
        expect_windows "${name}_part.exr" "21x17+23+19 64x48"
        "$oiiotool" -q "${name}_part.exr" --croptofull --cut 21x17+23+19 -o "${name}_cut.exr"
    else
        cp "${name}_part.$suffix" "${name}_cut.$suffix"
    fi
    "$oiiotool" -q "${name}_whole.$suffix" --cut 21x17+23+19 -o "${name}_expected.$suffix"
    expect_same "${name}_cut.$suffix" "${name}_expected.$suffix"
    [[ $(most "${name}_cut.$suffix") == *[1-9]* ]] || fail "$name: got nothing in the region"
}
eye=(--projection perspective --fov 40 --distance 60)
expect_part light exr "${near[@]}" --background 0.1,0.2,0.3,0.5
expect_part channels exr "${near[@]}" --aov depth,normal
expect_part eye exr "${eye[@]}" --tolerance 0.05 --method delta
expect_part values exr "${near[@]}" --mode mip
expect_part bytes png "${near[@]}" --background 0.1,0.2,0.3
expect_part greys png "${near[@]}" --mode xray
render corners.exr "${eye[@]}" --tolerance 0.05 --method delta --region 23,19,43,35
expect_same corners eye_part
bound() { info "$1" | grep -o 'errorBound: .*'; }
[[ $(bound eye_part.exr) == *[1-9]* ]] || fail "region: got no bound of what tolerance changes"
render seen.exr "${near[@]}" --region 40x20+0+0 --autocrop
"$oiiotool" -q whole.exr --crop 40x20+0+0 --trim -o seen_expected.exr
expect_windows seen.exr "$(windows seen_expected.exr)"

# Pixels beyond the frame, which stays where it was.
for overscan in 8,6 12.5%; do
    render wide.exr "${near[@]}" --overscan $overscan
    expect_windows wide.exr "80x60-8-6 64x48"
done
"$oiiotool" -q wide.exr --croptofull -o frame.exr
expect_same frame whole 1e-3
render wide_part.exr "${near[@]}" --overscan 8,6 --region 10x9-4+45
expect_windows wide_part.exr "10x9-4+45 64x48"
"$oiiotool" -q wide.exr --cut 10x9-4+45 -o wide_expected.exr
"$oiiotool" -q wide_part.exr --cut 10x9-4+45 -o wide_cut.exr
expect_same wide_cut wide_expected
# The camera that is told is the same one.
camera=$(info wide.exr | sed -n 's/^ *deltasplat:camera: "\(.*\)"$/\1/p')
"$program" render $engine -qq --float -o again.exr $camera
expect_same again wide

# How numbers are packed.
for compression in none rle zip zips piz pxr24 b44 b44a dwaa dwab; do
    render packed.exr "${near[@]}" --compression $compression
    info packed.exr | grep >/dev/null "compression: \"$compression" || fail "$compression: got another"
    same packed whole 2e-2 || fail "$compression: got another picture"
done
size() { stat -c %s "$1"; }
render fine.exr "${near[@]}" --compression dwaa:1
render coarse.exr "${near[@]}" --compression dwaa:2000
((  $(size coarse.exr) < $(size fine.exr) )) || fail "dwaa:2000 is no smaller than dwaa:1"
render most.exr "${near[@]}" --compression dwaa:0
(( $(size most.exr) > $(size fine.exr) )) || fail "dwaa:0 is no larger than dwaa:1"
render half.exr "${near[@]}" --compression dwaa:1.5
info half.exr | grep >/dev/null 'dwaCompressionLevel: 1.5$' || fail "dwaa:1.5: got another level"
grep -qa capDate whole.exr deep.exr && fail "got a date"
info whole.exr | grep >/dev/null 'chromaticities: 0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329' ||
    fail "whole.exr: got other colours than those of Rec. 709"
info values_whole.exr | grep >/dev/null chromaticities && fail "values_whole.exr: got colours of values"

# A single voxel lies where another reader's matrices say: worldToNDC times the frame's size, and
# worldToCamera looks along z.
head -c 729 /dev/zero >point_9x9x9_uint8.raw
printf '\xff' | dd of=point_9x9x9_uint8.raw bs=1 seek=$(((6 * 9 + 2) * 9 + 3)) conv=notrunc status=none
matrix() { # FILE NAME: 16 numbers, rows of a matrix that a row (x, y, z, 1) is multiplied by
    info "$1" | sed -n "s/^ *$2: //p" | tr -d ,
}
for projection in ortho "perspective --fov 35"; do
    for overscan in 0 7,3; do
        "$program" render point_9x9x9_uint8.raw -qq --float --view iso --azimuth 20 --size 200x150 \
            --projection $projection --spacing 2,1,3 --origin 5,-4,1 --tf grey --range 0,255 \
            --overscan $overscan -o point.exr
        # Its middle is that of what is brightest.
        "$oiiotool" -q point.exr --subc "$(awk "BEGIN { print 0.9 * $(most point | cut -d' ' -f1) }")" --clamp:min=0,0,0,0 --trim -o brightest.exr
        read -r x y <<<"$(windows brightest.exr | sed 's/[x+]/ /g; s/-/ -/g' |
            awk '{ print $3 + $1 / 2, $4 + $2 / 2 }')"
        awk -v m="$(matrix point.exr worldToNDC)" -v c="$(matrix point.exr worldToCamera)" -v x="$x" \
            -v y="$y" 'BEGIN {
                split(m, n, " "); split(c, k, " "); split("11 -2 19 1", p, " ")
                for (j = 1; j <= 4; ++j)
                    for (i = 1; i <= 4; ++i) { v[j] += p[i] * n[4 * i - 4 + j]; w[j] += p[i] * k[4 * i - 4 + j] }
                dx = 200 * v[1] / v[4] - x; dy = 150 * v[2] / v[4] - y
                exit !(dx * dx < 1 && dy * dy < 1 && w[3] > 0 && w[4] == 1) }' ||
            fail "$projection, overscan $overscan: the voxel at $x,$y is not where the matrices say"
    done
done

# Layers in parts of their own, which hold the same.
layers=(--aov depth,normal,transmittance --autocrop)
render flat.exr "${near[@]}" "${layers[@]}"
render parted.exr "${near[@]}" "${layers[@]}" --multipart
names=$("$oiiotool" -a --info -v parted.exr | sed -n 's/^ *channel list: //p' | tr '\n' ';')
[[ $names == "R, G, B, A;Z;N.X, N.Y, N.Z;transmittance;" ]] || fail "parted.exr: got parts $names"
"$oiiotool" -a --info -v parted.exr | grep >/dev/null 'name: "depth"' || fail "parted.exr: got no part depth"
part() { # NUMBER CHANNELS
    "$oiiotool" -q parted.exr --subimage "$1" -o part.exr
    "$oiiotool" -q flat.exr --ch "$2" -d float -o flat_part.exr
    expect_windows part.exr "$(windows flat.exr)"
    expect_same part flat_part
}
part 0 R,G,B,A
part 1 Z
part 2 N.X,N.Y,N.Z
part 3 transmittance

# A large picture, made in parts, is the one that is made at once.
large=(--size 2304x1900 --frame-width 40 --tf grey)
render parts.exr "${large[@]}"
render once.exr "${large[@]}" --aov transmittance
"$oiiotool" -q once.exr --ch R,G,B,A -o once_light.exr
expect_same parts once_light
