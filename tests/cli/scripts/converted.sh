#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Compares a .vdb, whose box starts anywhere, with the dense file that it is converted to, whose box
# starts at 0: voxels at the same place in the world are the same.
# Usage: converted.sh PROGRAM SCRATCH FIXTURES
set -euo pipefail
program=$1 scratch=$2 fixtures=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
"$program" convert "$fixtures/ball.vdb" ball.nii -q
"$program" diff "$fixtures/ball.vdb" ball.nii --ignore-active -q
"$program" diff ball.nii "$fixtures/ball.vdb" --ignore-active -q
"$program" diff "$fixtures/ball.vdb" ball.nii --ignore-active --json -q >diff.json
grep -q '"transform_equal": true' diff.json
