#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Compares delta grids with plain .vdb files: makes both of every volume below FOLDER (of a .vdb all
# scalar grids) and prints their bytes, the ratio, and whether the delta grids are lossless; at the
# end the share of files that are smaller, the median ratio and the largest. Needs the program:
# build/release/bin/deltasplat, or the one on the path.
# Usage: bash scripts/measure_delta_sizes.sh FOLDER [OPTION...]   (further options of `delta`)
set -euo pipefail
[[ $# -ge 1 ]] ||
    { echo "Usage: bash scripts/measure_delta_sizes.sh FOLDER [OPTION...]" >&2; exit 2; }
folder=$1
shift
program=$(dirname "${BASH_SOURCE[0]}")/../build/release/bin/deltasplat
[[ -x $program ]] || program=$(command -v deltasplat)
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT

# Files of one volume each; of DICOM slices their folders. Halves of pairs are read with the other.
list_inputs() {
    find "$folder" -name '*.dcm' -printf '%h\n' | sort -u
    find "$folder" \( -name '*.vdb' -o -name '*.raw.gz' -o -name '*.raw' -o -name '*.nrrd' -o \
        -name '*.mhd' -o -name '*.mha' -o -name '*.nii' -o -name '*.nii.gz' -o -name '*.npy' \) |
        sort | while read -r file; do
            [[ $file == *.raw && -e ${file%.raw}.mhd ]] || echo "$file"
        done
}

list_inputs | while read -r input; do
    "$program" -qq convert "$input" "$made/plain.vdb"
    # What is no volume at all, such as a file of vectors alone, is left out.
    "$program" -qq delta "$input" "$made/delta.vdb" --stats "$made/stats.json" "$@" || continue
    error=$(grep -o '"max_error": *[^,]*' "$made/stats.json" | grep -o "[^: ]*$")
    echo "${input#"$folder"/} $(stat -c %s "$made/plain.vdb") $(stat -c %s "$made/delta.vdb")" \
        "$error"
done | awk '
    { printf "%-60s %9d %9d  %.3f  error %s\n", $1, $2, $3, $3 / $2, $4
      ratio[NR] = $3 / $2; smaller += $3 < $2 }
    END {
        if (NR == 0) exit 1
        for (i = 2; i <= NR; ++i)
            for (k = i; k > 1 && ratio[k] < ratio[k - 1]; --k) {
                t = ratio[k]; ratio[k] = ratio[k - 1]; ratio[k - 1] = t
            }
        median = NR % 2 ? ratio[(NR + 1) / 2] : (ratio[NR / 2] + ratio[NR / 2 + 1]) / 2
        printf "%d files: %d smaller (%.0f %%), median %.3f, largest %.3f\n", NR, smaller,
            100 * smaller / NR, median, ratio[NR]
    }'
