#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A disk that is full half way through a sequence: frames that were made are whole, no other has its
# name, nothing else is left, and the exit code says so. Goes on once there is room.
# Usage: full_disk_sequence.sh PROGRAM OIIOTOOL SCRATCH
source "${BASH_SOURCE%/*}/pictures.sh"
source "${BASH_SOURCE%/*}/runs.sh"
# In a namespace of its own, where it may mount a file system that is full soon.
if [[ -z ${DELTASPLAT_FULL_DISK:-} ]]; then
    enter=(unshare --mount)
    [[ $(id -u) == 0 ]] || enter=(unshare --mount --map-root-user)
    probe=$(mktemp -d)
    trap 'rmdir "$probe"' EXIT
    if ! "${enter[@]}" mount -t tmpfs -o size=64k none "$probe" 2>/dev/null; then
        echo "skipped: this system lets nobody mount a small file system"
        exit 77
    fi
    DELTASPLAT_FULL_DISK=1 "${enter[@]}" bash "$0" "$@"
    exit
fi
begin "$@"

"$program" synth cloud cloud.vdb --dims 24x24x24 -q
mkdir one disk
frames=(render cloud.vdb --turntable 100 --size 48x48 --compression none -qq)
hashes() { "$oiiotool" --info --hash "$@" | sed -n 's/^ *SHA-1: //p'; }
"$program" "${frames[@]}" -o one/turn.####.exr
bytes=$(stat -c %s one/turn.0001.exr)
# Room for about 50 of them.
mount -t tmpfs -o "size=$((50 * (bytes / 4096 + 1) * 4096))" none disk
expect_whole() { # LEAST MOST
    local made count
    made=$(cd disk && compgen -G 'turn.*')
    count=$(wc -l <<<"$made")
    ((count >= $1 && count <= $2)) || fail "got $count frames; expected $1 to $2"
    expect_files "" 'disk/.deltasplat.*'
    [[ $(cd disk && hashes $made) == "$(cd one && hashes $made)" ]] || fail "frames are broken"
}
expect_code 4 "$program" "${frames[@]}" -o disk/turn.####.exr
grep -q '^deltasplat: .*disk/turn[.]00..[.]exr: cannot be written: No space left on device$' stderr.txt ||
    fail "got $(cat stderr.txt)"
expect_whole 40 60

# The others are tried all the same, and each says so.
rm disk/turn.*
expect_code 4 "$program" "${frames[@]}" -o disk/turn.####.exr --keep-going
expect_whole 40 60
[[ $(tail -n 1 stderr.txt) == "deltasplat: "*" of 100 frames failed: "* ]] ||
    fail "got $(tail -n 1 stderr.txt)"

# With more room it goes on.
mount -o remount,size=16m none disk
"$program" "${frames[@]}" -o disk/turn.####.exr --skip-existing
expect_whole 100 100

# A batch says each failure once.
mkdir shots
for i in 1 2 3; do cp cloud.vdb shots/$i.vdb; done
umount disk
mount -t tmpfs -o size=4k none disk
expect_code 4 "$program" render 'shots/*.vdb' -o 'disk/{name}.exr' --size 48x48 --compression none \
    --index disk/index.html -q
[[ $(grep -c '^deltasplat: shots/[123].vdb: disk/[123].exr: cannot be written: No space left on device$' stderr.txt) == 3 &&
    $(wc -l <stderr.txt) == 5 ]] || fail "got $(cat stderr.txt)"
[[ $(tail -n 1 stderr.txt) == "deltasplat: 3 of 3 pictures failed: shots/1.vdb, shots/2.vdb, shots/3.vdb" ]] ||
    fail "got $(tail -n 1 stderr.txt)"
expect_files "" 'disk/*'
