# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# What scripts that look at pictures begin with: an empty folder to work in, and what is asked of
# pictures. What fails is said, and all of it makes the script fail in the end.
# Usage: source pictures.sh; begin PROGRAM OIIOTOOL SCRATCH
set -euo pipefail
failed=0
fail() { echo "$*"; failed=1; }
trap 'code=$?; exit $((code ? code : failed))' EXIT

begin() {
    program=$1 oiiotool=$2 scratch=$3
    rm -rf "$scratch"
    mkdir -p "$scratch"
    cd "$scratch"
}

file_of() { [[ $1 == *.* ]] && echo "$1" || echo "$1.exr"; }
# Pictures, .exr unless they say otherwise, and by how much they may differ.
same() { # A B [MOST]
    "$oiiotool" -q "$(file_of "$1")" "$(file_of "$2")" --fail "${3:-0}" --diff >/dev/null 2>&1
}
expect_same() { same "$@" || fail "$1 and $2: got different pictures"; }
expect_different() { # A B [LEAST]
    ! same "$1" "$2" "${3:-1e-4}" || fail "$1 and $2: got one picture; expected two"
}

# The largest values of a picture's channels, and the means.
most() { "$oiiotool" --stats "$(file_of "$1")" 2>&1 | sed -n 's/^ *Stats Max: \([^(]*\).*/\1/p'; }
mean() { "$oiiotool" --stats "$(file_of "$1")" 2>&1 | sed -n 's/^ *Stats Avg: \([^(]*\).*/\1/p'; }
holds() { awk "BEGIN { exit !($1) }"; }

expect_pixel() { # FILE X Y VALUES
    local got
    got=$("$oiiotool" "$1" --cut "1x1+$2+$3" --printstats | sed -n 's/^ *Stats Max: \(.*\) (.*$/\1/p')
    [[ $got == "$4" ]] || fail "$1 at $2,$3: got $got; expected $4"
}
expect_metadata() { # FILE NAME VALUE, which is empty if there must be none
    local got
    got=$("$oiiotool" --info -v "$1" | sed -n "s/^ *deltasplat:$2: \"\(.*\)\"$/\1/p")
    [[ $got == "$3" ]] || fail "$1, $2: got $got; expected $3"
}
