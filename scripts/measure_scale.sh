#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# How time grows with volumes, pictures and threads: enlarges engine, ct_head and aneurism of the
# shared data, makes an engine, a cloud and vessels of our own, measures all four methods, beside
# VTK and VolPack if their drivers are given, and writes Markdown tables. FOLDER keeps the volumes
# (3 GB). Takes ten minutes to an hour on two cores.
# Usage: bash scripts/measure_scale.sh DATA FOLDER [PEERS]
#   DATA   folder of engine/, ct_head/ and aneurism/
#   PEERS  folder of peer_vtk.py and peer_volpack.py
set -euo pipefail
[[ $# -ge 2 ]] || { echo "Usage: bash scripts/measure_scale.sh DATA FOLDER [PEERS]" >&2; exit 2; }
data=$1
folder=$2
peers=${3:-}
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
bin=$root/build/release/bin
repeats=5
camera=(--direction=-1,0.8,-0.6 --up 0,0,1)
mkdir -p "$folder"

enlarged() { # FACTOR FILE...
    local made
    made=$(compgen -G "$folder/$(basename "$2" | sed 's/[_.].*//')$1_*.raw" | head -1 || true)
    [[ -n $made ]] && echo "$made" || "$bin/enlarge_volume" "$1" "$2" "$folder"
}
sampled() { # NAME EDGE
    local file=$folder/$1_$2x$2x$2_uint8.raw
    [[ -e $file ]] || "$bin/deltasplat" -qq synth "$1" "$file" --dims "$2x$2x$2"
    echo "$file"
}
# Milliseconds of a method, of the JSON of bench: medians.
milliseconds() { # JSON METHOD
    python3 -c 'import json, sys
run = json.load(open(sys.argv[1]))["runs"][0]["methods"][sys.argv[2]]
print("%.2f" % (1e3 * run["render"]["median"]))' "$1" "$2"
}
# How many slices are joined, and milliseconds of preparing them: the median.
joined() { # JSON
    python3 -c 'import json, sys
run = json.load(open(sys.argv[1]))["runs"][0]
print("%d, %.1f" % (run["joined"], 1e3 * run["prepare"]["median"]))' "$1"
}
# Milliseconds of a peer's picture, of the JSON that it prints: the median; empty without one, which
# is said.
peer() { # DRIVER FILE THREADS
    [[ -n $peers ]] || return 0
    local run=() got
    [[ $1 == peer_vtk ]] && run=(xvfb-run -a)
    got=$("${run[@]}" python3 "$peers/$1.py" "$2" --tf ct --view oblique --threads "$3" \
        --repeats $repeats --out "$folder/peer.png" 2>"$folder/errors.txt" | tail -1 |
        python3 -c 'import json, sys
try: print("%.1f" % (1e3 * json.load(sys.stdin)["render_s"]["median"]))
except Exception: print("")') || true
    [[ -n $got ]] || echo "$1: no figure of $2: $(tail -1 "$folder/errors.txt")" >&2
    echo "$got"
}
measure() { # FILE THREADS SIZE
    "$bin/deltasplat" -qq bench "$1" --json --tf "$root/examples/ct.json" "${camera[@]}" \
        --repeats $repeats --threads "$2" --size "$3x$3" >"$folder/bench.json"
}
row() { # FILE THREADS
    measure "$1" "$2" 512
    echo "| $(basename "$1" _uint8.raw) | $2 |" \
        "$(milliseconds "$folder/bench.json" traditional) |" \
        "$(milliseconds "$folder/bench.json" sparse) |" \
        "$(milliseconds "$folder/bench.json" delta) |" \
        "$(milliseconds "$folder/bench.json" auto) | $(joined "$folder/bench.json") |" \
        "$(peer peer_vtk "$1" "$2") | $([[ $2 == 1 ]] && peer peer_volpack "$1" 1) |"
}

echo "Milliseconds a picture of 512x512, medians of $repeats:"
echo
echo "| volume | threads | traditional | sparse | delta | auto | slices joined, prepare | VTK | VolPack |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"
for factor in 1 2 4; do
    for file in "$data"/engine/engine_256x256x128_uint8.raw.gz \
        "$data"/ct_head/cthead_256x256x225_uint8.raw.gz \
        "$data"/aneurism/aneurism_256x256x256_uint8.raw.gz; do
        made=$(enlarged $factor "$file")
        for threads in 1 2; do row "$made" $threads; done
    done
    for name in engine cloud vessels; do
        made=$(sampled $name $((256 * factor)))
        for threads in 1 2; do row "$made" $threads; done
    done
done

echo
echo "Milliseconds of \`auto\` on two threads by the picture's edge, and with \`prepare\`:"
echo
echo "| volume | 128 | 256 | 512 | 1024 | 2048 | 4096 | exponents, 256 to 4096 |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- |"
for file in "$(enlarged 2 "$data/engine/engine_256x256x128_uint8.raw.gz")" \
    "$(enlarged 4 "$data/engine/engine_256x256x128_uint8.raw.gz")" \
    "$(enlarged 2 "$data/ct_head/cthead_256x256x225_uint8.raw.gz")" \
    "$(enlarged 4 "$data/ct_head/cthead_256x256x225_uint8.raw.gz")" \
    "$(enlarged 4 "$data/aneurism/aneurism_256x256x256_uint8.raw.gz")" \
    "$(sampled engine 1024)" "$(sampled cloud 1024)" "$(sampled vessels 1024)"; do
    runs=()
    for size in 128 256 512 1024 2048 4096; do
        measure "$file" 2 $size
        runs+=("$(milliseconds "$folder/bench.json" auto),$(joined "$folder/bench.json")")
    done
    python3 -c 'import math, sys
name, *runs = sys.argv[1:]
drawn, whole = [], []
for run in runs:
    render, _, prepare = run.split(",")
    drawn.append(float(render))
    whole.append(float(render) + float(prepare))
exponent = lambda times: math.log(times[5] / times[1]) / math.log(16)
cells = ["%.3g, %.3g" % both for both in zip(drawn, whole)]
print("| %s | %s | %.2f, %.2f |" % (name, " | ".join(cells), exponent(drawn), exponent(whole)))' \
        "$(basename "$file" _uint8.raw)" "${runs[@]}"
done
