#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks the page that bench writes: whole, needing nothing else, its pictures those of render.
# Usage: bench_page.sh PROGRAM SCRATCH
set -euo pipefail
program=$1 scratch=$2
rm -rf "$scratch"
mkdir -p "$scratch/private"
cd "$scratch"
export TMPDIR=$scratch/private
"$program" synth cloud 'a&b<c>.vdb' --dims 24x20x22 -q
quick=(--repeats 1 --size 40x30 -q)

expect() { # what got expected
    [[ $2 == "$3" ]] || { echo "$1: got $2; expected $3"; exit 1; }
}
pictures() { { grep -o 'src="data:image/png;base64,[^"]*"' "$1" || true; } | cut -d, -f2 | tr -d '"'; }

"$program" bench 'a&b<c>.vdb' "${quick[@]}" --report page --background 0.1,0.2,0.3 >/dev/null
expect "files" "$(ls -A page)" index.html
page=page/index.html
expect "first line" "$(head -1 $page)" '<!doctype html>'
expect "last line" "$(tail -1 $page)" '</html>'
expect "title" "$(grep -o '<h2>.*</h2>' $page)" '<h2>a&amp;b&lt;c&gt;.vdb</h2>'
# Pictures, spelt in letters, may spell any word.
sed 's/base64,[^"]*//' $page >words
for word in http '<script' '<link' '@import' 'url(' "$scratch"; do
    ! grep -iF -- "$word" words || { echo "the page holds '$word'"; exit 1; }
done
for tag in html head body section figure svg table tr td div p; do
    expect "closing tags of $tag" "$(grep -o "</$tag>" words | wc -l)" \
        "$(grep -oE "<$tag( [^>]*)?>" words | wc -l)"
done
pictures $page >encoded
expect "pictures" "$(wc -l <encoded)" 4
expect "different pictures" "$(sort -u encoded | wc -l)" 1
expect "bars" "$(grep -oE '<rect class="(splat|composite|warp|prepare)"' $page | wc -l)" 16
head -1 encoded | base64 -d >bench.png
"$program" render 'a&b<c>.vdb' -o render.png --size 40x30 --background 0.1,0.2,0.3 -q
idiff -fail 0 -failpercent 0 -hardfail 0 -warn 0 bench.png render.png >/dev/null

# Two volumes under tolerance: four pictures each, the exact one, the other one and their difference.
"$program" bench 'a&b<c>.vdb' 'a&b<c>.vdb' "${quick[@]}" --report page --tolerance 0.1 >/dev/null
expect "pictures under tolerance" "$(pictures $page | wc -l)" 14
grep -q 'proved bound' $page

# A full disk: one line, and neither a page nor its folder is left, nor a picture.
code=0
(ulimit -f 4 && exec "$program" bench 'a&b<c>.vdb' "${quick[@]}" --report new) >/dev/null 2>message ||
    code=$?
expect "exit code" "$code" 4
expect "message" "$(cat message)" "deltasplat: new/index.html: cannot be written: File too large"
[[ ! -e new ]] || { echo "left behind: new"; exit 1; }
expect "temporary files" "$(ls -A private)" ""
