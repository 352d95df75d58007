#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Frames of a sequence that are converted, stored as deltas, restored, described and compared.
# Usage: converted_sequence.sh PROGRAM OIIOTOOL SCRATCH
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"
for frame in 1 2 3; do
    "$program" synth cloud in.000$frame.vdb --dims 24x24x$((24 + 8 * frame)) --seed $frame -qq
done

# There and back: each frame is what it is by itself, on any number of threads.
"$program" delta in.####.vdb d.####.vdb --frames 1-3 -qq --threads 2 --stats d.##.json
expect_files "d.0001.vdb d.0002.vdb d.0003.vdb" 'd.*.vdb'
expect_files "d.01.json d.02.json d.03.json" 'd.*.json'
grep -q '"lossless": true' d.03.json || fail "d.03.json: got no lossless frame"
"$program" delta in.0002.vdb alone.vdb -qq
cmp <("$program" info d.0002.vdb | tail -n +2) <("$program" info alone.vdb | tail -n +2) ||
    fail "frame 2 is another one by itself"
"$program" delta in.####.vdb v.####.vdb --frames 1-3 --no-pack -qq --threads 2
for frame in 1 2 3; do
    (($(stat -c %s d.000$frame.vdb) < $(stat -c %s v.000$frame.vdb))) ||
        fail "frame $frame: got no more bytes with --no-pack"
    expect_code 0 "$program" diff d.000$frame.vdb v.000$frame.vdb
done
"$program" restore d.####.vdb r.####.vdb --frames 1-3 -qq --threads 1
"$program" convert 'r.$F4.vdb' 'c.@.nrrd' --frames 3-1 -qq
expect_files "c.1.nrrd c.2.nrrd c.3.nrrd" 'c.*'
expect_code 0 "$program" diff in.####.vdb r.####.vdb --frames 1-3
expect_code 0 "$program" diff in.%04d.vdb c.%d.nrrd --frames 1-3 --ignore-active

# What differs is named, in lines and in JSON; one file may be the same for all frames.
cp in.0001.vdb r.0002.vdb
code=0
"$program" diff in.####.vdb r.####.vdb --frames 1-3 >diff.txt || code=$?
[[ $code == 2 ]] || fail "diff: got exit code $code; expected 2"
[[ $(tail -1 diff.txt) == "Frames: 2 PASS, 1 FAILURE (2)" ]] || fail "diff: got $(tail -1 diff.txt)"
"$program" diff in.####.vdb r.####.vdb --frames 1-3 --json >diff.json || true
[[ $(grep -c '"frame": ' diff.json) == 3 ]] || fail "diff.json: got not three frames"
[[ $(grep '"result"' diff.json | head -1) == *FAILURE* ]] || fail "diff.json: got no failure"
code=0
"$program" diff in.0001.vdb r.####.vdb --frames 1-3 >diff.txt || code=$?
[[ $(tail -1 diff.txt) == "Frames: 2 PASS, 1 FAILURE (3)" ]] || fail "diff: got $(tail -1 diff.txt)"

# What all frames have.
"$program" info in.####.vdb --frames 1-3 >info.txt
grep -qx 'All 3 frames' info.txt || fail "info.txt: got nothing of all frames"
grep -q '^  frames  *3, with active voxels in 3$' info.txt || fail "info.txt: got other frames"
# A warning of several frames is shown once, and counted.
mkdir copies
for frame in 1 2 3; do
    printf '\0\0\300\177%.0s' $(seq $frame) >nan.$frame\_8x1x1_float32.raw
    head -c $((32 - 4 * frame)) /dev/zero >>nan.$frame\_8x1x1_float32.raw
done
cp nan.* copies
"$program" info nan.#_8x1x1_float32.raw --frames 1-3 --nan 0 2>said.txt >/dev/null
[[ $(wc -l <said.txt) == 2 ]] && grep -q "frame 1: nan.1_8x1x1_float32.raw: 1 NaN" said.txt &&
    grep -q "2 other frames, in other numbers: 1 NaN" said.txt || fail "info: got $(cat said.txt)"
