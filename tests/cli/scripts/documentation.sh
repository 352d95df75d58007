#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs every command line of a document, in order, in a folder of its own: the lines of its ```sh
# blocks that begin with `deltasplat `, `build/release/bin/deltasplat ` or `mkdir -p `, continued
# lines included.
# A document can use files that its earlier lines made, and the repository's examples/.
# Usage: documentation.sh PROGRAM REPOSITORY SCRATCH DOCUMENT
set -euo pipefail
program=$1 repository=$2 scratch=$3 document=$4
rm -rf "$scratch"
mkdir -p "$scratch/build/release/bin"
cd "$scratch"
ln -s "$repository/examples" examples
ln -s "$program" build/release/bin/deltasplat
export PATH="$scratch/build/release/bin:$PATH"

awk '/^ *```/ { inside = !inside && /^ *```sh *$/; next }
     !inside { next }
     { sub(/^ */, ""); line = line $0 }
     /\\$/ { sub(/\\$/, "", line); next }
     line ~ /^(mkdir -p |(build\/release\/bin\/)?deltasplat )/ { print line }
     { line = "" }' "$document" >commands

[[ -s commands ]] || { echo "$document: no command lines found"; exit 1; }
while read -r command; do
    echo "\$ $command"
    bash -c "$command" </dev/null 2>message || { cat message; exit 1; }
done <commands
