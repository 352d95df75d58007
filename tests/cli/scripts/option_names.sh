#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Looks through all texts of the library, the literals in src/ and include/: none names a flag of
# the program; each name in backquotes is one that the program has a flag for, and is in a header.
# The program's table has no other names, and its help knows the flags.
# Usage: option_names.sh PROGRAM REPOSITORY SCRATCH
set -euo pipefail
program=$1 repository=$2 scratch=$3
mkdir -p "$scratch"
cd "$repository"
failed=0
fail() { echo "$*"; failed=1; }

# One literal a line, behind file and line; of what is left after escapes and comments, every second
# piece between quotes.
find src include -name '*.h' -o -name '*.cpp' | sort | xargs awk -F'"' '
    { gsub(/\\./, ""); gsub(/\047"\047/, ""); $0 = $0 }
    { for (i = 1; i <= NF; ++i) {
          if (i % 2) { if ($i ~ /\/\//) next }
          else print FILENAME ":" FNR ": " $i
      } }' >"$scratch/literals"
[[ $(wc -l <"$scratch/literals") -gt 1000 ]] || fail "literals: too few are found"

flags=$(grep -E -- '(^|[^-!])--([a-z]|$)' "$scratch/literals" || true)
[[ -z $flags ]] || fail "flags of the program in the library; expected fields in backquotes:
$flags"

grep -o '`[^`]*`' "$scratch/literals" | tr -d '`' | sort -u >"$scratch/fields"
grep -o '{"[^"]*", "[^"]*"}' tools/flag_names.cpp | sed 's/{"//; s/", "/\t/; s/"}//' \
    >"$scratch/table"
cut -f1 "$scratch/table" | sort -u >"$scratch/known"
differing=$(diff "$scratch/fields" "$scratch/known" || true)
[[ -z $differing ]] || fail "names in the library's texts (<) and in tools/flag_names.cpp (>):
$differing"

# `tolerance.value` is a field called value, `bigEndian=true` a value of bigEndian.
while read -r name; do
    field=${name##*.}
    grep -rqw --include='*.h' -- "${field%%=*}" include src || fail "$name: no header knows it"
done <"$scratch/fields"

for subcommand in info convert delta restore diff render fold bench synth; do
    "$program" "$subcommand" --help
done >"$scratch/help"
while IFS=$'\t' read -r name flag; do
    grep -qE -- "(^|[ ,])${flag%% *}([ ,]|$)" "$scratch/help" ||
        fail "$name: no help knows $flag"
done <"$scratch/table"
exit $failed
