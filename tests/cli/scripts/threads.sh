#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Counts the threads that the program and its libraries have at once: no more than --threads asks
# for, whatever the machine has. Without it there are as many as the affinity allows.
# Usage: threads.sh PROGRAM OIIOTOOL SCRATCH FRUSTUM.vdb
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
begin "$@"
frustum=$4

"$program" synth cloud cloud.vdb --dims 40x40x40 -q
for cores in 0 0,1; do
    command -v taskset >/dev/null && taskset -c $cores true 2>/dev/null || continue
    taskset -c $cores "$program" render cloud.vdb -o out.png --stats "$cores.json" -qq
    grep -qx "  \"threads\": $(tr -cd 01 <<<"$cores" | wc -c)," "$cores.json" ||
        fail "on cores $cores: got $(grep threads "$cores.json")"
done

if ! command -v strace >/dev/null || ! strace -f -o trace.txt true 2>/dev/null; then
    echo "skipped: no strace to count threads with"
    [[ $failed == 1 ]] || exit 77
    exit 1
fi
most_at_once() { # ARGUMENTS...
    # As on a machine of many cores.
    local code=0
    OPENIMAGEIO_THREADS=24 strace -f -e trace=clone,clone3 -o trace.txt "$program" "$@" -qq >/dev/null 2>message ||
        code=$?
    [[ $code == 0 || ($code == 3 && $(cat message) == *NonlinearFrustumMap*) ]] || fail "$*: $(cat message)"
    awk '/clone.*CLONE_THREAD.* = [0-9]+$/ { if (++now > most) most = now }
         /\+\+\+ exited/ { --now }
         END { print most + 0 }' trace.txt
}
# Those of OpenVDB's logger, which are started where its library is loaded: by OpenImageIO, and of a
# frustum, which is refused.
loaded=$(most_at_once info "$frustum" --threads 1)
for threads in 1 2 5; do
    # N - 1 of the library's, N - 1 of OpenImageIO's but at least one, and N of OpenEXR's.
    limit=$((loaded + 3 * threads - 2 + (threads == 1)))
    while read -r -a command; do
        got=$(most_at_once "${command[@]}" --threads $threads)
        ((got <= limit)) ||
            fail "${command[*]} --threads $threads: got $got threads; expected at most $limit"
    done <<COMMANDS
render cloud.vdb -o out.exr --size 600x600
render cloud.vdb -o out.exr --size 2200x2200
render cloud.vdb -o out.exr --aov depth --multipart
render cloud.vdb -o out.exr --deep
render cloud.vdb -o out.jpg
render cloud.vdb -o out.####.exr --turntable 6
render cloud.vdb -o out.slabs --slab-range 1/1
fold out.slabs -o out.exr
convert cloud.vdb out.nii.gz
convert cloud.vdb out.vdb
delta cloud.vdb out.vdb
info cloud.vdb
diff cloud.vdb cloud.vdb
COMMANDS
done
