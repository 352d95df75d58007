#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Where nobody reads what is printed any longer, the program ends without a word, as of the signal.
# Usage: closed_pipe.sh PROGRAM SCRATCH
set -uo pipefail
program=$1 scratch=$2
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch" || exit 1
"$program" synth cloud a.vdb --dims 16x16x16 -qq
mkfifo gone
exec 3<>gone 4>gone 3>&-
failed=0
for command in "--help" "--version" "render --help" "info a.vdb" "diff a.vdb a.vdb --json"; do
    # shellcheck disable=SC2086
    "$program" $command >&4 2>stderr.txt
    code=$?
    [[ $code == 141 && ! -s stderr.txt ]] && continue
    echo "$command: got exit code $code and '$(cat stderr.txt)'; expected 141 and nothing"
    failed=1
done
exit $failed
