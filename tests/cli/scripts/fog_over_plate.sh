#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fog without a transfer function brightens what it is put over, however thin it is.
# Usage: fog_over_plate.sh PROGRAM OIIOTOOL SCRATCH
set -euo pipefail
program=$1 oiiotool=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"

"$program" synth cloud cloud.vdb --dims 48x48x48
"$program" render cloud.vdb -o over.exr --float --size 100x100 --background 0.3,0.2,0.1
read -r red green blue alpha < <("$oiiotool" --stats over.exr | sed -n 's/.*Stats Min: *\([0-9.e -]*\) (float)/\1/p')
awk -v r="$red" -v g="$green" -v b="$blue" -v a="$alpha" \
    'BEGIN { exit !(r > 0.2999 && g > 0.1999 && b > 0.0999 && a > 0.9999) }' ||
    { echo "darkest: $red $green $blue $alpha"; exit 1; }
