#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds everything and runs every test.
# Usage: bash tests/run.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash scripts/install_dependencies.sh
cmake --preset release </dev/null
cmake --build --preset release
ctest --preset release --no-tests=error --parallel "$(nproc)" </dev/null

data=$(sed -n 's/^DELTASPLAT_SHARED_DATA:PATH=//p' build/release/CMakeCache.txt)
if [[ ! -d $data ]]; then
    echo "NOTE: the tests with label 'data' were skipped: there is no folder $(realpath -m "$data")."
    echo "      Name it with: cmake --preset release -DDELTASPLAT_SHARED_DATA=FOLDER"
fi
