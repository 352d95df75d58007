#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A raw file whose name says big endian is written so, by convert and by restore.
# Usage: big_endian.sh PROGRAM SCRATCH FIXTURES
set -euo pipefail
program=$1 scratch=$2 fixtures=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"

# 512 different values, little endian, and the same swapped by another program.
for ((i = 0; i < 512; ++i)); do
    printf "\\x$(printf %02x $((i % 251)))\\x$(printf %02x $((i / 251)))"
done >a_8x8x8_uint16.raw
dd if=a_8x8x8_uint16.raw of=swapped conv=swab status=none

"$program" convert a_8x8x8_uint16.raw b_8x8x8_uint16be.raw
cmp b_8x8x8_uint16be.raw swapped
"$program" convert a_8x8x8_uint16.raw packed_8x8x8_uint16be.raw.gz
gzip -dc packed_8x8x8_uint16be.raw.gz | cmp - swapped
"$program" delta b_8x8x8_uint16be.raw d.vdb
"$program" restore d.vdb r_8x8x8_uint16be.raw
cmp r_8x8x8_uint16be.raw swapped
"$program" restore d.vdb r_8x8x8_uint16.raw
cmp r_8x8x8_uint16.raw a_8x8x8_uint16.raw
