#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs clang-tidy over the library and the program. Needs a configured build/release.
# What was found clean is not looked at again before its text, that of a header it includes, or the
# checks change: a hash of all that is noted in ${XDG_CACHE_HOME:-~/.cache}/deltasplat.
# What was changed last is looked at first. With --seconds, no other file is begun after so many; what
# was covered is then said in the last line.
# Usage: bash scripts/tidy.sh [--seconds N]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    echo "tidy.sh: got $*; expected nothing or --seconds N" >&2
    exit 2
}
end=
if [[ $# -gt 0 ]]; then
    [[ $# -eq 2 && $1 == --seconds && $2 =~ ^[0-9]+$ ]] || usage "$*"
    end=$(($(date +%s) + $2))
fi

cache=${XDG_CACHE_HOME:-$HOME/.cache}/deltasplat/tidy
mkdir -p "$cache"
find "$cache" -type f -mtime +30 -delete

# Of a file, a hash of all that clang-tidy has to say depends on: its text and that of the project's
# headers, for macros and what only clang compiles, and of other headers what the preprocessor makes
# of them. Nothing of a file that is not compiled here: clang-tidy then guesses how it would be. A
# file that tests compile as well is taken as the program does, or whoever comes first.
key_of() {
    local command texts
    command=$(grep -B 1 -F "\"file\": \"$PWD/$1\"" build/release/compile_commands.json |
        sed -n 's/^ *"command": "\(.*\)",$/\1/p' |
        sed -n '1{s/\\\(["\\]\)/\1/g; s/ -o [^ ]* -c / -E -P /; p}')
    [[ -n $command ]] || return 0
    texts=$(eval "${command/ -E -P / -MM }" | sed 's/^[^ ]*: / /; s/\\$//')
    {
        echo "${command//$PWD/}"
        clang-tidy --version
        # shellcheck disable=SC2086
        cat .clang-tidy scripts/tidy.sh $texts
        eval "$command"
    } | sha256sum | cut -d ' ' -f 1
}

look_at() {
    local key
    if [[ -n $end && $(date +%s) -ge $end ]]; then
        echo "$1" >>"$left"
        return 0
    fi
    key=$(key_of "$1")
    [[ -n $key && -e $cache/$key ]] && return 0
    clang-tidy --quiet -p build/release --extra-arg=-Wno-unknown-warning-option "$1" 2>&1 |
        sed '/^[0-9]* warnings generated\.$/d'
    [[ -z $key ]] || touch "$cache/$key"
}

# Files in the order in which they were last committed, those without a history last.
newest_first() {
    {
        git log --format= --name-only
        git ls-files
    } | awk '!seen[$0]++' | grep -xFf <(git ls-files 'src/*.cpp' 'tools/*.cpp')
}

left=$(mktemp)
trap 'rm -f "$left"' EXIT
export -f key_of look_at
export cache end left SHELLOPTS
newest_first | xargs -I{} --max-procs="$(nproc)" bash -c 'look_at {}'
if [[ -s $left ]]; then
    all=$(newest_first | wc -l)
    echo "First of those not looked at: $(head -n 1 "$left")"
    echo "COVERED: clang-tidy: $((all - $(wc -l <"$left"))) of $all files, those changed last first"
fi
