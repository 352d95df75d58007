#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Delta grids of floats of which there are more than codes: every byte comes back, whatever the
# number of threads, and they render as their sources do; who asks for less is told what is lost.
# Usage: exact_deltas.sh PROGRAM SCRATCH
set -euo pipefail
program=$1
scratch=$2
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
fail() { echo "$1" >&2; exit 1; }

raw=noise_96x80x72_float32.raw
"$program" synth engine "$raw" --dims 96x80x72 --type float32 --noise 0.1 -qq
"$program" synth engine noise.vdb --dims 96x80x72 --noise 0.1 -qq
for source in "$raw" noise.vdb; do
    suffix=${source##*.}
    "$program" delta "$source" one.vdb --threads 1 --stats stats.json >said.txt 2>&1
    "$program" delta "$source" two.vdb --threads 3 -q
    cmp one.vdb two.vdb
    [[ ! -s said.txt ]] || fail "delta $source: said $(cat said.txt); expected nothing"
    grep -q '"code_book": "float32"' stats.json || fail "stats.json: got no code book float32"
    grep -q '"lossless": true' stats.json || fail "stats.json: got no lossless delta grid"
    "$program" restore one.vdb "back_96x80x72_float32.$suffix" --stats stats.json -q
    grep -q '"code_book": "float32"' stats.json || fail "restore: got no code book float32"
    if [[ $suffix == raw ]]; then
        cmp "$source" back_96x80x72_float32.raw
    else
        "$program" diff "$source" back_96x80x72_float32.vdb --fail 0 --warn 0 -q
    fi
    for mode in composite xray mip; do
        "$program" render "$source" -o source.exr --float --mode $mode -q
        "$program" render one.vdb -o delta.exr --float --mode $mode -q
        idiff -fail 0 -failpercent 0 -hardfail 0 -warn 0 source.exr delta.exr >/dev/null ||
            fail "$mode: got another picture of the delta grid of $source"
    done
    "$program" convert "$source" plain.vdb -q
    "$program" restore one.vdb again.vdb -q
    "$program" diff plain.vdb again.vdb --fail 0 --warn 0 -q
    grep -q 'delta grid .* exact' <<<"$("$program" info one.vdb)" || fail "info: got no exact delta grid"

    "$program" delta "$source" voxels.vdb --no-pack -q --threads 1
    "$program" delta "$source" two.vdb --no-pack -q --threads 3
    cmp voxels.vdb two.vdb
    "$program" render "$source" -o source.exr --float -q
    "$program" render voxels.vdb -o delta.exr --float -q
    idiff -fail 0 -failpercent 0 -hardfail 0 -warn 0 source.exr delta.exr >/dev/null ||
        fail "got another picture of the voxels of $source"
    "$program" restore voxels.vdb again.vdb -q
    "$program" diff plain.vdb again.vdb --fail 0 --warn 0 -q
    (($(stat -c %s one.vdb) < $(stat -c %s voxels.vdb))) || fail "delta --no-pack: got no more bytes"

    # Less is smaller, and says so.
    for less in --codes "--bits 12" "--codes --no-pack"; do
        # shellcheck disable=SC2086
        "$program" delta "$source" less.vdb $less --stats stats.json >said.txt
        grep -q '^largest error ' said.txt || fail "delta $less: said no largest error"
        grep -q '"lossless": false' stats.json || fail "delta $less: got a lossless delta grid"
        exact=one.vdb
        [[ $less != *--no-pack ]] || exact=voxels.vdb
        (($(stat -c %s less.vdb) < $(stat -c %s $exact))) || fail "delta $less: got no less bytes"
        # shellcheck disable=SC2086
        if "$program" delta "$source" none.vdb $less --max-error 0 -q 2>said.txt; then
            fail "delta $less --max-error 0: got exit code 0; expected 1"
        fi
        grep -q 'got a largest error of' said.txt || fail "delta $less: got $(cat said.txt)"
        [[ ! -e none.vdb ]] || fail "delta $less --max-error 0: wrote a file"
    done
done

# A table of nearly as many values as voxels is larger than their own bits.
few=noise_32x32x32_float32.raw
"$program" synth engine "$few" --dims 32x32x32 --type float32 --noise 0.1 -qq
"$program" delta "$few" few.vdb --stats stats.json -q
grep -q '"code_book": "float32"' stats.json || fail "$few: got no code book float32"
"$program" restore few.vdb back_32x32x32_float32.raw -q
cmp "$few" back_32x32x32_float32.raw
"$program" delta "$few" table.vdb --codes --stats stats.json -q
grep -q '"code_book": "table"' stats.json || fail "$few --codes: got no table"
grep -q '"lossless": true' stats.json || fail "$few --codes: got no lossless delta grid"
(($(stat -c %s few.vdb) < $(stat -c %s table.vdb))) || fail "$few: got no less bytes than a table"

# What it takes is known before it is taken.
peak() { "$program" delta "$@" peak.vdb --threads 1 --stats stats.json -q && number peak_bytes <stats.json; }
number() { grep -o "\"$1\": *[0-9]*" | grep -o '[0-9]*$'; }
"$program" synth engine small_8x8x8_uint8.raw --dims 8x8x8 -qq
program_bytes=$(peak small_8x8x8_uint8.raw)
"$program" synth engine noise_256x128x128_float32.raw --dims 256x128x128 --type float32 --noise 0.1 -qq
# The same bits are doubles, or whole numbers.
for large in noise_256x128x128_float32.raw noise_128x128x128_float64.raw noise_256x128x128_uint32.raw; do
    [[ -e $large ]] || cp noise_256x128x128_float32.raw "$large"
    for form in --pack --no-pack; do
        taken=$(($(peak "$large" $form) - program_bytes))
        "$program" delta "$large" none.vdb $form --max-memory $((program_bytes + (16 << 20))) 2>said.txt &&
            fail "$large $form: got within 16 MiB"
        needed=$(sed -n 's/.*needs \([0-9]*\)[.0-9]* MiB.*/\1/p' said.txt)
        # A tenth is for what allocators do not give back.
        ((taken <= (needed + needed / 10 + 1) << 20)) ||
            fail "$large $form: took $((taken >> 20)) MiB; expected about $needed, as was said before"
    done
done
echo "Exact: raw volumes and a grid"
