#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A small picture is there before the picture, shows the same, and goes.
# Usage: preview.sh PROGRAM OIIOTOOL SCRATCH
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"
"$program" synth cloud in.1.vdb --dims 40x30x20 -qq
cp in.1.vdb in.2.vdb
view=(--view iso --background 0.1,0.2,0.4 -qq)

# Runs with a preview, of which copies are kept that appear under the given names.
keeping() { # "NAMES" ARGUMENTS
    local names=$1 name
    shift
    "$program" "$@" &
    local pid=$!
    while kill -0 $pid 2>/dev/null; do
        for name in $names; do
            [[ -e kept.$name ]] || cp "$name" "kept.$name" 2>/dev/null || rm -f "kept.$name"
        done
    done
    wait $pid || fail "got code $?: $*"
}

keeping out.preview.png render in.1.vdb -o out.png --size 3000x2000 --progressive "${view[@]}"
expect_files out.png 'out*'
"$program" render in.1.vdb -o plain.png --size 3000x2000 "${view[@]}"
expect_same out.png plain.png
"$program" render in.1.vdb -o small.png --size 375x250 "${view[@]}"
expect_same kept.out.preview.png small.png

# Sizes that have no eighth keep their frame: what is seen fills as much of it.
keeping odd.preview.exr render in.1.vdb -o odd.exr --size 3001x1003 --autocrop --overscan 20 --aov depth \
    --progressive "${view[@]}"
expect_files odd.exr 'odd*'
[[ $("$oiiotool" --info -v kept.odd.preview.exr) == *" 375 x  125, 4 channel"*PixelAspectRatio:* ]] ||
    fail "kept.odd.preview.exr is not as small as it should be"
"$program" render in.1.vdb -o odd_plain.exr --size 3001x1003 "${view[@]}"
read -r small _ <<<"$(mean kept.odd.preview)"
read -r large _ <<<"$(mean odd_plain)"
holds "$small / $large > 0.99 && $small / $large < 1.01" ||
    fail "kept.odd.preview.exr: got a mean of $small; expected about $large"

# Of a sequence each has its own; a failure leaves none.
keeping "seq.1.preview.png seq.2.preview.png" render in.#.vdb -o seq.#.png --frames 1-2 --size 2000x2000 \
    --threads 1 --progressive "${view[@]}"
expect_files "seq.1.png seq.2.png" 'seq*'
[[ -e kept.seq.1.preview.png && -e kept.seq.2.preview.png ]] || fail "a frame had no preview"
(
    trap '' XFSZ
    ulimit -f 300
    expect_code 4 "$program" render in.1.vdb -o full.exr --size 900x900 --float --progressive "${view[@]}"
    exit $failed
) || failed=1
expect_files "" 'full*'

# Nothing that others have made is overwritten or removed, nor anything that is read.
"$program" render in.1.vdb -o frame.exr --size 80x60 "${view[@]}"
refused() { # CODE NAME MESSAGE ARGUMENTS: NAME is a file that stays as it is
    cp "$2" before
    expect_code "$1" "$program" render in.1.vdb --size 80x60 --background 0,0,0 -qq --progressive "${@:4}"
    expect_said "deltasplat: --progressive: got $2$3"
    cmp "$2" before || fail "$2 is another file than before"
    expect_files "" "${2/.preview/}"
}
for given in "--camera exr" "--env exr" "--tf exr" "--ocio png" "--look png"; do
    name=shot.preview.${given#* }
    cp frame.exr $name
    # A table is read before it is known what it is called.
    [[ $given != --look* ]] || printf '%s\n' 'LUT_1D_SIZE 2' '0 0 0' '1 1 1' >$name
    more=()
    [[ $given != --env* ]] || more=(--lighting scatter)
    refused 2 $name "; expected another file than those that the command reads or writes" \
        -o ${name/.preview/} ${given% *} $name "${more[@]}"
done
cp in.1.vdb mask.preview.png
refused 2 mask.preview.png "; expected another file than those that the command reads or writes" -o mask.png \
    --mask mask.preview.png
other=", a file that is no preview; expected no file of this name, or what a preview has left"
echo precious >z.preview.png
refused 4 z.preview.png "$other" -o z.png
"$program" render in.1.vdb -o z.preview.png --size 80x60 "${view[@]}"
refused 4 z.preview.png "$other" -o z.png
# What a program that was killed has left is replaced, and goes.
cp kept.out.preview.png z.preview.png
"$program" render in.1.vdb -o z.png --size 80x60 --progressive "${view[@]}"
expect_files z.png 'z*'
