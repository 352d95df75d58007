#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Lets writing fail half way, as on a full disk, and checks that nothing is left.
# Usage: full_disk.sh PROGRAM SCRATCH FILE COMMAND...   (FILE: what the command is to write)
set -uo pipefail
program=$1 scratch=$2 file=$3
shift 3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch" || exit 1
"$program" synth cloud input_32x32x32_uint8.raw --dims 32x32x32 -q || exit 1

(
    ulimit -f 8
    exec "$program" "$@" -q 2>&1
) | tee message
code=${PIPESTATUS[0]}
[[ $code == 4 ]] || { echo "exit code: got $code; expected 4"; exit 1; }
[[ $(wc -l <message) == 1 && $(cat message) == "deltasplat: $file: "* ]] ||
    { echo "standard error: expected one line about $file"; exit 1; }
left=$(ls -A | grep -vx -e message -e input_32x32x32_uint8.raw)
[[ -z $left ]] || { echo "left behind: $left"; exit 1; }
