#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Restores delta grids from a file that holds other grids beside them: those are left out with one
# warning, and need not even be sound volumes.
# Usage: restore_other_grids.sh PROGRAM MAKE_FIXTURES SCRATCH FIXTURES
set -euo pipefail
program=$1 make_fixtures=$2 scratch=$3 fixtures=$4
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"

# one_bad.vdb holds density, of which two values are no numbers, velocity and smoke.
"$program" delta "$fixtures/two.vdb" two_delta.vdb -q
"$make_fixtures" mixed.vdb "$fixtures/one_bad.vdb" two_delta.vdb

expect_warnings() { # text
    grep -v '^Progress' stderr >warnings || true
    diff warnings - <<<"$1"
}
left="deltasplat: warning: mixed.vdb: left out density[0] (float), smoke (float), velocity (vec3s), which are no delta grids"
"$program" restore mixed.vdb out.vdb --stats stats.json 2>stderr
expect_warnings "$left"
grep -q '"lossless": false' stats.json
"$program" info out.vdb | grep '^ *grid' >grids
[[ $(grep -c . grids) == 2 ]]
"$program" diff "$fixtures/two.vdb" out.vdb --grid heat -q

"$program" restore mixed.vdb out.nrrd 2>stderr || { cat stderr; exit 1; }
grep -qF "$left" stderr
grep -qF 'mixed.vdb: reading grid "density[1]", the first of 2 delta grids' stderr

status=0
"$program" restore mixed.vdb none.vdb --grid smoke 2>stderr || status=$?
[[ $status == 3 ]]
grep -qF 'mixed.vdb: grid "smoke": got a grid of type float; expected a delta grid' stderr
