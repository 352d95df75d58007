#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the program where a user may have few threads (ulimit -u): whatever happens is an exit code
# of its own and one line, and with a few threads more it works.
# Usage: few_threads.sh PROGRAM FRUSTUM.vdb
set -uo pipefail
program=$1
frustum=$2
# Where another user gets to as well: a build folder may lie in a home that is closed to others.
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
chmod 755 "$scratch"
cd "$scratch" || exit 1
"$program" synth slab slab_8x8x8_uint8.raw --dims 8x8x8 -q || exit 1
cp "$frustum" frustum.vdb && chmod a+r frustum.vdb || exit 1
"$program" render slab_8x8x8_uint8.raw -o expected.exr -q || exit 1

# The limit is on a user's threads altogether, and not on root's: a user who has none is needed.
user=3123456780
as_user=(setpriv --reuid=$user --regid=$user --clear-groups)
if [[ $(id -u) != 0 ]] || ! "${as_user[@]}" true 2>/dev/null; then
    echo "skipped: needs root and setpriv, to become a user without other processes"
    exit 77
fi
mkdir -p there/bin there/lib
cp "$program" there/bin/program
cp -r "${program%/*}/../lib/deltasplat" there/lib/
if ! "${as_user[@]}" bash -c 'exec there/bin/program --version' >/dev/null; then
    echo "skipped: another user cannot reach $scratch"
    exit 77
fi
if "${as_user[@]}" bash -c 'ulimit -u 1; (:) ' 2>/dev/null; then
    echo "skipped: this system does not limit threads"
    exit 77
fi
chmod 777 .

declare -A worked
for limit in 1 3 4 5 6 8 10 12 16 40 100; do
    for threads in 2 16; do
        for name in render frustum version; do
            command=(render slab_8x8x8_uint8.raw -o out.exr --threads $threads -qq)
            # Its transform is read by OpenVDB's library, which starts threads while it is loaded.
            [[ $name == frustum ]] && command=(info frustum.vdb --threads $threads -qq)
            [[ $name == version ]] && command=(--version)
            timeout -k 5 60 "${as_user[@]}" bash -c "ulimit -u $limit; exec there/bin/program \"\$@\"" - "${command[@]}" \
                >stdout 2>message
            code=$?
            [[ $name == frustum && $code == 3 && $(cat message) == *NonlinearFrustumMap* ]] &&
                code=0 && : >message
            [[ $code == 0 || $code == 1 ]] ||
                { echo "ulimit -u $limit, ${command[*]}: exit code $code: $(cat message)"; exit 1; }
            [[ $code == 0 ||
                ($(wc -l <message) == 1 && $(cat message) == "deltasplat: a thread cannot be started"*) ]] ||
                { echo "ulimit -u $limit, ${command[*]}: $(cat message)"; exit 1; }
            [[ $code == 0 ]] && worked[$name]=$limit
            if [[ $name == render ]]; then
                [[ ($code == 0 && -e out.exr) || ($code == 1 && ! -e out.exr) ]] ||
                    { echo "ulimit -u $limit, ${command[*]}: exit code $code and $(ls out.*)"; exit 1; }
            fi
            rm -f out.exr
        done
    done
    [[ $limit != 10 || (-n ${worked[render]:-} && -n ${worked[frustum]:-}) ]] ||
        { echo "ten threads are not enough"; exit 1; }
done
