#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What options leave of a volume is in the picture where it was, in the colours that it had.
# Usage: parts.sh PROGRAM OIIOTOOL SCRATCH
set -euo pipefail
program=$1 oiiotool=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
failed=0
fail() { echo "$*"; failed=1; }

pixels() { # VOLUME OPTIONS...: what the picture's pixels come to
    "$program" render "$1" -o out.exr --size 40x40 --view iso -q -q --float "${@:2}"
    "$oiiotool" --info --hash out.exr | sed -n 's/^ *SHA-1: //p'
}
same() { [[ $1 == "$2" ]] || fail "$3: other pixels"; }
differ() { [[ $1 != "$2" ]] || fail "$3: the same pixels"; }

# Slices of a raw file are a file of their own.
whole=engine_32x32x32_uint8.raw
part=part_32x32x16_uint8.raw
"$program" synth engine $whole --dims 32x32x32
head -c 24576 $whole | tail -c 16384 >$part
for mode in composite xray mip; do
    wanted=$(pixels $part --origin 0,0,8 --mode $mode --range 10,200)
    options=(--mode $mode --range 10,200)
    differ "$wanted" "$(pixels $whole "${options[@]}")" "$mode: all"
    same "$wanted" "$(pixels $whole "${options[@]}" --slices 8:23)" "$mode: slices"
    same "$wanted" "$(pixels $whole "${options[@]}" --slices 8: --slices z:8:23)" "$mode: z"
    same "$wanted" "$(pixels $whole "${options[@]}" --crop :,:,8:23)" "$mode: crop"
    same "$wanted" "$(pixels $whole "${options[@]}" --crop 0:40,-3:,:23 --slices 8:)" "$mode: both"
    same "$wanted" "$(pixels $whole "${options[@]}" --crop world::,:,7.2:23.9)" "$mode: world"
done

# Planes and masks leave the camera where it was.
head -c 12288 /dev/zero >mask_32x32x32_uint8.raw
head -c 12288 /dev/zero | tr '\0' '\1' >>mask_32x32x32_uint8.raw
head -c 8192 /dev/zero >>mask_32x32x32_uint8.raw
"$program" convert mask_32x32x32_uint8.raw mask.vdb --background 0
camera=(--target 15.5,15.5,15.5 --frame-width 60 --range 10,200)
wanted=$(pixels $whole "${camera[@]}" --slices 12:23)
planes=(--clip 0,0,12,0,0,2 --clip 9,9,23.4,0,0,-1)
same "$wanted" "$(pixels $whole "${camera[@]}" "${planes[@]}")" "planes"
differ "$wanted" "$(pixels $whole "${camera[@]}" "${planes[@]:2}")" "one plane"
same "$wanted" "$(pixels $whole "${camera[@]}" --mask mask_32x32x32_uint8.raw)" "mask"
same "$wanted" "$(pixels $whole "${camera[@]}" --mask mask.vdb)" "mask.vdb"
"$program" info mask.vdb --list | sed -n 's/^ *\([a-z_0-9]*\) .*/\1/p' >grids
grid=$(head -n 1 grids)
same "$wanted" "$(pixels $whole "${camera[@]}" --mask "mask.vdb:$grid")" "grid of a mask"
cp mask_32x32x32_uint8.raw plain.raw
same "$wanted" "$(pixels $whole "${camera[@]}" --dims 32x32x32 --type uint8 --mask plain.raw)" "plain"
default=$(pixels $whole --range 10,200 "${planes[@]}")
framed=$(pixels $whole --range 10,200 --slices 12:23)
differ "$default" "$framed" "planes, framed"

# Colours are those of all, whatever is cut off.
v=v_8x8x8_uint16.raw
for _ in {1..128}; do printf 'd\0\214\0'; done >$v
for _ in {1..256}; do printf '\310\0'; done >>$v
head -c 512 $v >half_8x8x4_uint16.raw
echo '{"RGBPoints": [0, 1, 0, 0, 1, 0, 0, 1], "Points": [0, 0.1, 0.5, 0, 1, 0.5, 0.5, 0],
    "Normalized": true}' >normalized.json
for tf in viridis normalized.json; do
    wanted=$(pixels half_8x8x4_uint16.raw --tf $tf --range 100,200)
    differ "$wanted" "$(pixels half_8x8x4_uint16.raw --tf $tf)" "$tf: a half"
    same "$wanted" "$(pixels $v --tf $tf --slices 0:3)" "$tf: half of all"
done
wanted=$(pixels half_8x8x4_uint16.raw --range 100,200)
same "$wanted" "$(pixels $v --slices 0:3)" "ramp: half of all"

# Labels.
table() { # OPACITIES...: of the labels 100, 140 and 200
    printf '100 a 200 30 30 %s\n140 b 30 200 30 %s\n200 c 30 30 200 %s\n' "$@"
}
table 255 51 255 >all.ctbl
table 255 0 255 >hidden.ctbl
table 0 51 0 >shown.ctbl
table 102 51 255 >thin.ctbl
labels() { pixels $v --tf "$@"; }
differ "$(labels all.ctbl)" "$(labels hidden.ctbl)" "hidden"
same "$(labels hidden.ctbl)" "$(labels all.ctbl --hide-labels 140)" "hidden"
same "$(labels shown.ctbl)" "$(labels all.ctbl --show-labels 140)" "shown"
same "$(labels shown.ctbl)" "$(labels all.ctbl --show-labels 100,140 --hide-labels 100)" "both"
same "$(labels thin.ctbl)" "$(labels all.ctbl --label-opacity 100=0.4,200=1)" "thin"
differ "$(labels labels)" "$(labels labels --hide-labels 200)" "preset"

"$program" bench $whole --crop 4:20,4:20,4:20 --size 16x16 --repeats 1 --json >bench.json
grep -q '"dims": *\[ *17, *17, *17' <(tr -d '\n' <bench.json) || fail "bench: dims of all"
exit $failed
