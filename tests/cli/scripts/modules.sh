#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Modules and the helper are found from where the program is, by whatever link it is called; without
# them what does not need them is done, and the rest says what is missing.
# Usage: modules.sh PROGRAM OIIOTOOL SCRATCH FRUSTUM.vdb
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"
frustum=$4
mkdir -p installed/{bin,lib,libexec/deltasplat} lonely/bin lonely/lib/deltasplat links
cp "$program" installed/bin/deltasplat
cp "$program" lonely/bin/deltasplat
cp -r "${program%/*}/../lib/deltasplat" installed/lib/
cp installed/lib/deltasplat/{openvdb,blosc}.so lonely/lib/deltasplat/
cp "${program%/*}"/{deltasplat-helper,helper_*.so} installed/libexec/deltasplat/
ln -s ../installed/bin/deltasplat links/volumes
program=$PWD/installed/bin/deltasplat

"$program" synth engine in.vdb --dims 24x24x24 -qq
"$program" convert in.vdb in.npy -qq
links/volumes render in.vdb -o link.jpg --size 32x32 -qq --background 0,0,0
(cd / && "$program" render "$scratch/in.vdb" -o "$scratch/away.jpg" --size 32x32 -qq --background 0,0,0)
expect_same link.jpg away.jpg

# Only what is asked for is loaded.
loaded() { LD_DEBUG=files "$@" 2>&1 >/dev/null | grep -o 'lib\(OpenImageIO\|gdcmMSFF\)' | sort -u; }
for command in --version "info in.vdb" "convert in.vdb out.nrrd" "render in.vdb -o out.png --size 32x32" "render in.vdb -o out.exr --size 32x32 --deep"; do
    # shellcheck disable=SC2086
    [[ -z $(loaded "$program" $command) ]] || fail "$command: loads $(loaded "$program" $command)"
done
lonely/bin/deltasplat info in.vdb >/dev/null || fail "info needs a module"
expect_code 1 lonely/bin/deltasplat render in.vdb -o none.jpg --size 32x32 -q --background 0,0,0
grep -q "^deltasplat: module images: got .*; expected $PWD/lonely/lib/deltasplat/images.so, installed with" \
    stderr.txt || { cat stderr.txt; fail "expected to be told what is missing"; }
# OpenVDB's own functions are called from deep within; what fails then is said all the same.
rm lonely/lib/deltasplat/openvdb.so
cp "$frustum" frustum.vdb
for command in "info frustum.vdb" "convert frustum.vdb none.vdb" "render frustum.vdb -o none.png"; do
    # shellcheck disable=SC2086
    expect_code 1 lonely/bin/deltasplat $command
    grep -q "^deltasplat: module openvdb: got .*; expected $PWD/lonely/lib/deltasplat/openvdb.so, installed with" \
        stderr.txt || { cat stderr.txt; fail "expected to be told what is missing"; }
done
expect_files "" 'none*'

# The helper is in ../libexec/deltasplat, beside the program, or where DELTASPLAT_HELPER says.
printf 'LUT_1D_SIZE 2\n1 1 1\n0 0 0\n' >inverse.cube
look=(render "$PWD/in.vdb" --size 32x32 -qq --background 0,0,0 --look "$PWD/inverse.cube" -o)
helper=$PWD/installed/libexec/deltasplat/deltasplat-helper
(cd / && "$scratch/links/volumes" "${look[@]}" "$scratch/linked.png")
cp installed/lib/deltasplat/{images,openvdb}.so lonely/lib/deltasplat/
expect_code 1 lonely/bin/deltasplat "${look[@]}" none.png
grep -q "^deltasplat: deltasplat-helper: got none; expected $PWD/lonely/bin/deltasplat-helper or $PWD/lonely/libexec/deltasplat/deltasplat-helper, installed with" \
    stderr.txt || { cat stderr.txt; fail "expected to be told where the helper is looked for"; }
expect_files "" 'none*'
DELTASPLAT_HELPER=$helper lonely/bin/deltasplat "${look[@]}" named.png
expect_same linked.png named.png
cp "${helper%/*}"/* lonely/bin/
lonely/bin/deltasplat "${look[@]}" beside.png
expect_same linked.png beside.png
# Nobody may put theirs beside another's program; another version is none.
if [[ $(id -u) -eq 0 ]] && chown 12345 lonely/bin/deltasplat-helper 2>/dev/null; then
    expect_code 1 lonely/bin/deltasplat "${look[@]}" none.png
    grep -q "deltasplat-helper: got none" stderr.txt || fail "expected another's helper to be passed over"
    chown 0 lonely/bin/deltasplat-helper
fi
sed 's/\x000\.1\.0\x00/\x000.9.0\x00/' "$helper" >lonely/bin/deltasplat-helper
if ! cmp -s "$helper" lonely/bin/deltasplat-helper; then
    expect_code 1 lonely/bin/deltasplat "${look[@]}" none.png
    grep -q "^deltasplat: deltasplat-helper: got version 0.9.0; expected 0.1.0, as the library" stderr.txt ||
        { cat stderr.txt; fail "expected to be told of the other version"; }
fi
expect_files "" 'none*'

# Nor is a module of another version taken.
cp installed/lib/deltasplat/{openvdb,blosc}.so lonely/lib/deltasplat/
sed 's/deltasplat module 0/deltasplat module 9/' installed/lib/deltasplat/images.so >lonely/lib/deltasplat/images.so
expect_code 1 lonely/bin/deltasplat render in.vdb -o none.jpg --size 32x32 -q --background 0,0,0
grep -q "^deltasplat: module images: got .*/images.so of \"deltasplat module 9.*; expected \"deltasplat module 0" \
    stderr.txt || { cat stderr.txt; fail "expected to be told of the other version"; }
expect_files "" 'none*'

# Nor one under the name of another, be it one of functions or of a library.
cp installed/lib/deltasplat/blosc.so lonely/lib/deltasplat/images.so
cp installed/lib/deltasplat/blosc.so lonely/lib/deltasplat/openvdb.so
expect_other() { # MODULE OTHER COMMAND
    expect_code 1 lonely/bin/deltasplat "${@:3}"
    grep -q "^deltasplat: module $1: got .*/$1.so of \"deltasplat module [0-9.]* $2\"; expected \"deltasplat module [0-9.]* $1\", installed with" \
        stderr.txt || { cat stderr.txt; fail "$1: expected to be told that it is $2"; }
}
expect_other images blosc render in.vdb -o none.jpg --size 32x32 -q --background 0,0,0
expect_other openvdb blosc info frustum.vdb
expect_files "" 'none*'
