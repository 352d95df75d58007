#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Writes a line "late_call NAME, MODULE" for each function that objects need and a module's library
# has, for late_calls.S.
# Usage: list_late_calls.sh NM OUTPUT MODULE=LIBRARY... -- OBJECT...
set -eu
export LC_ALL=C
nm=$1
output=$2
shift 2
libraries=
while [ "$1" != -- ]; do
    libraries="$libraries $1"
    shift
done
shift

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$nm" --format=posix "$@" >"$scratch/objects"
# Lines are "NAME TYPE ...". What one object needs another may have.
awk '$2 == "U" { print $1 }' "$scratch/objects" | sort -u >"$scratch/needed"
awk 'NF > 1 && $2 != "U" { print $1 }' "$scratch/objects" | sort -u >"$scratch/present"
comm -23 "$scratch/needed" "$scratch/present" >"$scratch/missing"
for library in $libraries; do
    "$nm" --format=posix --dynamic --defined-only "${library#*=}" >"$scratch/library"
    awk '$2 == "T" || $2 == "W" { print $1 }' "$scratch/library" | sort -u |
        comm -12 - "$scratch/missing" | sed "s/.*/late_call &, ${library%%=*}/"
done >"$output"
