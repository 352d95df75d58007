#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks that what --tf names is what pictures and stamps are made with.
# Usage: transfer_functions.sh PROGRAM OIIOTOOL SCRATCH
set -euo pipefail
program=$1 oiiotool=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"

pixels() { # VOLUME OPTIONS...: what the picture's pixels come to
    local volume=$1
    shift
    "$program" render "$volume" -o out.exr --size 24x24 -q "$@"
    "$oiiotool" --info --hash out.exr | sed -n 's/^ *SHA-1: //p'
}
same() { [[ $1 == "$2" ]] || { echo "$3: other pixels"; exit 1; }; }
differ() { [[ $1 != "$2" ]] || { echo "$3: the same pixels"; exit 1; }; }

# Half of the voxels are 100, the others 140.
v=v_8x8x8_uint8.raw
for _ in {1..256}; do printf 'd\214'; done >$v
viridis=$(pixels $v --tf viridis)
same "$viridis" "$(pixels $v --tf viridis --range 100,140)" "most values, and their range"
differ "$viridis" "$(pixels $v --tf viridis --range 0,255)" "most values, and all there may be"
mkdir viridis
same "$viridis" "$(pixels $v --tf viridis)" "a preset, and a folder of its name"

second='"RGBPoints": [100, 0, 1, 0, 140, 0, 0, 1], "Points": [0, 0.5, 0.5, 0]}'
echo '[{"Name": "first", "RGBPoints": [100, 1, 0, 0], "Points": [0, 0.5, 0.5, 0]},
    {"Name": "CT: Fat", '"$second]" >two.json
cp two.json two.txt
cp two.json c:t.json
echo "{$second" >second.json
wanted=$(pixels $v --tf second.json)
for tf in "two.json:CT: Fat" "two.txt:CT: Fat" "c:t.json:CT: Fat"; do
    same "$wanted" "$(pixels $v --tf "$tf")" "$tf"
done
for tf in two.json two.json:first two.txt c:t.json; do
    differ "$wanted" "$(pixels $v --tf "$tf")" "$tf"
done

# Fire is clear below a twentieth of its range, of which 7 of 255 is less.
fuel=fuel_64x64x64_uint8.raw
head -c 262144 /dev/zero | tr '\0' '\7' >$fuel
differ "$(pixels $fuel --tf fire)" "$(pixels $fuel --tf fire --range 0,255)" "one value"
"$program" info $fuel --tf fire --json >info.json
"$program" bench table1 . --tf fire --repeats 1 --json >table1.json 2>/dev/null || [[ $? == 3 ]]
grep -Eq '"sparse": ?262144\b' info.json || { echo "info: not all is stamped"; exit 1; }
grep -Eq '"visible": ?262144\b' table1.json || { echo "table1: not all is visible"; exit 1; }
