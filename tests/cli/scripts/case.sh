#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs one command in a folder of its own and checks everything it leaves behind.
# Usage: case.sh NAME=VALUE... -- COMMAND...
#   scratch=DIR        the folder, emptied first, then filled with links to
#   given=DIR:DIR...   the files of these folders
#   exit=N             exit code expected
#   stderr=TEXT        what standard error has to hold, lines of progress aside
#   stderr_matches=RE  the same as an extended regular expression for the whole
#   stdout_matches=RE  an extended regular expression that some of standard output has to match
#   creates=F:F...     the files that have to be new afterwards, no more and no fewer
set -uo pipefail

exit=0 stderr='' stderr_matches='' stdout_matches='' creates='' given=''
while [[ $1 != -- ]]; do
    printf -v "${1%%=*}" '%s' "${1#*=}"
    shift
done
shift

rm -rf "$scratch"
mkdir -p "$scratch/run"
cd "$scratch/run" || exit 1
IFS=: read -ra folders <<<"$given"
# Links lead out of the folder, which --confine refuses.
for folder in "${folders[@]}"; do
    if [[ " $* " == *" --confine "* ]]; then cp -r "$folder"/* .; else ln -s "$folder"/* .; fi
done
ls -A >../before

"$@" >../stdout 2>../stderr_all </dev/null
got_exit=$?
grep -v '^Progress: [0-9]*%$' ../stderr_all >../stderr
got_stderr=$(cat ../stderr)
ls -A | comm -13 ../before - >../created
got_created=$(paste -sd: ../created)

failures=0
check() { # what got expected
    [[ $2 == "$3" ]] && return
    printf '%s\n       got: %s\n  expected: %s\n' "$1" "$2" "$3"
    failures=1
}
check "exit code" "$got_exit" "$exit"
if [[ -n $stderr_matches ]]; then
    [[ $got_stderr =~ ^($stderr_matches)$ ]] || check "standard error" "$got_stderr" "$stderr_matches"
else
    check "standard error" "$got_stderr" "$stderr"
fi
if [[ -n $stdout_matches ]]; then
    [[ $(cat ../stdout) =~ $stdout_matches ]] ||
        check "standard output" "$(cat ../stdout)" "$stdout_matches"
fi
check "files created" "$got_created" "$creates"
exit $failures
