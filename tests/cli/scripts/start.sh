#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What is called is a small program, which becomes another one: with the arguments that it was given,
# from wherever it is called, and where there is none it says so. Versions need little of all.
# Usage: start.sh PROGRAM OIIOTOOL SCRATCH
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"
mkdir -p "with space/bin" "with space/lib" bare/bin links
cp "$program" "with space/bin/deltasplat"
cp "$program" bare/bin/deltasplat
cp -r "${program%/*}/../lib/deltasplat" "with space/lib/"
ln -s "../with space/bin/deltasplat" links/volumes
program=$PWD/with\ space/bin/deltasplat

# Called by its path, from its folder, by a link, and by its name alone.
"$program" synth slab "a slab.vdb" --dims 8x8x8 -qq
expected=$("$program" info "a slab.vdb")
[[ $expected == *"6 x 6 x 4"* ]] || fail "info: got $expected"
for call in "cd 'with space/bin'; ./deltasplat" links/volumes "PATH='$PWD/with space/bin':\$PATH; deltasplat"; do
    got=$(bash -c "$call info '$PWD/a slab.vdb'" | sed "s|$PWD/||")
    [[ $got == "$expected" ]] || fail "$call: got $got"
done
# Arguments are passed on as they are, and the name that was called.
expect_code 3 links/volumes info -v "" "it's"
expect_said "  command line: volumes info -v '' 'it'\\''s'"
expect_code 2 "$program"
expect_said "deltasplat: subcommand: got nothing; expected info, convert, delta, restore, diff, render, fold, bench or synth (see 'deltasplat --help')"

# Versions are what the program says that has all libraries, and what is said fails as it does there.
versions=$("$program" --version)
[[ $versions == "$("$program" render --version)" && $versions == "$("$program" -q --version)" ]] ||
    fail "--version: got $versions; expected what render says"
loaded=$(LD_DEBUG=files "$program" --version 2>&1 >/dev/null | grep -o 'libopenvdb' | sort -u || true)
[[ -z $loaded ]] || fail "--version: loads OpenVDB"
for command in --version "render --version"; do
    code=0
    # shellcheck disable=SC2086
    "$program" $command >/dev/full 2>stderr.txt || code=$?
    [[ $code == 4 ]] || fail "$command on a full disk: got exit code $code"
    expect_said "deltasplat: standard output: cannot be written: No space left on device"
done

# Where the programs are missing, or cannot be run, of an exit code that says so.
place=$PWD/bare/bin/../lib/deltasplat
for command in info --help render; do
    expect_code 1 bare/bin/deltasplat "$command"
    expect_said "deltasplat: $place/deltasplat: got No such file or directory; expected a program, installed with this one"
done
expect_code 4 bare/bin/deltasplat -q diff a.vdb b.vdb
expect_said "deltasplat: $place/deltasplat: got No such file or directory; expected a program, installed with this one"
expect_code 1 bare/bin/deltasplat --version
expect_said "deltasplat: $place/version: got No such file or directory; expected a program, installed with this one"
mkdir -p bare/lib/deltasplat
touch bare/lib/deltasplat/deltasplat
expect_code 1 bare/bin/deltasplat info
expect_said "deltasplat: $place/deltasplat: got Permission denied; expected a program, installed with this one"
