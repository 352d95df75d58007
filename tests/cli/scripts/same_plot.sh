#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks that a plot has the same bytes on any number of threads, and others for another volume.
# Usage: same_plot.sh PROGRAM SCRATCH EXTENSION
set -euo pipefail
program=$1 scratch=$2 extension=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
"$program" synth cloud volume.vdb --dims 40x30x20 -q
for threads in 1 2; do
    "$program" info volume.vdb --plot "$threads.$extension" --threads "$threads" -q >/dev/null
done
cmp "1.$extension" "2.$extension"
"$program" synth cloud volume.vdb --dims 40x30x20 --seed 2 -q
"$program" info volume.vdb --plot "other.$extension" -q >/dev/null
! cmp -s "1.$extension" "other.$extension"
