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
small=(--size 16x12 -q)
"$program" render puff.####.vdb --frames 1-3 -o all.####.exr "${small[@]}" -q
! same all.0001.exr all.0002.exr || fail "two frames have one picture"
"$program" render puff.0001.vdb -o alone.exr "${small[@]}" -q
no_folder_said() {
    ! grep -q 'in the name of the folder' stderr.txt || fail "got $(<stderr.txt); expected no word of folders"
}
# oiiotool takes signs in names for numbers, too.
shows() { # FILE PICTURE
    cp "$1" shown.exr && same shown "$2" || fail "$1 is not $2"
}
expect_in() { # FOLDER NAMES
    local got
    got=$(cd "$1" && printf '%s\n' * | LC_ALL=C sort | tr '\n' ' ' | sed 's/ $//')
    [[ $got == "$2" ]] || fail "$1: got files $got; expected $2"
}

# A file that is there is read by its very name, and one that is written gets the name it was given.
for name in 'vol[1]' 'shot #1' '50%d' '50%04d' a@b 'cost$F' '{name}' 'x*'; do
    cp puff.0001.vdb "$name.vdb"
    expect_code 0 "$program" info "$name.vdb" -q >info.txt
    grep -qF "$name.vdb" info.txt || fail "$name.vdb was not read"
    expect_code 0 "$program" render "$name.vdb" -o one.exr "${small[@]}"
    expect_code 0 "$program" diff "$name.vdb" puff.0001.vdb -q
done
for name in 'new #1' new@b 'new%d' 'new[1]'; do
    expect_code 0 "$program" render puff.0001.vdb -o "$name.exr" "${small[@]}"
    shows "$name.exr" alone
done

# In the name of a folder that is there signs are letters: of inputs, outputs and stacks.
for at in job@farm 'take #2' 100%done '[old]' 'a$F4' '%04d' '{x}' '####'; do
    mkdir "$at"
    cp puff.*.vdb "$at"
    cp puff.0001.vdb "$at/one@.vdb"
    expect_code 0 "$program" info "$at/puff.####.vdb" --frames 1-3 -q >info.txt
    no_folder_said
    expect_code 0 "$program" render "$at/puff.####.vdb" --frames 1-3 -o "$at/out.####.exr" \
        --stats "$at/out.####.json" "${small[@]}"
    no_folder_said
    for frame in 0001 0002 0003; do shows "$at/out.$frame.exr" all.$frame.exr; done
    expect_code 0 "$program" convert "$at/puff.####.vdb" "$at/made.@.nii" --frames 1-2 -q
    no_folder_said
    expect_code 0 "$program" render "$at/one@.vdb" -o "$at/turn.#.exr" --turntable 2 "${small[@]}"
    no_folder_said
    expect_code 0 "$program" render "$at/p*.vdb" -o "$at/{name}_.exr" "${small[@]}"
    no_folder_said
    expect_in "$at" "made.1.nii made.2.nii one@.vdb out.0001.exr out.0001.json out.0002.exr out.0002.json out.0003.exr out.0003.json puff.0001.vdb puff.0001_.exr puff.0002.vdb puff.0002_.exr puff.0003.vdb puff.0003_.exr turn.1.exr turn.2.exr"
    for number in 1 2 3; do printf 'P5 2 2 255\n%s' "abc$number" >"$at/slice.$number.pgm"; done
    expect_code 0 "$program" info "$at/slice.#.pgm" -q >info.txt
    grep -q '2 x 2 x 3' info.txt || fail "$at: got another stack"
done

# Where there is none, they are numbers, which is said.
expect_code 0 "$program" render puff.####.vdb --frames 1-2 -o 'out@1/p.####.exr' "${small[@]}"
expect_said "deltasplat: warning: --output: the frame's number stands in the name of the folder out@1, for there is none of that very name"
expect_in out11 p.0001.exr
expect_in out21 p.0002.exr
expect_code 0 "$program" info 'out@1/../puff.000@.vdb' --frames 1-2 -q >info.txt
expect_said "deltasplat: warning: INPUT: the frame's number stands in the name of the folder out@1, for there is none of that very name"

# Behind a backslash they are letters everywhere.
expect_code 0 "$program" render 'job\@farm/puff.####.vdb' --frames 1-2 -o 'new\@1/p\#.####.exr' \
    --stats 'new\@1/\$F\%d.#.json' "${small[@]}"
no_folder_said
expect_in new@1 '$F%d.1.json $F%d.2.json p#.0001.exr p#.0002.exr'
expect_code 0 "$program" info 'a\@b.vdb' 'vol\[1\].vdb' '\{name\}.vdb' -q >info.txt
expect_code 0 "$program" convert 'a\@b.vdb' 'p.\#\#\%04d\$F\\.vdb' -q
expect_code 0 "$program" diff 'p.##%04d$F\.vdb' a@b.vdb -q
expect_code 0 "$program" render 'job\@farm/p*1.vdb' -o 'thumb\@\{1\}/{name}.exr' "${small[@]}"
shows 'thumb@{1}/puff.0001.exr' alone
expect_code 0 "$program" render 'puff.*.vdb' -o 'sheet\@.png' --contact-sheet 3x1 "${small[@]}"
[[ -f sheet@.png ]] || fail "got no sheet@.png"
expect_code 2 "$program" render puff.0001.vdb -o 'p.\#.####.png'
expect_said "deltasplat: --output: got p.\\#.####.png without --frames; expected --frames with it, as in --frames 1-100"
# A name that nobody typed is told of nobody.
expect_code 3 "$program" info 'none\@.vdb' -q
expect_said 'deltasplat: none\@.vdb: got no such file; expected a readable file'
