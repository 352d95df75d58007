#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Asks every command to write over a file that its input is made of, and checks that it refuses (2)
# and that the file is as before.
# Usage: inputs_kept.sh PROGRAM SCRATCH DICOM   (whether the program reads DICOM)
set -euo pipefail
program=$1 scratch=$2 itk=$3
rm -rf "$scratch"
mkdir -p "$scratch/slices"
cd "$scratch"
"$program" synth cloud v_8x9x10_uint8.raw --dims 8x9x10 -q
"$program" convert v_8x9x10_uint8.raw x.nhdr -q
for i in 1 2 3; do
    "$program" render v_8x9x10_uint8.raw -o "slices/s.000$i.png" --size 16x16 -q
done
cp slices/s.0001.png s.png
echo '[{"Points": [0, 0, 0.5, 0, 255, 1, 0.5, 0], "RGBPoints": [0, 0, 0, 0, 255, 1, 1, 1]}]' >tf.json
"$program" render v_8x9x10_uint8.raw --tf tf.json -o tf_is_good.exr -q
mkdir page
cp tf.json page/index.html
ln -s tf.json link.json
ln s.png other_name.png
ln -s new.exr dangling.json
find . -type f -exec md5sum {} + | sort >../inputs_kept.before

refused() {
    local code=0
    "$program" "$@" -q 2>message || code=$?
    [[ $code == 2 && $(cat message) =~ "; expected "("another "|"a new one") ]] ||
        { echo "$*: got exit code $code and: $(cat message)"; exit 1; }
    rm message
}
if [[ $itk == 1 ]]; then
    refused render x.nhdr -o p.png --stats x.raw.gz
    refused info x.nhdr --plot x.nhdr/../x.svg --plot slices/../s.png --tf s.png
    refused delta x.nhdr d.vdb --stats x.raw.gz
fi
# An output and its own data file.
mkdir own
ln -s o.mhd own/o.raw
ln -s p.raw.gz own/p.nhdr
refused convert v_8x9x10_uint8.raw own/o.mhd
refused convert v_8x9x10_uint8.raw own/p.nhdr
[[ ! -e own/o.mhd && ! -e own/p.raw.gz ]] || { echo "an output that is its own data file"; exit 1; }
refused info s.png --plot s.png
refused info s.png --plot other_name.png
refused info v_8x9x10_uint8.raw slices --plot slices/s.0002.png
refused info 'slices/s.####.png' --plot slices/s.0002.png
refused render slices -o slices/s.0003.png
refused render slices -o p.png --stats slices/s.0003.png
refused render s.png -o s.png
refused render v_8x9x10_uint8.raw -o p.png --tf tf.json --stats tf.json
refused render v_8x9x10_uint8.raw -o p.png --tf tf.json --stats link.json
refused render v_8x9x10_uint8.raw -o new.exr --stats dangling.json
refused convert 'slices/s.####.png' o.vdb --stats slices/s.0001.png
refused render slices/s.0001.png --list-tf slices/s.0001.png
refused render 'slices/s.####.png' -o p.png --list-tf slices/s.0002.png
refused render --list-tf s.png -o p.png
refused bench v_8x9x10_uint8.raw --tf page/index.html --report page

# Listed, whatever the input is called.
for listed in "render s.png -o p.png --list-tf" "render slices/s.0001.png --list-tf -q" \
    "bench s.png --list-tf"; do
    # shellcheck disable=SC2086
    [[ $("$program" $listed) == grey*coolwarm* ]] || { echo "$listed: lists no presets"; exit 1; }
done

find . -type f -exec md5sum {} + | sort | diff ../inputs_kept.before - ||
    { echo "files changed"; exit 1; }
