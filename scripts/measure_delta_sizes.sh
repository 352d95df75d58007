#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Compares delta grids with plain .vdb files: makes both of every volume below FOLDER (of a .vdb all
# scalar grids) and prints their bytes, the ratio, the one that `info` expects, and the largest
# error; at the end the share of files that are smaller, the median ratio and the largest, and how
# far `info` is off. Needs the program: build/release/bin/deltasplat, or the one on the path.
# Usage: bash scripts/measure_delta_sizes.sh FOLDER [OPTION...]   (further options of `delta`)
set -euo pipefail
[[ $# -ge 1 ]] ||
    { echo "Usage: bash scripts/measure_delta_sizes.sh FOLDER [OPTION...]" >&2; exit 2; }
folder=$1
shift
program=$(dirname "${BASH_SOURCE[0]}")/../build/release/bin/deltasplat
[[ -x $program ]] || program=$(command -v deltasplat)
expected_key=delta_bytes
[[ " $* " != *" --no-pack "* ]] || expected_key=voxel_bytes
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

# What `info` expects of all grids of a file; 0 where it says nothing.
expected_ratio() {
    { "$program" -qq info "$1" --json || true; } | awk -F '[:,]' -v key="\"$expected_key\"" '
        /"plain_bytes"/ { plain += $2 } $0 ~ key { delta += $2 }
        END { print (plain > 0 ? delta / plain : 0) }'
}

list_inputs | while read -r input; do
    "$program" -qq convert "$input" "$made/plain.vdb"
    # What is no volume at all, such as a file of vectors alone, is left out.
    "$program" -qq delta "$input" "$made/delta.vdb" --stats "$made/stats.json" "$@" || continue
    error=$(grep -o '"max_error": *[^,]*' "$made/stats.json" | grep -o "[^: ]*$")
    echo "${input#"$folder"/} $(stat -c %s "$made/plain.vdb") $(stat -c %s "$made/delta.vdb")" \
        "$error $(expected_ratio "$input")"
done | awk '
    function sort(values, n,    i, k, t) {
        for (i = 2; i <= n; ++i)
            for (k = i; k > 1 && values[k] < values[k - 1]; --k) {
                t = values[k]; values[k] = values[k - 1]; values[k - 1] = t
            }
    }
    function median(values, n) {
        return n % 2 ? values[(n + 1) / 2] : (values[n / 2] + values[n / 2 + 1]) / 2
    }
    { ratio[NR] = $3 / $2; smaller += $3 < $2
      printf "%-60s %9d %9d  %.3f  expected %.3f  error %s\n", $1, $2, $3, ratio[NR], $5, $4
      if ($5 > 0) off[++known] = $5 > ratio[NR] ? $5 / ratio[NR] - 1 : 1 - $5 / ratio[NR] }
    END {
        if (NR == 0) exit 1
        sort(ratio, NR)
        printf "%d files: %d smaller (%.0f %%), median %.3f, largest %.3f\n", NR, smaller,
            100 * smaller / NR, median(ratio, NR), ratio[NR]
        if (known == 0) exit
        sort(off, known)
        printf "expected of %d: median error %.1f %%, largest %.1f %%\n", known,
            100 * median(off, known), 100 * off[known]
    }'
