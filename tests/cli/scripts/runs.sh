# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# What scripts ask of runs of the program: exit codes, what is said on standard error, files that
# are left. `fail` is theirs.
# Usage: source runs.sh

expect_code() { # CODE COMMAND...
    local code=0
    "${@:2}" 2>stderr.txt || code=$?
    [[ $code == "$1" ]] || { cat stderr.txt; fail "got exit code $code from ${*:2}; expected $1"; }
}
expect_files() { # NAMES PATTERN
    local got
    got=$(compgen -G "$2" | sort | tr '\n' ' ' | sed 's/ $//' || true)
    [[ $got == "$1" ]] || fail "got files $got; expected $1"
}
expect_said() { grep -qxF -- "$1" stderr.txt || { cat stderr.txt; fail "expected to be told: $1"; }; }
