#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the job files of examples/farm on a Slurm of one node that it starts by itself, as root, in a
# temporary folder: a sequence of 100 frames as an array that is cancelled half way and sent again,
# one picture in parts, and the first again by GNU parallel. Ends with 77 where something is not
# installed (Debian: slurm-wlm munge parallel openimageio-tools) or there is no root to start it.
# Needs no network; stops all that it started.
# Usage: try_slurm.sh PROGRAM
set -euo pipefail
program=$(realpath "$1")
farm=$(realpath "$(dirname "$0")/../examples/farm")
for tool in munged slurmctld slurmd sbatch parallel oiiotool; do
    command -v $tool >/dev/null || { echo "skipped: no $tool"; exit 77; }
done
[[ $(id -u) == 0 ]] || { echo "skipped: needs root"; exit 77; }

folder=$(mktemp -d)
pids=()
fail() { echo "FAILED: $*"; exit 1; }
clean_up() {
    local code=$? pid
    if [[ ${#pids[@]} == 3 ]]; then scancel --full --user=root 2>/dev/null || true; sleep 1; fi
    for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
    for pid in "${pids[@]}"; do wait "$pid" 2>/dev/null || true; done
    [[ $code == 0 ]] || tail -n 20 "$folder"/*.log
    rm -rf "$folder"
    exit $code
}
trap clean_up EXIT
chmod 755 "$folder"
mkdir "$folder"/{state,spool,work}
host=$(hostname -s)
port=$((20000 + $$ % 20000))

# Keys and sockets of its own: another Slurm on this machine has nothing to do with it.
(umask 077; head -c 128 /dev/urandom >"$folder/munge.key")
munged --foreground --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" \
    --pid-file="$folder/munged.pid" --log-file="$folder/munged.log" \
    --seed-file="$folder/munge.seed" >"$folder/munged.out.log" 2>&1 &
pids+=($!)
cat >"$folder/slurm.conf" <<CONF
ClusterName=try
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
SlurmdSpoolDir=$folder/spool
StateSaveLocation=$folder/state
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=2
KillWait=2
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=100000
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=2048 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$folder/slurm.conf
for ((i = 0; i < 100; ++i)); do [[ -S $folder/munge.socket ]] && break; sleep 0.1; done
slurmctld -D -f "$SLURM_CONF" >"$folder/slurmctld.out.log" 2>&1 &
pids+=($!)
slurmd -D -f "$SLURM_CONF" -N "$host" >"$folder/slurmd.out.log" 2>&1 &
pids+=($!)
for ((i = 0; i < 300; ++i)); do
    [[ $(sinfo -h -o %t 2>/dev/null) == idle ]] && break
    sleep 0.1
done
[[ $(sinfo -h -o %t) == idle ]] || fail "the node is not there: $(sinfo 2>&1)"
echo "Slurm $(sinfo --version | cut -d' ' -f2), $(nproc) cores"

all_done() { # waits until no job is left
    for ((i = 0; i < 3000; ++i)); do
        [[ -n $(squeue -h) ]] || return 0
        sleep 0.1
    done
    fail "jobs that do not end: $(squeue)"
}
frames() { find . -maxdepth 1 -name 'turn.*.png' | sort; }
hashes() { oiiotool --info --hash "$@" | sed -n 's/^ *SHA-1: //p'; }

cd "$folder/work"
"$program" synth cloud cloud.vdb --dims 64x64x64 --seed 1 -q
mkdir one
export DELTASPLAT=$program INPUT=cloud.vdb FRAMES=100 CHUNK=5 FIRST_PASS=first.json LOG=farm.log
export OPTIONS='--turntable 100 --size 300x300 --view iso -q'
# shellcheck disable=SC2086
"$program" render $INPUT -o one/turn.####.png $OPTIONS
# shellcheck disable=SC2086
"$program" render $INPUT --frames 1-100 --first-pass first.json $OPTIONS

# Cancelled half way.
export OUTPUT=turn.####.png
sbatch -Q --array=0-19 "$farm/deltasplat.slurm"
for ((i = 0; i < 6000; ++i)); do
    [[ $(frames | wc -l) -lt 40 ]] || break
    sleep 0.02
done
scancel --user=root --name=deltasplat
all_done
before=$(frames | wc -l)
((before >= 40 && before < 100)) || fail "$before frames were there when it was cancelled"
oiiotool --info --hash turn.*.png >/dev/null || fail "a frame that cannot be read"
stat -c '%n %i %y' turn.*.png >before.txt
echo "cancelled with $before of 100 frames"

# Sent again.
sbatch -Q --array=0-19 "$farm/deltasplat.slurm"
all_done
[[ $(frames | wc -l) == 100 ]] || fail "$(frames | wc -l) frames in the end; expected 100"
stat -c '%n %i %y' turn.*.png | grep -xFf before.txt | cmp - before.txt ||
    fail "a frame was rendered twice"
[[ $(hashes turn.*.png) == "$(hashes one/turn.*.png)" ]] || fail "frames have other pixels"
[[ -z $(compgen -G '.deltasplat.*' || true) ]] || fail "left behind: $(compgen -G '.deltasplat.*')"
echo "100 frames, pixels as of one process; $before of them left alone"

# One picture in parts.
export INPUT=cloud.vdb OUTPUT=whole.exr OPTIONS='--size 800x800 --view iso --tf viridis -q'
parts=$(sbatch --parsable --array=1-4 "$farm/slabs.slurm")
sbatch -Q --dependency="afterok:$parts" "$farm/slabs.slurm"
all_done
# shellcheck disable=SC2086
"$program" render $INPUT -o one.exr $OPTIONS
[[ -e whole.exr && $(hashes whole.exr) == "$(hashes one.exr)" ]] || fail "parts: another picture"
[[ -z $(compgen -G '*.slabs' || true) ]] || fail "parts: they are still there"
echo "one picture of 4 parts, pixels as of one process"

# GNU parallel, killed half way, and sent again.
rm turn.*.png parallel.log 2>/dev/null || true
export OPTIONS=''
setsid bash "$farm/parallel.sh" cloud.vdb 'turn.####.png' 1-100 --turntable 100 --size 300x300 \
    --view iso -qq 2>/dev/null &
job=$!
for ((i = 0; i < 6000; ++i)); do
    [[ $(frames | wc -l) -lt 30 ]] || break
    sleep 0.02
done
kill -KILL -- "-$job"
wait $job 2>/dev/null || true
sleep 1
before=$(frames | wc -l)
((before >= 30 && before < 100)) || fail "$before frames were there when parallel was killed"
stat -c '%n %i %y' turn.*.png >before.txt
bash "$farm/parallel.sh" cloud.vdb 'turn.####.png' 1-100 --turntable 100 --size 300x300 --view iso -qq
stat -c '%n %i %y' turn.*.png | grep -xFf before.txt | cmp - before.txt ||
    fail "parallel: a frame was rendered twice"
[[ $(hashes turn.*.png) == "$(hashes one/turn.*.png)" ]] || fail "parallel: other pixels"
[[ -z $(compgen -G '.deltasplat.*' || true) ]] || fail "left behind: $(compgen -G '.deltasplat.*')"
echo "GNU parallel: 100 frames, pixels as of one process; killed with $before of them"
