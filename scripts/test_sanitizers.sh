#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the unit and property tests with AddressSanitizer and UndefinedBehaviorSanitizer, and runs
# them. With --seconds, no program is built after so many, but for those that read foreign bytes; what
# was covered is then said in the last line.
# Usage: bash scripts/test_sanitizers.sh [--seconds N]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [[ $# -gt 0 && ! ($# -eq 2 && $1 == --seconds && $2 =~ ^[0-9]+$) ]]; then
    echo "test_sanitizers.sh: got $*; expected nothing or --seconds N" >&2
    exit 2
fi
cmake --preset asan </dev/null
cmake --build --preset asan --target foreign_bytes_tests </dev/null
status=0
timeout "$((SECONDS < ${2:-86400} ? ${2:-86400} - SECONDS : 1))" \
    cmake --build --preset asan --target sanitized_tests </dev/null || status=$?
[[ $status -eq 0 || $status -eq 124 ]] || exit "$status"

# Programs that were not built have no label, and so no test.
ctest --preset asan --label-regex '^(unit|property)$' --parallel "$(nproc)" --no-tests=error </dev/null
if [[ $status -eq 124 ]]; then
    all=$(wc -w <build/asan/sanitized_tests.txt) built=0
    for name in $(cat build/asan/sanitized_tests.txt); do
        if [[ -x build/asan/bin/$name ]]; then built=$((built + 1)); fi
    done
    echo "COVERED: sanitizers: $built of $all test programs"
fi
