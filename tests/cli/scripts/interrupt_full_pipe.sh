#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A signal ends the program even where standard error is a full pipe that nobody reads.
# Usage: interrupt_full_pipe.sh PROGRAM SCRATCH
set -uo pipefail
program=$1 scratch=$2
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch" || exit 1
mkfifo full
exec 3<>full
dd if=/dev/zero of=full bs=4096 oflag=nonblock conv=notrunc 2>/dev/null

# Hangs where it says that there is no such file.
"$program" info nowhere.vdb 2>&3 &
pid=$!
for ((i = 0; i < 100; ++i)); do
    [[ $(cat "/proc/$pid/wchan" 2>/dev/null) == *pipe_write* ]] && break
    sleep 0.1
done
kill -0 $pid || { echo "ended by itself"; exit 1; }
kill -TERM $pid
for ((i = 0; i < 100; ++i)); do
    kill -0 $pid 2>/dev/null || break
    sleep 0.1
done
if kill -9 $pid 2>/dev/null; then
    echo "got no end in ten seconds; expected exit code 143"
    exit 1
fi
wait $pid
code=$?
[[ $code == 143 ]] || { echo "got exit code $code; expected 143"; exit 1; }
