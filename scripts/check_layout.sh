#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks what needs no build: the layout of C++, shell and Python scripts for errors, that the
# drawing of rooms is that of the includes, and that budgets are kept.
# Usage: bash scripts/check_layout.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

git ls-files -z '*.cpp' '*.h' | xargs -0 clang-format --dry-run --Werror
{
    git ls-files -z '*.sh'
    git grep -zlE '^#!.*(bash|/sh)$' -- ':!*.sh'
} | xargs -0 shellcheck --severity=error --external-sources
git ls-files -z '*.py' | xargs -0 python3 -c '
import sys
for name in sys.argv[1:]:
    compile(open(name, encoding="utf-8").read(), name, "exec")'
python3 scripts/draw_rooms.py --check
bash scripts/check_budgets.sh
