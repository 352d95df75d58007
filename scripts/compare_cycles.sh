#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders smoke in the sun with deltasplat and with Blender's Cycles, of the same .vdb and with the
# same camera, extinction, albedo, phase function and light, and prints how far the pictures are
# apart. Leaves ours.exr, cycles_1.exr and cycles_2.exr (two seeds) in FOLDER, and what Blender says
# in logs. Needs Blender 3.4 (Debian: blender) and the program: build/release/bin/deltasplat, or the
# one on the path.
# Usage: bash scripts/compare_cycles.sh FILE.vdb FOLDER [OPTION...]   (further options of `render`,
#        such as those of the camera; not those of light and density)
# More by environment, with defaults:
#   GRID=density          read in the file
#   DENSITY_SCALE=0.1     extinction of a world unit where the grid has the value 1
#   LIGHT=-1,-0.7,-0.5    the way that the sun's light travels
#   STRENGTH=4            of the sun, as of --light; Cycles' sun has pi times that
#   ALBEDO=1              one number, or R,G,B
#   ANISOTROPY=0          of one lobe
#   OCTAVES=0             ours: --scatter-octaves
#   BOUNCES=0             Cycles': volume bounces after the first; 0 is single scattering
#   SAMPLES=64            Cycles': of a pixel, for each of two seeds
#   STEP=0.5              Cycles': in voxels
#   OFFSET=0.5            voxels that Blender's values lie off, and are moved back; of 3.4 in Debian
#   SIZE=256x256 THREADS=1
set -euo pipefail
usage="Usage: bash scripts/compare_cycles.sh FILE.vdb FOLDER [OPTION...]"
[[ $# -ge 2 ]] || { echo "$usage" >&2; exit 2; }
command -v blender >/dev/null || { echo "compare_cycles: blender is not installed" >&2; exit 1; }
volume=$1 folder=$2
shift 2
scripts=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
program=$scripts/../build/release/bin/deltasplat
[[ -x $program ]] || program=deltasplat
mkdir -p "$folder"

timed() { # name, command: what it prints goes to FOLDER/NAME.log
    local start=${EPOCHREALTIME/./} name=$1
    shift
    "$@" >"$folder/$name.log" 2>&1 || { cat "$folder/$name.log" >&2; exit 1; }
    printf '%-10s %8d ms\n' "$name" $(((${EPOCHREALTIME/./} - start) / 1000))
}
cycles() { # arguments of compare_cycles.py
    blender -b --factory-startup --python-exit-code 1 -P "$scripts/compare_cycles.py" -- "$@"
}

timed ours "$program" render "$volume" -o "$folder/ours.exr" --float --stats "$folder/ours.json" \
    --grid "${GRID:=density}" --density-scale "${DENSITY_SCALE:=0.1}" --albedo "${ALBEDO:=1}" \
    --lighting scatter --light="${LIGHT:=-1,-0.7,-0.5}:${STRENGTH:=4}" --size "${SIZE:-256x256}" \
    --anisotropy "${ANISOTROPY:=0}" --scatter-octaves "${OCTAVES:-0}" --threads "${THREADS:=1}" "$@"
for seed in 1 2; do
    timed "cycles_$seed" cycles render "$volume" "$folder/ours.json" "$folder/cycles_$seed.exr" \
        --grid "$GRID" --density-scale "$DENSITY_SCALE" --albedo "$ALBEDO" --light="$LIGHT" \
        --strength "$STRENGTH" --anisotropy "$ANISOTROPY" --bounces "${BOUNCES:-0}" \
        --samples "${SAMPLES:-64}" --step "${STEP:-0.5}" --offset "${OFFSET:-0.5}" \
        --threads "$THREADS" --seed "$seed"
done
cycles compare "$folder/ours.exr" "$folder/cycles_1.exr" "$folder/cycles_2.exr" | grep ': '
