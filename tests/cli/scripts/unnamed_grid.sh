#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A grid without a name can be asked for, and has none when it comes back; an option without a value
# is still refused.
# Usage: unnamed_grid.sh PROGRAM FILE SCRATCH
set -euo pipefail
program=$1 file=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"

[[ $("$program" info "$file" --grid "") =~ range\ +3\ to\ 3 ]] ||
    { echo "got another grid; expected that of threes"; exit 1; }
for arguments in --grid --grid=; do
    code=0
    "$program" info "$file" "$arguments" >/dev/null 2>&1 || code=$?
    [[ $code == 2 ]] || { echo "$arguments: got exit code $code; expected 2"; exit 1; }
done

"$program" delta "$file" "$scratch/delta.vdb" -q
"$program" restore "$scratch/delta.vdb" "$scratch/restored.vdb" -q
"$program" convert "$file" "$scratch/converted.vdb" -q
for name in delta restored converted; do
    said=$("$program" diff "$file" "$scratch/$name.vdb")
    [[ $said == *'grid          ""'*PASS ]] || { echo "$name.vdb: got $said"; exit 1; }
done
