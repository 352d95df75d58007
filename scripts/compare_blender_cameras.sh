#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Shows the eight corners of a box with deltasplat and with Blender's Cycles, by cameras that
# scripts/blender/export_camera.py has written: with and without perspective, shifted lenses, pixels
# that are not square, all ways to fit a sensor, and one that moves. Prints how many pixels corners
# are apart, and fails if it is more than half of one. Leaves pictures and cameras in FOLDER. Needs
# Blender 3.4 (Debian: blender) and the program: build/release/bin/deltasplat, or the one on the
# path.
# Usage: bash scripts/compare_blender_cameras.sh FOLDER
set -euo pipefail
[[ $# == 1 ]] || { echo "Usage: bash scripts/compare_blender_cameras.sh FOLDER" >&2; exit 2; }
command -v blender >/dev/null ||
    { echo "compare_blender_cameras: blender is not installed" >&2; exit 1; }
scripts=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
program=$scripts/../build/release/bin/deltasplat
[[ -x $program ]] || program=$(command -v deltasplat)
mkdir -p "$1"
folder=$(realpath "$1")
log=$folder/blender.log
if ! blender -b --factory-startup --python-exit-code 1 -P "$scripts/compare_blender_cameras.py" -- \
    "$program" "$folder" >"$log" 2>&1; then
    grep ': corners\|^largest' "$log" || true
    tail -n 5 "$log" >&2
    exit 1
fi
grep ': corners\|^largest' "$log"
