#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Shows that pictures stay where code moves: renders about 250 pictures with two programs, compares
# their pixels bit for bit, and puts processor times side by side. Samples are made by `synth` and
# `convert` of the old program; real volumes come from ../shared/data where that folder exists.
# Prints each picture that differs with its PSNR and the place of the largest error, each that only
# one program makes, and the largest changes of time. Ends with 1 where any picture differs.
# Usage: bash scripts/compare_trees.sh OLD NEW [FOLDER]
#   OLD, NEW  programs, or build folders with bin/deltasplat
#   FOLDER    keeps pictures and tables (default: a temporary folder)
# THREADS=N: threads of each render (default 2). ONLY=REGEX: pictures whose names fit.
set -euo pipefail
[[ $# -ge 2 && $# -le 3 ]] || { sed -n 's/^# Usage/Usage/p' "$0" >&2; exit 2; }
program() { if [[ -d $1 ]]; then realpath "$1/bin/deltasplat"; else realpath "$1"; fi; }
old=$(program "$1") new=$(program "$2")
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
data=$root/../shared/data
folder=${3:-}
if [[ -z $folder ]]; then
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
fi
mkdir -p "$folder"/{in,old,new}
cd "$folder"
: >times.txt
: >differences.txt
count=0
TIMEFORMAT='%U %S'

# Runs a program, and prints its processor time in seconds.
seconds_of() { # LOG COMMAND...
    local log=$1
    shift
    { time "$@" >"$log" 2>&1 || echo failed >"$log.failed"; } 2>&1 | awk '{print $1 + $2}'
}

# Compares two pictures, and says how they differ.
difference() { # OLD NEW
    cmp -s "$1" "$2" && return
    idiff -fail 0 -warn 0 "$1" "$2" >idiff.txt 2>&1 && return
    awk '/Peak SNR/ {snr = $NF} /Max error/ {sub(/.*Max error *= */, ""); most = $0}
        END {print snr == "" ? "cannot be compared" : "PSNR " snr " dB, most " most}' idiff.txt
}

# Runs both programs with the same arguments; @ stands for old or new.
both() { # NAME FILE ARGUMENTS...
    local name=$1 file=$2 which made=() seconds=()
    shift 2
    [[ -z ${ONLY:-} || $name =~ $ONLY ]] || return 0
    count=$((count + 1))
    for which in old new; do
        rm -f "$which/$name.log.failed" "$which/$file"
        seconds+=("$(seconds_of "$which/$name.log" "${!which}" "${@//@/$which}")")
        [[ -e $which/$name.log.failed ]] || made+=("$which")
    done
    case ${made[*]} in
        "old new")
            echo "$name ${seconds[*]}" >>times.txt
            local found
            found=
            # Parts hold who made them.
            [[ $file == *.slabs ]] || found=$(difference "old/$file" "new/$file")
            [[ -z $found ]] || echo "$name: $found" | tee -a differences.txt ;;
        "") echo "$name: made by neither: $(tail -n 1 "old/$name.log")" | tee -a differences.txt ;;
        *) echo "$name: only made by ${made[*]}: $(tail -qn 1 {old,new}/"$name.log" | head -1)" |
            tee -a differences.txt ;;
    esac
}

picture() { # NAME INPUT ARGUMENTS...
    local name=$1 input=$2
    shift 2
    both "$name" "$name.exr" render "$input" -o "@/$name.exr" --size 384x320 --float \
        --threads "${THREADS:-2}" "$@"
}

# Samples, of each kind of value and of each format.
sample() { # FILE NAME ARGUMENTS...
    local file=in/$1
    shift
    [[ -e $file ]] || "$old" -qq synth "$1" "$file" "${@:2}"
}
converted() { # FROM TO ARGUMENTS...
    [[ -e in/$2 ]] || "$old" -qq convert "in/$1" "in/$2" "${@:3}"
}
sample engine_96x96x64_uint8.raw engine --dims 96x96x64
sample noisy_96x96x64_uint8.raw engine --dims 96x96x64 --noise 0.05
sample vessels_128x128x128_uint8.raw vessels --dims 128x128x128
sample hydrogen_80x80x80_float32.raw hydrogen --dims 80x80x80 --type float32
sample body_64x64x96_uint8.raw body --dims 64x64x96
sample lobb_41x41x41_uint16.raw marschner-lobb --dims 41x41x41 --type uint16
sample cloud.vdb cloud --dims 120x80x100
sample slab.vdb slab --dims 60x70x40 --spacing 1,1,2
sample fire.vdb fire --dims 64x96x64
sample explosion.vdb explosion --dims 80x80x80
[[ -e in/delta.vdb ]] || "$old" -qq delta in/engine_96x96x64_uint8.raw in/delta.vdb
[[ -e in/plain_delta.vdb ]] || "$old" -qq delta in/cloud.vdb in/plain_delta.vdb --no-pack
formats=(npy nrrd nhdr mha mhd nii nii.gz vdb)
for format in "${formats[@]}"; do
    converted engine_96x96x64_uint8.raw "engine.$format"
    converted hydrogen_80x80x80_float32.raw "hydrogen.$format"
done

volumes=(engine_96x96x64_uint8.raw vessels_128x128x128_uint8.raw hydrogen_80x80x80_float32.raw
    cloud.vdb)
views=("front" "iso" "left --azimuth 17 --elevation 23 --roll 8")
eyes=("perspective --view iso" "perspective --fov 70 --view right --elevation 20"
    "latlong --size 384x192")
methods=(auto delta sparse traditional)

for file in "${volumes[@]}"; do
    volume=${file%%[_.]*}
    number=0
    # Words of a view are options of their own.
    # shellcheck disable=SC2086
    for view in "${views[@]}"; do
        number=$((number + 1))
        for method in "${methods[@]}"; do
            picture "$volume.$method.view$number" "in/$file" --method "$method" --view $view
        done
        for mode in xray mip min average; do
            picture "$volume.$mode.view$number" "in/$file" --mode "$mode" --view $view
        done
        for between in 0 1 3; do
            picture "$volume.between$between.view$number" "in/$file" --between "$between" --view $view
        done
    done
    number=0
    # shellcheck disable=SC2086
    for eye in "${eyes[@]}"; do
        number=$((number + 1))
        for method in delta traditional; do
            picture "$volume.$method.eye$number" "in/$file" --method "$method" --projection $eye
        done
        for mode in xray mip; do
            picture "$volume.$mode.eye$number" "in/$file" --mode "$mode" --projection $eye
        done
    done
    for filter in mitchell gauss box; do
        picture "$volume.filter_$filter" "in/$file" --view iso --filter "$filter"
    done
    picture "$volume.small" "in/$file" --view iso --size 40x30
    picture "$volume.joined" "in/$file" --view iso --size 24x24 --join 8
    picture "$volume.large" "in/$file" --view iso --size 700x600
    picture "$volume.near" "in/$file" --view iso --frame-width 12
    picture "$volume.resolution" "in/$file" --view iso --resolution 3
    picture "$volume.sigma" "in/$file" --view iso --sigma 0.8
    picture "$volume.tolerance" "in/$file" --view iso --sigma 0.8 --tolerance 0.1 --method delta
    picture "$volume.shade" "in/$file" --view iso --shade --light view:1,1,1
    picture "$volume.lit" "in/$file" --view iso --lighting scatter --light 1,-1,-0.3
    picture "$volume.lit_eye" "in/$file" --view iso --projection perspective --sky 1,2,1
    picture "$volume.crop" "in/$file" --view iso --crop 10:50,5:40,8:38
    picture "$volume.clip" "in/$file" --view iso --clip 20,20,20,1,1,0
    picture "$volume.by_index" "in/$file" --view iso --color-by index
    picture "$volume.gradient" "in/$file" --view iso --gradient-opacity 0:0,0.1:1
    picture "$volume.region" "in/$file" --view iso --region 60x50+70+40
    picture "$volume.background" "in/$file" --view iso --background 0.2,0.3,0.4
    picture "$volume.aovs" "in/$file" --view iso \
        --aov depth,front,back,position,normal,transmittance,samples
    picture "$volume.ground" "in/$file" --view iso --ground 0,-10,0 --lighting scatter --light 0.2,-1,0.1
    both "$volume.deep" "$volume.deep.exr" render "in/$file" -o "@/$volume.deep.exr" \
        --size 96x80 --deep --view iso
    for type in png tif jpg; do
        both "$volume.$type" "$volume.$type" render "in/$file" -o "@/$volume.$type" --size 96x80
    done
    for part in 1/2 2/2; do
        both "$volume.part${part%/2}" "$volume.part${part%/2}.slabs" render "in/$file" \
            -o "@/$volume.part${part%/2}.slabs" --size 96x80 --view iso --slab-range "$part"
    done
    both "$volume.fold" "$volume.fold.exr" fold "@/$volume.part1.slabs" "@/$volume.part2.slabs" \
        -o "@/$volume.fold.exr"
done

for format in "${formats[@]}"; do
    picture "engine.from_$format" "in/engine.$format" --view iso
    picture "hydrogen.from_$format" "in/hydrogen.$format" --view iso
done
picture delta_grid in/delta.vdb --view iso
picture delta_grid.eye in/delta.vdb --projection perspective
picture delta_grid.plain in/plain_delta.vdb --view iso
picture noisy in/noisy_96x96x64_uint8.raw --view iso
picture noisy.drr in/noisy_96x96x64_uint8.raw --mode drr --view left
picture body.labels in/body_64x64x96_uint8.raw --tf labels --view iso
picture lobb.surface in/lobb_41x41x41_uint16.raw --isovalue 30000 --view iso
picture slab in/slab.vdb --view iso
picture fire in/fire.vdb --emission-grid auto
picture fire.eye in/fire.vdb --emission-grid auto --projection perspective
picture fire.lights in/fire.vdb --emission-grid auto --lighting scatter --emission-lights 8
picture explosion in/explosion.vdb --emission-grid auto --color-grid auto --view iso
picture explosion.lit in/explosion.vdb --color-grid auto --view iso --sky 1,2,1 --anisotropy 0.4
picture explosion.layers in/explosion.vdb --layer density:smoke --layer temperature:fire
picture cloud.octaves in/cloud.vdb --sky 1,2,1 --scatter-octaves 3
picture cloud.point in/cloud.vdb --lighting scatter --light point:60,90,50:9000
for tf in ct-bone mr pet fire viridis coolwarm; do
    picture "engine.tf_$tf" in/engine_96x96x64_uint8.raw --tf "$tf" --view iso
done

if [[ -d $data ]]; then
    real() { # NAME FILE ARGUMENTS...
        picture "$1.real" "$data/$2" --view iso "${@:3}"
        picture "$1.real_eye" "$data/$2" --projection perspective "${@:3}"
    }
    real engine engine/engine_256x256x128_uint8.raw.gz
    real ct_head ct_head/cthead_256x256x113_uint16be.raw.gz --tf mr
    real aneurism aneurism/aneurism_256x256x256_uint8.raw.gz --range 20,60
    real lobster lobster/lobster_301x324x56_uint8.raw.gz
    real tooth tooth/tooth_103x94x161_uint16be.raw.gz
    real smoke vdb_smoke/smoke.vdb
    real sphere vdb_level_set_sphere/sphere.vdb
    real fog vdb_anisotropic_fog/test.vdb
    real plume vdb_plume_seq/fluid_data_0200.vdb
    real heat vdb_density_heat/densityAndHeat.vdb --emission-grid auto
    real brain brain_colin27/ch2.nii.gz
    real letters brain_avg152/avg152T1_RL_nifti.nii.gz
    real arm avf_mr/avf_float_32.nrrd
    real head head_mr_small/HeadMRVolume.mhd
    real chest dicom_chest_ct
fi

echo
echo "Processor time, old and new, where it changed most (of 50 ms and more):"
awk '$2 >= 0.05 || $3 >= 0.05 {printf "%.2f %s %.3f s, %.3f s\n", $3 / ($2 + 1e-9), $1, $2, $3}' times.txt |
    sort -rn | awk '{line[NR] = $0} END {
        for (i = 1; i <= NR; ++i) if (i <= 8 || i > NR - 4) print "  " line[i]}'
awk '{old += $2; new += $3} END {
    printf "All that both make: %.1f s and %.1f s, %.3f\n", old, new, new / (old + 1e-9)}' times.txt
echo "$count pictures, $(wc -l <differences.txt) of them differ."
[[ ! -s differences.txt ]]
