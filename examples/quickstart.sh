#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds deltasplat, makes a sample volume and renders it.
# Usage: bash examples/quickstart.sh [FOLDER]   (default: out/quickstart)
set -euo pipefail
here=$(pwd)
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=out/quickstart
if [[ $# -gt 0 ]]; then folder=$(cd "$here" && realpath -m -- "$1"); fi

bash scripts/install_dependencies.sh --to-build
cmake --preset release </dev/null
cmake --build --preset release --target deltasplat_tool deltasplat

deltasplat=build/release/bin/deltasplat
volume=$folder/engine_256x256x256_uint8.raw
mkdir -p "$folder"
"$deltasplat" synth engine "$volume" --dims 256x256x256 --samples 3 -q
"$deltasplat" info "$volume"
"$deltasplat" render "$volume" -o "$folder/engine.png" --size 800x800 --view iso \
    --tf examples/engine.json --shade --light view:1,-1,-1:1,0.95,0.9:0.9 --light head:0.4 \
    --background 0.02,0.02,0.03 -q

echo "The picture is $(realpath "$folder/engine.png")"
