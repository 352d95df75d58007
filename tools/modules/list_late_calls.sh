#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Writes a line "late_call NAME" for each function that objects need and a shared library has, for
# late_calls.S.
# Usage: list_late_calls.sh NM LIBRARY OUTPUT OBJECT...
set -eu
export LC_ALL=C
nm=$1
library=$2
output=$3
shift 3

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$nm" --format=posix "$@" >"$scratch/objects"
"$nm" --format=posix --dynamic --defined-only "$library" >"$scratch/library"
# Lines are "NAME TYPE ...". What one object needs another may have.
awk '$2 == "U" { print $1 }' "$scratch/objects" | sort -u >"$scratch/needed"
awk 'NF > 1 && $2 != "U" { print $1 }' "$scratch/objects" | sort -u >"$scratch/present"
awk '$2 == "T" || $2 == "W" { print $1 }' "$scratch/library" | sort -u >"$scratch/functions"
comm -23 "$scratch/needed" "$scratch/present" | comm -12 - "$scratch/functions" |
    sed 's/^/late_call /' >"$output"
