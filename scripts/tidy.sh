#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs clang-tidy over the library and the program. Needs a configured build/release.
# What was found clean is not looked at again before its text, that of a header it includes, or the
# checks change: what the preprocessor makes of it is noted in ${XDG_CACHE_HOME:-~/.cache}/deltasplat.
# Usage: bash scripts/tidy.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cache=${XDG_CACHE_HOME:-$HOME/.cache}/deltasplat/tidy
mkdir -p "$cache"
find "$cache" -type f -mtime +30 -delete

# Of a file, a hash of all that clang-tidy has to say depends on; comments may silence a check.
# Nothing of a file that is not compiled here: clang-tidy then guesses how it would be.
key_of() {
    local command
    command=$(grep -B 1 -F "\"file\": \"$PWD/$1\"" build/release/compile_commands.json |
        sed -n 's/^ *"command": "\(.*\)",$/\1/p' | sed 's/\\\(["\\]\)/\1/g; s/ -o [^ ]* -c / -E -P -C /')
    [[ -n $command ]] || return 0
    { echo "${command//$PWD/}"; clang-tidy --version; cat .clang-tidy; eval "$command"; } |
        sha256sum | cut -d ' ' -f 1
}

look_at() {
    local key
    key=$(key_of "$1")
    [[ -n $key && -e $cache/$key ]] && return 0
    clang-tidy --quiet -p build/release --extra-arg=-Wno-unknown-warning-option "$1" 2>&1 |
        sed '/^[0-9]* warnings generated\.$/d'
    [[ -z $key ]] || touch "$cache/$key"
}

export -f key_of look_at
export cache SHELLOPTS
git ls-files 'src/*.cpp' 'tools/*.cpp' | xargs -I{} --max-procs=2 bash -c 'look_at {}'
