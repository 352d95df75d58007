#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the tests of threads that share scenes and memory under ThreadSanitizer.
# Usage: bash scripts/test_races.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cmake --preset tsan </dev/null
cmake --build --preset tsan --target base_tests picture_tests
ctest --preset tsan --tests-regex '(Prepared|SlabPicture|KeptMemory)\.' --no-tests=error </dev/null
