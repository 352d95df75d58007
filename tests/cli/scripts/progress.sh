#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Who sees what on standard error: progress on a pipe only if asked for, warnings unless told off twice.
# Usage: progress.sh PROGRAM SCRATCH FIXTURES
set -euo pipefail
program=$1 scratch=$2 fixtures=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"

progress='Progress: 100%'
warning='deltasplat: warning: '
said() { # options...
    "$program" render "$fixtures/two.vdb" -o out.exr --size 8x8 "$@" 2>&1 | cat >said
}
expect() { # progress|- warning|- options...
    local wanted=$1$2 got=''
    shift 2
    said "$@"
    if grep -qxF "$progress" said; then got+=progress; else got+=-; fi
    if grep -qF "$warning" said; then got+=warning; else got+=-; fi
    [[ $got == "$wanted" ]] && return
    echo "render $*: got $got; expected $wanted"
    cat said
    exit 1
}
expect - warning
expect progress warning -v
expect progress warning --progress
expect - warning -q
expect - warning -q -v
expect - warning -q --progress
expect - - -qq
expect - - -q -q
expect - - --quiet --quiet --progress

# The program's and the subcommand's flags are the same.
"$program" -q render "$fixtures/two.vdb" -o out.exr -q 2>said
[[ ! -s said ]] || { cat said; exit 1; }

# On a terminal there is a bar that is wiped away in the end.
if command -v script >/dev/null; then
    script -qec "'$program' render '$fixtures/two.vdb' -o out.exr --size 8x8" /dev/null >said </dev/null
    grep -q '\[####.* left' said || { echo "no bar"; cat said; exit 1; }
    script -qec "'$program' render '$fixtures/two.vdb' -o out.exr --size 8x8 -q" /dev/null >said </dev/null
    ! grep -q '####' said || { echo "a bar"; exit 1; }
fi

# In the words of a farm's dispatcher.
"$program" render "$fixtures/two.vdb" -o out.exr --size 8x8 -qq 2>said --alf-progress
[[ ! -s said ]] || { cat said; exit 1; }
"$program" render "$fixtures/two.vdb" -o out.exr --size 8x8 --alf-progress 2>said
grep -qx 'ALF_PROGRESS 100%' said || { cat said; exit 1; }
! grep -q '^Progress' said || { cat said; exit 1; }

# A log has it all, whatever is shown; a second run adds to it.
"$program" render "$fixtures/two.vdb" -o out.exr --size 8x8 -qq --log run.log
"$program" render none.vdb -o out.exr -qq --log run.log 2>/dev/null && exit 1
line() { grep -qE "^[0-9-]{10}T[0-9:]{8}Z [0-9]+ $1" run.log || { echo "no line $1"; cat run.log; exit 1; }; }
line 'info deltasplat render .*two.vdb -o out.exr'
line 'warning .*'
line 'info Progress: 100%$'
line 'info end exit_code=0 seconds=[0-9.e-]+ processor_seconds=[0-9.e-]+ peak_bytes=[0-9]+$'
line 'error none.vdb: got no such file'
line 'error end exit_code=3 '
"$program" render "$fixtures/two.vdb" -o out.exr --size 8x8 -qq --log run.json --json-log
[[ $(grep -c '^{"time":".*","process":[0-9]*,"level":".*","text":".*}$' run.json) == $(wc -l <run.json) ]] ||
    { cat run.json; exit 1; }
grep -q '"exit_code":0,' <<<"$(tail -1 run.json)" || { cat run.json; exit 1; }
cp "$fixtures/two.vdb" kept.vdb
for arguments in "--log no/folder.log" "--json-log" "--log kept.vdb"; do
    ! "$program" render "$fixtures/two.vdb" -o other.exr -qq $arguments 2>said || exit 1
    grep -q "^deltasplat: ${arguments%% *}: got " said || { cat said; exit 1; }
done
[[ ! -e other.exr ]]
# Another user's link in a folder that all may write says no more than that of another output does.
mkdir shared
chmod 1777 shared
ln -s ../victim.log shared/own.log
"$program" render "$fixtures/two.vdb" -o out.exr --size 8x8 -qq --log shared/own.log
[[ -s victim.log ]]
rm victim.log
if [[ $EUID == 0 ]]; then
    for target in victim.log run.log; do
        ln -sf ../$target shared/other.log
        chown -h 12345 shared/other.log
        before=$(cat run.log)
        code=0
        "$program" render "$fixtures/two.vdb" -o other.exr -qq --log shared/other.log 2>said || code=$?
        [[ $code == 4 ]] || { echo "got exit code $code; expected 4"; exit 1; }
        grep -q '^deltasplat: --log: got shared/other.log: cannot be written: ' said || { cat said; exit 1; }
        [[ ! -e victim.log && $(cat run.log) == "$before" && ! -e other.exr ]]
    done
fi
! "$program" synth slab run.log --dims 4x4x4 -qq --log run.log 2>said || exit 1
grep -qx 'deltasplat: OUTPUT: got run.log; expected another file than --log' said || { cat said; exit 1; }
cmp kept.vdb "$fixtures/two.vdb"

# Asked by a signal, it says where it is and goes on.
"$program" synth cloud big.vdb --dims 200x200x200 -qq
"$program" render big.vdb -o big.exr --size 3000x3000 --threads 1 -qq --log big.log 2>said &
# Before it runs, the signal would end it.
while [[ ! -s big.log ]] && kill -0 $!; do sleep 0.01; done
while [[ ! -s said ]] && kill -USR1 $! 2>/dev/null; do sleep 0.02; done
wait $!
grep -qE '^deltasplat: [0-9]+% after [0-9]+ s$' said || { cat said; exit 1; }
