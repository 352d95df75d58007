#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Deep pictures as other programs take them: flattened they are the flat picture, and those of parts
# of a volume, merged in any order, are that of the whole.
# Usage: deep.sh PROGRAM OIIOTOOL SCRATCH
set -euo pipefail
program=$1 oiiotool=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
failed=0
fail() { echo "$*"; failed=1; }

# Colours, so that it shows which part is before which.
look=(--tf colors.json --range 0,1)
echo '{"RGBPoints": [0, 1, 0, 0, 0.3, 0, 0.1, 1, 1, 0.2, 1, 0], "ColorSpace": "RGB",
    "Points": [0, 0, 0.5, 0, 1, 0.3, 0.5, 0]}' >colors.json
render() { # OUTPUT OPTIONS...
    "$program" render cloud.vdb -q -q --size 200x100 "${look[@]}" -o "$@"
}
within() { # ERROR A B
    "$oiiotool" "$2" "$3" --fail "$1" --hardfail "$1" --diff >said
}
alike() { within "$@" || { cat said; fail "$2 is not $3, within $1"; }; }
flatten() { # OUTPUT INPUTS...: merged, the Z channels aside
    local inputs=("${@:2}") merges=()
    for _ in "${inputs[@]:1}"; do merges+=(--deepmerge); done
    "$oiiotool" "${inputs[@]}" "${merges[@]}" --flatten --ch R,G,B,A -o "$1"
}

"$program" synth cloud cloud.vdb --dims 64x64x64 -q

# Flattened.
iso=(--view iso --extinction 2)
eye=(--projection perspective --eye 30,34,120 --target 30,34,32)
around=(--projection latlong --eye 31,33,29 --extinction 0.5)
for camera in iso eye around; do
    declare -n options=$camera
    render flat_$camera.exr "${options[@]}"
    render deep_$camera.exr "${options[@]}" --deep --stats stats.json
    flatten flattened_$camera.exr deep_$camera.exr
    alike 1e-3 flattened_$camera.exr flat_$camera.exr
    "$oiiotool" --info -v deep_$camera.exr >info
    grep -q 'deep half/half/half/half/float/float openexr' info || fail "$camera: channel types"
    grep -q 'channel list: R (half), G (half), B (half), A (half), Z (float), ZBack (float)' info ||
        fail "$camera: channels"
    grep -q 'deltasplat:deepSlices: "8"' info || fail "$camera: metadata"
    grep -q 'worldToCamera' info || fail "$camera: matrices"
done
within 1e-3 flat_eye.exr flat_iso.exr && fail "pictures are alike that are not"

# As few samples as there may be, and as many.
render one.exr "${iso[@]}" --deep --deep-slices 1000 --stats one.json
render many.exr "${iso[@]}" --deep --deep-slices 1 --float --stats many.json
most() { sed -n 's/.*"most_samples": \([0-9]*\).*/\1/p' "$1"; }
[[ $(most one.json) == 1 ]] || fail "1000 slices a sample: got $(most one.json) samples"
[[ $(most many.json) -gt 20 ]] || fail "1 slice a sample: got $(most many.json) samples"
for picture in one many; do
    flatten flattened.exr $picture.exr
    alike 1e-3 flattened.exr flat_iso.exr
done

# Two parts, of the same camera, with so many sheet pixels that what is resampled is smooth.
halves() { # NAME OPTIONS...
    local name=$1
    render whole.exr "${@:2}" --size 300x300 --stats stats.json
    read -ra camera < <(sed -n 's/.*"options": "\(.*\)".*/\1/p' stats.json)
    camera+=(--resolution 4)
    render whole.exr "${camera[@]}"
    render near.exr "${camera[@]}" --deep --crop :,:,33:
    render far.exr "${camera[@]}" --deep --crop :,:,:32
    flatten merged.exr near.exr far.exr
    alike 2e-3 merged.exr whole.exr
    flatten turned.exr far.exr near.exr
    alike 1e-6 merged.exr turned.exr
    # It is depth that puts one behind the other.
    flatten far_alone.exr far.exr
    within 2e-2 far_alone.exr whole.exr && fail "$name: the far part is all"
    return 0
}
halves parallel --view front
halves oblique --direction=-0.4,-0.3,-1
halves eye "${eye[@]}"
exit $failed
