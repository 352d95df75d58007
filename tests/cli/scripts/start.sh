#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The program finds what belongs to it from wherever it is called, and loads OpenVDB, which takes
# longer than most of what it is asked for, only where that is needed.
# Usage: start.sh PROGRAM OIIOTOOL SCRATCH FRUSTUM.vdb
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"
frustum=$4
mkdir -p "with space/bin" "with space/lib" links
cp "$program" "with space/bin/deltasplat"
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

# Pictures, and what is said without any volume.
"$program" synth engine engine_24x24x24_uint8.raw --dims 24x24x24 -qq
"$program" convert engine_24x24x24_uint8.raw engine.npy -qq
"$program" convert engine_24x24x24_uint8.raw engine.vdb -qq
"$program" synth cloud cloud.vdb --dims 24x24x24 -qq
"$program" synth explosion colored.vdb --dims 16x16x16 -qq
"$program" delta engine_24x24x24_uint8.raw deltas.vdb -qq
"$program" delta engine_24x24x24_uint8.raw voxels.vdb --no-pack -qq
loads_openvdb() { # whatever the exit code is
    local loaded
    loaded=$(LD_DEBUG=files "$@" 2>&1 >/dev/null) || true
    [[ $loaded == *libopenvdb* ]]
}
for command in --version "render --version" --help "render --help" "render --no-such-option" \
    "render missing.vdb -o x.png" "render engine_24x24x24_uint8.raw -o x.png --size 32x32" \
    "render engine.npy -o x.exr --view iso --size 32x32 --between 1 --projection perspective" \
    "render engine.npy -o x.exr --size 32x32 --mode mip" \
    "render engine.npy -o x.exr --size 32x32 --shade --aov depth" \
    "render engine.vdb -o x.png --size 32x32" "render cloud.vdb -o x.exr --size 32x32 --lighting scatter" \
    "render deltas.vdb -o x.exr --size 32x32" "render voxels.vdb -o x.exr --size 32x32" \
    "info --list cloud.vdb" "info cloud.vdb" "info engine.npy" "info voxels.vdb" "info deltas.vdb" "bench engine.vdb --size 32x32 --repeats 1 --threads 1" \
    "diff engine.npy engine_24x24x24_uint8.raw" "diff engine.vdb engine.npy" "diff cloud.vdb cloud.vdb" \
    "convert engine.npy engine.nii" "convert engine.npy x.vdb" "convert engine.npy x.vdb --background auto" \
    "convert colored.vdb x.vdb --grid Cd.x" "render colored.vdb -o x.png --size 32x32 --grid Cd.y" \
    "convert cloud.vdb x.vdb" "convert cloud.vdb x.npy" "convert cloud.vdb x.vdb --background 0" \
    "delta cloud.vdb x.vdb" "delta engine.npy x.vdb" \
    "delta engine.npy x.vdb --no-pack" "restore deltas.vdb x.vdb" "restore voxels.vdb x.npy" "restore deltas.vdb x.npy" \
    "synth engine x.raw --dims 8x8x8" "synth explosion x.vdb --dims 8x8x8"; do
    # shellcheck disable=SC2086
    ! loads_openvdb "$program" $command || fail "$command: loads OpenVDB"
done
loads_openvdb "$program" info "$frustum" || fail "a frustum: does not load OpenVDB"

versions=$("$program" --version)
[[ $versions == "$("$program" render --version)" && $versions == "$("$program" -q --version)" ]] ||
    fail "--version: got $versions; expected what render says"
for command in --version "render --version"; do
    code=0
    # shellcheck disable=SC2086
    "$program" $command >/dev/full 2>stderr.txt || code=$?
    [[ $code == 4 ]] || fail "$command on a full disk: got exit code $code"
    expect_said "deltasplat: standard output: cannot be written: No space left on device"
done