"$program" diff nan.#_8x1x1_float32.raw copies/nan.#_8x1x1_float32.raw --frames 1-3 --nan 0 2>said.txt >/dev/null
[[ $(wc -l <said.txt) == 4 ]] && grep -q "frame 1: copies/nan.1_8x1x1_float32.raw: 1 NaN" said.txt || fail "diff: got $(cat said.txt)"
rm copies/nan.2_*
"$program" diff nan.#_8x1x1_float32.raw copies/nan.#_8x1x1_float32.raw --frames 1-3 --nan 0 2>said.txt >/dev/null || true
grep -q "^deltasplat: frame 2: copies/nan.2_8x1x1_float32.raw: got no such file" said.txt ||
    fail "diff: got $(cat said.txt)"
grep -q '"filled": 3' <<<"$("$program" info in.####.vdb --frames 1-3 --json)" || fail "info: got other JSON"

# Folders of frames are made.
"$program" convert in.####.vdb made/####/c.vdb --frames 1-2 -qq --stats made/####.json
expect_files "made/0001/c.vdb made/0002/c.vdb" 'made/*/*'
expect_files "made/0001.json made/0002.json" 'made/*.json'

# But none of frames that come to nothing, nor where something is refused.
expect_code 3 "$program" convert in.####.vdb part/####/c.vdb --frames 3-5 --keep-going -qq
expect_files "part/0003" 'part/*'
expect_code 2 "$program" convert in.####.vdb not/####/c.vdb --frames 1-2 -qq --stats one.json
expect_code 3 "$program" convert none.####.vdb not/####/c.vdb --frames 1-2 -qq --missing skip
expect_code 3 "$program" convert in.####.vdb not/####/c.vdb --frames 1-2 -qq --grid nope
expect_files "" 'not'

# Frames without a file, and those that are there already.
expect_code 3 "$program" convert in.####.vdb m.####.vdb --frames 1-5 --keep-going -qq
expect_files "m.0001.vdb m.0002.vdb m.0003.vdb" 'm.*'
expect_said "deltasplat: 2 of 5 frames failed: 4, 5"
expect_code 3 "$program" convert in.####.vdb n.####.vdb --frames 4-7 -qq --threads 1
expect_said "deltasplat: 1 of 4 frames failed: 4; 3 were not tried"
expect_code 4 "$program" diff in.####.vdb r.####.vdb --frames 3-4 -q
expect_code 0 "$program" diff in.####.vdb r.####.vdb --frames 3-4 -q --missing skip
expect_code 4 "$program" diff in.####.vdb none.####.vdb --frames 1-2 -q --missing skip
expect_code 3 "$program" info in.####.vdb --frames 3-4 --list
expect_code 0 "$program" info in.####.vdb --frames 3-4 --list --missing skip
cp m.0002.vdb m.0001.vdb
head -c 100 m.0002.vdb >m.0003.vdb
"$program" convert in.####.vdb m.####.vdb --frames 1-3 --skip-existing -qq
cmp m.0001.vdb m.0002.vdb || fail "m.0001.vdb was made anew"
"$program" info m.0003.vdb >/dev/null || fail "m.0003.vdb was not made anew"

# What cannot be meant.
place="expected a name with ####, %04d, @ or \$F4 for the number"
expect_code 2 "$program" convert in.####.vdb o.vdb --frames 1-3
expect_said "deltasplat: OUTPUT: got o.vdb with --frames; $place, such as o.####.vdb"
expect_code 2 "$program" delta in.0001.vdb o.####.vdb --frames 1-3
expect_said "deltasplat: INPUT: got in.0001.vdb with --frames; $place"
expect_code 2 "$program" restore d.####.vdb o.####.vdb
expect_said "deltasplat: INPUT: got d.####.vdb without --frames; expected --frames with it, as in --frames 1-100"
expect_code 2 "$program" convert in.####.vdb o.####.vdb --frames 1-3 --stats o.json
expect_said "deltasplat: --stats: got o.json with --frames; $place, such as o.####.json"
expect_code 2 "$program" convert in.####.vdb o.####.xyz --frames 1-3
expect_code 4 "$program" diff in.0001.vdb in.0002.vdb --frames 1-3
expect_code 2 "$program" info in.0001.vdb --missing skip
expect_said "deltasplat: --missing: got it without --frames; expected the frames of a sequence"
expect_files "" 'o.*'
