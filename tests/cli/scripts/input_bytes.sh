#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks that input_bytes of --stats are those of every file of the input, as it was before writing.
# Usage: input_bytes.sh PROGRAM SCRATCH FIXTURES DATA DICOM
#   FIXTURES  folder with ball.vdb, detached.nhdr and detached.raw
#   DATA      folder with stack.1.pgm and stack.2.pgm
#   DICOM     ON if the program reads DICOM
set -euo pipefail
program=$1 scratch=$2 fixtures=$3 data=$4 itk=$5
rm -rf "$scratch"
mkdir -p "$scratch/stack"
cd "$scratch"
cp "$fixtures"/{ball.vdb,detached.nhdr,detached.raw} "$data"/stack.[12].pgm .
cp stack.[12].pgm stack

expect() { # bytes subcommand input output
    "$program" "${@:2}" --stats stats.json -q
    grep -q "\"input_bytes\": $1,\$" stats.json ||
        { echo "${*:2}: $(grep input_bytes stats.json); expected $1"; exit 1; }
}
bytes_of() { cat "$@" | wc -c; }

expect "$(bytes_of stack.[12].pgm)" delta stack.\#.pgm stack.vdb
expect "$(bytes_of stack.[12].pgm)" convert stack folder.vdb
[[ $itk != ON ]] || expect "$(bytes_of detached.nhdr detached.raw)" convert detached.nhdr out.vdb
# In place: delta, then restore.
expect "$(bytes_of ball.vdb)" delta ball.vdb ball.vdb
expect "$(bytes_of ball.vdb)" restore ball.vdb ball.vdb
