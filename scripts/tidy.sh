#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs clang-tidy over the library and the program. Needs a configured build/release.
# Usage: bash scripts/tidy.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

git ls-files 'src/*.cpp' 'tools/*.cpp' |
    xargs --max-args=1 --max-procs=2 clang-tidy --quiet -p build/release \
        --extra-arg=-Wno-unknown-warning-option
