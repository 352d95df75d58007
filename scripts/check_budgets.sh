#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Shows that the tree stays within scripts/budgets.txt.
# Usage: bash scripts/check_budgets.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

lines_of() { git ls-files -z "$1/*.cpp" "$1/*.h" | xargs -0 cat | wc -l; }

status=0
while read -r most what; do
    case $what in
        "lines of "*) got=$(lines_of "${what#lines of }") ;;
        "files of "*) got=$(git ls-files "${what#files of }" | wc -l) ;;
        "words of "*) got=$(wc -w <"${what#words of }") ;;
        "test programs") got=$(git ls-files 'tests/*.cmake' | xargs grep -ho 'deltasplat_tests(' | wc -l) ;;
        *) echo "budgets.txt: got \"$what\"; expected lines, files, words or test programs" >&2; exit 2 ;;
    esac
    if ((got > most)); then
        echo "budgets.txt: got $got $what; expected at most $most" >&2
        status=1
    fi
done < <(sed 's/ *#.*//; /^$/d' scripts/budgets.txt)
exit $status
