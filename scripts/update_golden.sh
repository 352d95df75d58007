#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Writes tests/golden/hashes.txt anew, after a change that is meant to change pixels, and says which
# pictures changed. Needs a configured build/release.
# Usage: bash scripts/update_golden.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cmake --build --preset release --target golden_tests
DELTASPLAT_GOLDEN_UPDATE=1 build/release/bin/golden_tests \
    --gtest_filter='*WritesTheListWhenAsked' --gtest_brief=1
git --no-pager diff --stat -- tests/golden/hashes.txt
git --no-pager diff --unified=0 -- tests/golden/hashes.txt | sed -n 's/^+[0-9a-f]* /changed: /p'
