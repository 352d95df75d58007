#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Replays mutations twice, with other bytes in memory that nobody has written: those that are
# accepted must give the same volumes and the same pictures.
# Usage: same_memory.sh REPLAY_PROGRAM MUTATIONS_OF_EACH_SEED SCRATCH_FOLDER
set -euo pipefail
program=$1 count=$2 scratch=$3
mkdir -p "$scratch"
MALLOC_PERTURB_=85 "$program" --digests "$count" >"$scratch/one" &
MALLOC_PERTURB_=170 "$program" --digests "$count" >"$scratch/other"
wait $!
accepted=$(grep -c '^seed .* mutation [1-9]' "$scratch/one") || true
if [[ $accepted -lt 10 ]]; then
    echo "only $accepted mutations were accepted: that shows nothing" >&2
    exit 1
fi
diff "$scratch/one" "$scratch/other"
echo "$accepted accepted mutations, all the same"
