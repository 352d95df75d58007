#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Frames of a sequence in one picture, numbered, black where there is no file, and as a movie: what
# is in it is checked where ffmpeg is installed.
# Usage: sheets_and_movies.sh PROGRAM OIIOTOOL SCRATCH
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"
for frame in 1 2 4; do
    "$program" synth cloud in.$frame.vdb --dims 24x24x$((24 + 8 * frame)) --seed $frame -qq
done
frames=(render in.#.vdb --size 32x24 -qq --background 0.2,0.1,0.05 --dither 0)

# Cells are the frames by themselves, row by row; those without a file are black, or the background.
"$program" "${frames[@]}" --frames 1-4 --missing black -o one.#.png
expect_files "one.1.png one.2.png one.3.png one.4.png" 'one.*'
grep -q "Constant: Yes" <<<"$("$oiiotool" --stats one.3.png 2>&1)" || fail "frame 3 is not of one colour"
! same one.2.png one.1.png || fail "frames 1 and 2 are one picture"
"$program" "${frames[@]}" --frames 1-4 --missing black -o sheet.png --contact-sheet 3x2 --threads 2
for cell in 1+0+0 2+32+0 3+64+0 4+0+24; do
    "$oiiotool" -q sheet.png --cut "32x24+${cell#*+}" -o cell.png
    same cell.png "one.${cell%%+*}.png" || fail "cell $cell is not its frame"
done
[[ $("$oiiotool" --info sheet.png) == *" 96 x   48, 4 channel"* ]] || fail "sheet.png has another size"
"$oiiotool" -q sheet.png --cut 32x24+64+24 -o cell.png
same cell.png one.3.png || fail "the last cell is not empty"

# What is black is exposed as the others are: the background is the same.
"$program" "${frames[@]}" --frames 2-3 --missing black -o bright.#.png --exposure 1 --tone filmic
for number in 2 3; do "$oiiotool" -q bright.$number.png --cut 1x1+0+0 -o corner.$number.png; done
same corner.2.png corner.3.png || fail "frames 2 and 3 have two backgrounds"
"$oiiotool" -q one.3.png --cut 1x1+0+0 -o corner.png
! same corner.3.png corner.png || fail "frame 3 is not exposed"

# Frames that fail leave their cell empty, if the others are wanted.
head -c 100 in.1.vdb >in.3.vdb
expect_code 3 "$program" "${frames[@]}" --frames 1-4 -o broken.png --contact-sheet 3x2 --keep-going
same broken.png sheet.png || fail "broken.png is another sheet"
expect_code 3 "$program" "${frames[@]}" --frames 1-4 -o none.png --contact-sheet 3x2
expect_files "" 'none*'
rm in.3.vdb

# Numbers differ from frame to frame of one volume.
"$program" render in.4.vdb --size 64x48 -qq --frames 1-2 --turntable 2 --slate -o slate.#.png --direction 0,0,-1 \
    --background 0,0,0 --tf grey --range 100,101
! same slate.1.png slate.2.png || fail "both frames have one number"
[[ $(most slate.1.png) != "0 0 0 255 " ]] || fail "slate.1.png has no number"

# Movies.
expect_code 4 env PATH=/nonexistent "$program" "${frames[@]}" --frames 1-2 --movie a.mp4
grep -q "got no program ffmpeg" stderr.txt || fail "got $(cat stderr.txt); expected to be told of ffmpeg"
expect_files "" 'a*'
if command -v ffmpeg >/dev/null; then
    "$program" "${frames[@]}" --frames 1-4 --missing skip --movie b.mp4 --fps 10 --threads 2
    "$program" "${frames[@]}" --frames 1-4 --missing skip --movie c.mp4 --fps 10 --threads 1 -o made.#.png
    cmp b.mp4 c.mp4 || fail "b.mp4 and c.mp4 are two movies"
    expect_files "made.1.png made.2.png made.4.png" 'made.*'
    expect_files "" 'b.png'
    "$program" "${frames[@]}" --frames 1-4 --missing black --movie d.mov
    for movie in b.mp4 d.mov; do
        ffmpeg -nostdin -v error -i $movie -pix_fmt rgb24 "${movie%.*}.%d.png" </dev/null
    done
    expect_files "b.1.png b.2.png b.3.png" 'b.?.png'
    expect_files "d.1.png d.2.png d.3.png d.4.png" 'd.?.png'
    for pair in b.1:1 b.2:2 b.3:4 d.1:1 d.3:3 d.4:4; do
        "$oiiotool" -q "one.${pair#*:}.png" --ch R,G,B -o wanted.png
        "$oiiotool" -q "${pair%:*}.png" wanted.png --fail 0.06 --failpercent 3 --diff >/dev/null ||
            fail "${pair%:*} is not frame ${pair#*:}"
    done
    # ffmpeg ends well where the end of its file cannot be written.
    (ulimit -f 2; expect_code 4 "$program" render in.4.vdb --size 64x64 -qq --turntable 24 --movie full.mp4 \
        --background 1,1,1; exit $failed) || fail "full.mp4: got no error"
    expect_files "" 'full*'
    echo "not a volume" >in.3.vdb
    expect_code 3 "$program" "${frames[@]}" --frames 1-4 --movie e.mp4
    expect_files "" 'e*'
    rm in.3.vdb
    # One that says much and does nothing.
    mkdir path
    printf '#!/bin/sh\nhead -c 1000000 /dev/zero >&2\ncat >/dev/null\n' >path/ffmpeg
    chmod +x path/ffmpeg
    expect_code 4 env PATH="$PWD/path:$PATH" "$program" render in.4.vdb --size 64x64 -qq --turntable 3 --movie loud.mp4
    expect_files "" 'loud*'
else
    echo "ffmpeg is not installed: no movie is looked into"
fi

# What cannot be meant.
usage() { # MESSAGE ARGUMENTS...
    expect_code 2 "$program" render "${@:2}"
    expect_said "deltasplat: $1"
}
usage "--contact-sheet: got 2x1 for 3 frames; expected room for all of them" \
    in.#.vdb -o g.png --frames 1-3 --contact-sheet 2x1
usage "--contact-sheet: got 4294967296x32 pixels; expected at most 1000000 each way" \
    in.1.vdb -o g.png --turntable 2 --contact-sheet 65536x2 --size 65536x16
usage "--output: got g.#.png with --contact-sheet; expected one file" \
    in.#.vdb -o g.#.png --frames 1-2 --contact-sheet 2x1
usage "--float: got a movie alone; expected -o with pictures" in.#.vdb --frames 1-2 --movie g.mp4 --float
usage "--missing: got black with --deep; expected error, skip or hold" \
    in.#.vdb -o g.#.exr --frames 1-3 --missing black --deep
usage "--contact-sheet: got one picture; expected several (--frames, --turntable, or a batch)" \
    in.1.vdb -o g.png --contact-sheet 2x1
usage "--movie: got g.avi; expected .mp4, .m4v, .mkv or .mov" in.#.vdb --frames 1-3 --movie g.avi
usage "--size: got 33x24 with --movie g.mp4; expected an even width and height, or a .mov" \
    in.#.vdb --frames 1-3 --movie g.mp4 --size 33x24
usage "--movie: got an .exr besides, which shows light as it is; expected -o with a .png, or none" \
    in.#.vdb --frames 1-3 --movie g.mp4 -o g.#.exr
usage "--fps: got it without --movie; expected a movie to make" in.#.vdb --frames 1-3 -o g.#.png --fps 30
usage "--skip-existing: got a sheet or movie of all frames; expected pictures of their own" \
    in.#.vdb --frames 1-3 -o g.png --contact-sheet 2x2 --skip-existing
usage "--output: got nothing; expected FILE (see 'deltasplat render --help')" in.1.vdb
expect_files "" 'g*'
