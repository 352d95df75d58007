#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders a volume by every method, on one and two threads (and at every SIMD level) and checks that
# the pixels are the same to the last bit, and not the same where the view differs.
# Usage: identity.sh PROGRAM OIIOTOOL SCRATCH SIMD INPUT OPTIONS...
#   SIMD   "every" level, or "best" only
#   INPUT  a file, or "synth", which makes a volume that every view shows differently
set -euo pipefail
program=$1 oiiotool=$2 scratch=$3 simd=$4 input=$5
shift 5
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
if [[ $input == synth ]]; then
    input=cloud_40x36x29_uint8.raw
    "$program" synth cloud "$input" --dims 40x36x29 -q
fi
levels=(auto)
if [[ $simd == every ]]; then
    read -ra levels < <("$program" --version | sed -n 's/^SIMD level .*(of \(.*\))$/\1/p' | tr -d ,)
    [[ ${#levels[@]} -gt 0 ]]
fi

views=("--view front" "--view iso" "--direction=-1,0.8,-0.6 --up 0,0,1")
declare -A shown
for view in "${views[@]}"; do
    pictures=()
    for method in traditional sparse delta auto; do
        for threads in 1 2; do
            for level in "${levels[@]}"; do
                pictures+=("$method-$threads-$level.exr")
                # shellcheck disable=SC2086  # a view is several words
                "$program" render "$input" "$@" $view --method "$method" --threads "$threads" \
                    --simd "$level" --float -o "${pictures[-1]}" -q
            done
        done
    done
    hashes=$("$oiiotool" --info --hash "${pictures[@]}" | sed -n 's/^ *SHA-1: //p')
    [[ $(wc -l <<<"$hashes") == "${#pictures[@]}" ]] || { echo "pictures missing"; exit 1; }
    if [[ $(sort -u <<<"$hashes" | wc -l) != 1 ]]; then
        echo "$view: pixels differ:"
        paste <(printf '%s\n' "${pictures[@]}") - <<<"$hashes"
        exit 1
    fi
    shown[${hashes%%$'\n'*}]=$view
done
# Pictures of nothing would be the same, too.
[[ ${#shown[@]} == "${#views[@]}" ]] || { echo "two views show the same"; exit 1; }
