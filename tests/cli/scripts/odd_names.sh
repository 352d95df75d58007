#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Signs that stand for numbers or wildcards, in names of files and folders that have them.
# Usage: odd_names.sh PROGRAM OIIOTOOL SCRATCH
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"
for frame in 1 2 3; do
    "$program" synth cloud "puff.000$frame.vdb" --dims 12x12x12 --seed $frame -qq
done
small=(--size 16x12 -qq)
"$program" render puff.####.vdb --frames 1-3 -o all.####.exr "${small[@]}"
said_nothing() { [[ ! -s stderr.txt ]] || fail "got $(<stderr.txt); expected to be told nothing"; }

# A file that is there is read by its very name, and one that is written gets the name it was given.
for name in 'vol[1]' 'shot #1' '50%d' '50%04d' a@b 'cost$F' '{name}' 'x*'; do
    cp puff.0001.vdb "$name.vdb"
    expect_code 0 "$program" info "$name.vdb"
    said_nothing
    expect_code 0 "$program" render "$name.vdb" -o one.exr --size 16x12
    said_nothing
    expect_code 0 "$program" render puff.0001.vdb -o "./${name//[\[\]%\$\{\}*]/}.png" --size 16x12
    expect_code 0 "$program" diff "$name.vdb" puff.0001.vdb
done

# In the name of a folder that is there signs are letters: of inputs, outputs and stacks.
for at in job@farm 'take #2' 100%done '[old]' 'a$F4' '%04d' '{x}' '####'; do
    mkdir "$at"
    cp puff.*.vdb "$at"
    cp puff.0001.vdb "$at/one@.vdb"
    expect_code 0 "$program" info "$at/puff.####.vdb" --frames 1-3
    said_nothing
    expect_code 0 "$program" render "$at/puff.####.vdb" --frames 1-3 -o "$at/out.####.exr" \
        --stats "$at/out.####.json" --size 16x12
    said_nothing
    for frame in 0001 0002 0003; do
        same "$at/out.$frame.exr" "all.$frame.exr" || fail "$at: frame $frame is another picture"
    done
    expect_code 0 "$program" convert "$at/puff.####.vdb" "$at/made.@.nrrd" --frames 1-2
    said_nothing
    expect_code 0 "$program" render "$at/one@.vdb" -o "$at/turn.#.exr" --turntable 2 --size 16x12
    said_nothing
    expect_code 0 "$program" render "$at/p*.vdb" -o "$at/{name}_.exr" --size 16x12
    said_nothing
    (cd "$at" && expect_files "made.1.nrrd made.2.nrrd one@.vdb out.0001.exr out.0001.json out.0002.exr out.0002.json out.0003.exr out.0003.json puff.0001.vdb puff.0001_.exr puff.0002.vdb puff.0002_.exr puff.0003.vdb puff.0003_.exr turn.1.exr turn.2.exr" '*') || exit 1
done
for at in job@farm '%04d'; do
    for number in 1 2 3; do
        "$oiiotool" --pattern "constant:color=0.$number" 4x4 1 -d uint8 -o "$at/slice.$number.pgm"
    done
    "$program" info "$at/slice.#.pgm" | grep -q 4x4x3 || fail "$at: got another stack"
done
"$program" render '{x}/puff.000[12].vdb' -o '{x}/{name}/b.exr' "${small[@]}"
same '{x}/puff.0002/b.exr' all.0002.exr || fail "a folder with braces was not found"

# Where there is none, they are numbers, which is said.
expect_code 0 "$program" render puff.####.vdb --frames 1-2 -o 'out@1/p.####.exr' --size 16x12
expect_said "deltasplat: warning: --output: the frame's number stands in the name of the folder out@1, for there is none of that very name"
expect_files "out11 out21" 'out*'
expect_code 0 "$program" info 'out@1/../puff.000@.vdb' --frames 1-2
expect_said "deltasplat: warning: INPUT: the frame's number stands in the name of the folder out@1, for there is none of that very name"

# Behind a backslash they are letters everywhere.
expect_code 0 "$program" render 'job\@farm/puff.####.vdb' --frames 1-2 -o 'new\@1/p\#.####.exr' \
    --stats 'new\@1/\$F\%d.#.json' --size 16x12
said_nothing
(cd new@1 && expect_files '$F%d.1.json $F%d.2.json p#.0001.exr p#.0002.exr' '*') || exit 1
said_nothing
expect_code 0 "$program" info 'a\@b.vdb' 'vol\[1\].vdb' '\{name\}.vdb'
said_nothing
expect_code 0 "$program" convert 'a\@b.vdb' 'p.\#\#\%04d\$F\\.vdb'
cmp -s 'p.##%04d$F\.vdb' a@b.vdb || expect_code 0 "$program" diff 'p.##%04d$F\.vdb' a@b.vdb
expect_code 0 "$program" render 'job\@farm/p*\1.vdb' -o 'thumb\@\{1\}/{name}.exr' --size 16x12
same 'thumb@{1}/puff.0001.exr' all.0001.exr || fail "thumb@{1}/puff.0001.exr is another picture"
expect_code 0 "$program" render 'puff.*.vdb' -o 'sheet\@.png' --contact-sheet 3x1 --size 16x12
[[ -f sheet@.png ]] || fail "got no sheet@.png"
expect_code 2 "$program" render puff.0001.vdb -o 'p.\#.####.png'
expect_said "deltasplat: --output: got p.\\#.####.png without --frames; expected --frames with it, as in --frames 1-100"
