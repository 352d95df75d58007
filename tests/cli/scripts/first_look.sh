#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A CT scan is shown by the preset of one, shaded, unless something else is asked for.
# Usage: first_look.sh PROGRAM OIIOTOOL SCRATCH SCAN
set -euo pipefail
program=$1 oiiotool=$2 scratch=$3 scan=$4
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"

draw() { # picture options
    "$program" render -q -q "$scan" -o "$1.exr" --float --size 64x64 "${@:2}"
}
same() { "$oiiotool" -q "$1.exr" "$2.exr" --fail 0 --diff >/dev/null 2>&1; }
draw first
draw preset --tf ct-soft-tissue --shade
draw plain --no-shade
draw ramp --range=-900,500
draw ramp_plain --range=-900,500 --no-shade
same first preset || { echo "first look: got another picture; expected ct-soft-tissue"; exit 1; }
! same first plain || { echo "--no-shade: got the same picture"; exit 1; }
! same first ramp || { echo "--range: got the same picture; expected a ramp"; exit 1; }
says() { # TEXT OPTIONS...
    grep -qF -- "$1" <<<"$("$program" render "$scan" -o said.png --size 64x64 "${@:2}" 2>&1)" ||
        { echo "${*:2}: expected '$1'"; exit 1; }
}
says "--mode xray: adds up Hounsfield units" --mode xray
says "--tf: labels is for labels; values from" --tf labels
same ramp ramp_plain || { echo "--range: got a shaded ramp"; exit 1; }
