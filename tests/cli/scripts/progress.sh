#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Who sees what on standard error: progress on a pipe only if asked for, warnings unless told off twice.
# Usage: progress.sh PROGRAM SCRATCH FIXTURES
set -euo pipefail
program=$1 scratch=$2 fixtures=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"

progress='Progress: 100%'
warning='deltasplat: warning: '
said() { # options...
    "$program" render "$fixtures/two.vdb" -o out.exr --size 8x8 "$@" 2>&1 | cat >said
}
expect() { # progress|- warning|- options...
    local wanted=$1$2 got=''
    shift 2
    said "$@"
    if grep -qxF "$progress" said; then got+=progress; else got+=-; fi
    if grep -qF "$warning" said; then got+=warning; else got+=-; fi
    [[ $got == "$wanted" ]] && return
    echo "render $*: got $got; expected $wanted"
    cat said
    exit 1
}
expect - warning
expect progress warning -v
expect progress warning --progress
expect - warning -q
expect - warning -q -v
expect - warning -q --progress
expect - - -qq
expect - - -q -q
expect - - --quiet --quiet --progress

# The program's and the subcommand's flags are the same.
"$program" -q render "$fixtures/two.vdb" -o out.exr -q 2>said
[[ ! -s said ]] || { cat said; exit 1; }

# On a terminal there is a bar that is wiped away in the end.
if command -v script >/dev/null; then
    script -qec "'$program' render '$fixtures/two.vdb' -o out.exr --size 8x8" /dev/null >said </dev/null
    grep -q '\[####.* left' said || { echo "no bar"; cat said; exit 1; }
    script -qec "'$program' render '$fixtures/two.vdb' -o out.exr --size 8x8 -q" /dev/null >said </dev/null
    ! grep -q '####' said || { echo "a bar"; exit 1; }
fi
