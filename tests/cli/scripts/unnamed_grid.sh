#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A grid without a name can be asked for; an option without a value is still refused.
# Usage: unnamed_grid.sh PROGRAM FILE
set -euo pipefail
program=$1 file=$2

[[ $("$program" info "$file" --grid "") =~ range\ +3\ to\ 3 ]] ||
    { echo "got another grid; expected that of threes"; exit 1; }
for arguments in --grid --grid=; do
    code=0
    "$program" info "$file" "$arguments" >/dev/null 2>&1 || code=$?
    [[ $code == 2 ]] || { echo "$arguments: got exit code $code; expected 2"; exit 1; }
done
