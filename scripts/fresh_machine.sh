#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the README's two commands as written on a fresh Debian 12, in a clone of what is committed.
# Data sets in ../shared are there too. Needs root, and the network for packages.
# Usage: bash scripts/fresh_machine.sh [--first-only]
# With --first-only, runs the first of the two commands.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/debian_root.sh"

[[ $# -eq 0 || $* == --first-only ]] || fail "got $*; expected nothing or --first-only"

inside() {
    local commands command
    commands=$(sed -n '/^## Two commands/,/^## /p' README.md | grep -E '^bash ')
    [[ $(wc -l <<<"$commands") -eq 2 ]] || fail "got \"$commands\" in README.md; expected two commands"
    if [[ ${1:-} == --first-only ]]; then commands=$(head -n 1 <<<"$commands"); fi
    make_root
    while read -r command; do
        printf '\n== On a fresh Debian 12: %s\n' "$command"
        in_root "$command"
        echo "== Done after $SECONDS s: $command"
    done <<<"$commands"
}

in_fresh_debian "$@"
