#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the pictures of docs/gallery.md: of sample volumes, and of real ones if their folder is
# there. Needs the program: build/release/bin/deltasplat, or the one on the path.
# Usage: bash examples/gallery.sh [FOLDER [DATA]]   (default: out/gallery, no real volumes)
set -euo pipefail
here=$(pwd)
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=$(cd "$here" && realpath -m -- "${1:-out/gallery}")
data=${2:+$(cd "$here" && realpath -- "$2")}
program=build/release/bin/deltasplat
[[ -x $program ]] || program=deltasplat
size=${SIZE:-400}
mkdir -p "$folder"

engine=$folder/engine_256x256x256_uint8.raw
body=$folder/body_256x256x256_uint8.raw
vessels=$folder/vessels_256x256x256_uint8.raw
orbital=$folder/hydrogen_128x128x128_float32.raw
signal=$folder/signal_96x96x96_float32.raw
make() { [[ -e $2 ]] || "$program" synth "$@" -q; }
make engine "$engine" --dims 256x256x256 --samples 3
make body "$body" --dims 256x256x256
make vessels "$vessels" --dims 256x256x256 --noise 0.08
make hydrogen "$orbital" --dims 128x128x128 --type float32
make marschner-lobb "$signal" --dims 96x96x96 --type float32
make cloud "$folder/cloud.vdb" --dims 192x192x192
make fire "$folder/fire.vdb" --dims 192x192x192 --seed 3
make explosion "$folder/explosion.vdb" --dims 192x192x192

draw() { # name, volume, options
    "$program" render "$2" -o "$folder/$1.png" --size "${size}x$size" --dither 0 -q "${@:3}"
}
dark=(--background 0.01,0.012,0.02)

draw engine "$engine" --tf examples/engine.json --shade --view iso "${dark[@]}"
draw engine-surface "$engine" --isovalue 57 --view iso --surface-color 0.55,0.56,0.6 \
    --light view:1,-1,-1:1,0.95,0.9:0.9 --light head:0.35 "${dark[@]}"
draw engine-half "$engine" --tf examples/engine.json --shade --view iso "${dark[@]}" \
    --clip 127,127,127,0,0,-1
draw engine-xray "$engine" --mode xray --view right --azimuth 20 --elevation 10 --sid 1000 \
    --sdd 1500 --detector 560x560 --background 0,0,0
draw body "$body" --tf examples/body.ctbl --shade --view front --azimuth 25 --elevation 8 \
    "${dark[@]}" --legend --axes
draw body-bones "$body" --tf examples/body.ctbl --shade --show-labels 2,4,7,10,11 --view front \
    --azimuth -30 "${dark[@]}"
draw vessels "$vessels" --tf mr-angio --range 70,255 --shade --view front --azimuth 30 \
    "${dark[@]}"
draw vessels-mip "$vessels" --mode mip --depth-shade 0.8 --view front --azimuth 30 \
    --background 0,0,0 --scale-bar
draw hydrogen "$orbital" --tf inferno --range 0,0.25 --shade --view iso "${dark[@]}"
draw signal "$signal" --isovalue 0.5 --view iso --surface-color 0.7,0.55,0.3 "${dark[@]}"
cloud=(--extinction 3 --azimuth 30 --elevation 10 --scatter-octaves 5)
draw cloud "$folder/cloud.vdb" "${cloud[@]}" --sky 0.6,0.8,0.9:3 --anisotropy 0.7,-0.2,0.3 \
    --background 0.1,0.2,0.42
dim=(--tone filmic --exposure=-0.5)
draw cloud-sunset "$folder/cloud.vdb" "${cloud[@]}" --lighting scatter \
    --light=-1,-0.15,0.4:1,0.3,0.07:6 --light 0.2,-1,0.1:0.2,0.3,0.8:1.5 \
    --anisotropy 0.6,-0.3,0.4 --background 0.1,0.07,0.14 "${dim[@]}"
draw cloud-backlit "$folder/cloud.vdb" "${cloud[@]}" --lighting scatter \
    --light 0.35,-0.35,1:1,0.78,0.55:3 --ambient 0.04 --anisotropy 0.75,-0.2,0.3 \
    --background 0.05,0.09,0.18 "${dim[@]}"
flame=(--temperature-scale 1500,600 --emission-strength 0.25 --tone filmic)
draw fire "$folder/fire.vdb" --layer flame:fire "${flame[@]}" --background 0.01,0.012,0.02
draw fire-smoke "$folder/fire.vdb" --emission-grid flame "${flame[@]}" --extinction 2 \
    --sky 0.6,0.8,0.9:0.3 --emission-lights 16 --scatter-octaves 4 --background 0.01,0.02,0.045
draw explosion "$folder/explosion.vdb" --emission-grid temperature --color-grid Cd \
    --density-scale 1 --sky 0.6,0.8,0.9:3 --scatter-octaves 1 --background 0.1,0.2,0.42 \
    --tone filmic

[[ -n $data ]] || exit 0
head=(--direction 0.7,1,0.2 --up 0,0,-1 "${dark[@]}")
scan=$data/ct_head/cthead_256x256x225_uint8.raw.gz
draw head-skin "$scan" --isovalue 45 --surface-color 0.75,0.5,0.38 "${head[@]}" \
    --light view:1,-0.7,-1:1,0.95,0.9:0.8 --light head:0.35
draw head-skull "$scan" --isovalue 92 --surface-color 0.75,0.7,0.6 "${head[@]}" \
    --light view:1,-0.7,-1:1,0.95,0.9:0.8 --light head:0.35
draw head-opened "$scan" --isovalue 92 --surface-color 0.75,0.7,0.6 "${head[@]}" \
    --clip 127,127,112,1,0,0
draw chest "$data/dicom_chest_ct" --view front --azimuth 20 "${dark[@]}" --axes --scale-bar
draw chest-radiograph "$data/dicom_chest_ct" --drr --sid 1000 --sdd 1500 --detector 600x600
draw aneurism "$data/aneurism/aneurism_256x256x256_uint8.raw.gz" --isovalue 90 \
    --surface-color 0.7,0.12,0.1 --view iso "${dark[@]}"
draw lobster "$data/lobster/lobster_301x324x56_uint8.raw.gz" --spacing 1,1,1.4 --tf inferno \
    --range 30,120 --shade --direction 0.3,0.6,-1 --up 0,1,0 "${dark[@]}"
draw level-set "$data/vdb_level_set_sphere/sphere.vdb" "${dark[@]}" --light view:1,-1,-1
