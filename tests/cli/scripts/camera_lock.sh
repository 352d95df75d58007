#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The camera that --stats tells makes the same picture again, of whatever else is rendered with it.
# Usage: camera_lock.sh PROGRAM OIIOTOOL SCRATCH FIXTURES
set -euo pipefail
program=$1 oiiotool=$2 scratch=$3 fixtures=$4
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"

"$program" synth engine engine_40x40x30_uint8.raw --dims 40x40x30
shots=("engine_40x40x30_uint8.raw --view iso --azimuth 12.3 --elevation -7 --roll 3 --spacing 1,1,1.7"
       "$fixtures/tilted.vdb --view left --azimuth 40"
       "$fixtures/patient.vdb --view top")
for shot in "${shots[@]}"; do
    read -ra words <<<"$shot"
    "$program" render "${words[@]}" -o first.exr --float --size 200x150 --stats stats.json
    read -ra camera < <(sed -n 's/.*"options": "\(.*\)".*/\1/p' stats.json)
    kept=("${words[0]}")
    [[ $shot == *--spacing* ]] && kept+=(--spacing 1,1,1.7)
    "$program" render "${kept[@]}" -o second.exr --float "${camera[@]}" --stats again.json
    # Directions are orthonormal to the last bits of doubles, pixels to those of floats.
    "$oiiotool" first.exr second.exr --fail 1e-5 --hardfail 1e-5 --diff >said || { cat said; exit 1; }
    "$oiiotool" --info -v first.exr >info
    grep -qF "deltasplat:camera: \"${camera[*]}\"" info || {
        cat info; exit 1; }
    diff <(grep '"frame_width"' stats.json) <(grep '"frame_width"' again.json)
done
