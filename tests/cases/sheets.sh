#!/bin/bash
# timeout: 900
# Shells and membranes have the bits of the job: complete states, series and snapshots are equal on any number of
# ranks, for any search, kernel and restart, with spheres on both sides, on rims, and steel that yields; ParaView
# reads their snapshots.
set -uo pipefail
readers=$PWD/tests/cases
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"
python=/usr/bin/python3

# likewise RANKS NAME OPTIONS...: a run with the bits and the snapshots of the one on one rank.
likewise()
{
    local ranks=$1 name=$2
    shift 2
    run "$ranks" this sheets "$@"
    [ -n "$why" ] || same_run one this
    [ -n "$why" ] || same_snapshots one this
    result "$name"
    rm -rf this
}

run 1 one sheets
result "spheres on sheets, on 1 rank"
counts="2 3 5 8"
[ -n "$thorough" ] || counts=3
for ranks in $counts; do
    likewise "$ranks" "on $ranks ranks"
done
likewise 3 "cut anew every 40 steps, on 3 ranks" --set testing.repartition_every=40 --set testing.search_every=9
likewise 1 "all pairs" --set testing.search=all-pairs
for isa in generic v2 v3 v4; do
    if tremie 1 check "$scenes/sheets.yaml" --isa $isa; then
        likewise 1 "kernels of $isa" --isa $isa
    else
        grep -q "isa $isa does not run" said || echo "FAIL kernels of $isa: $(head -n 1 said)"
    fi
done

start 2 killed sheets
wait_until_after killed 250
kill_ranks
run 5 killed sheets
says "resumes at step"
same_run one killed
same_snapshots one killed
result "killed on 2 ranks, resumed on 5"

# What the scene is for must happen in it.
near "the balance" "$(balance one)" 1.5e-4 1
"$python" - one << 'END' > seen 2>&1
import glob, sys
import h5py
series = [h5py.File(name)["series"] for name in sorted(glob.glob(sys.argv[1] + "/series/*.h5"))]
last = {name: series[-1][name][-1] for name in series[-1]}
states = [h5py.File(name) for name in sorted(glob.glob(sys.argv[1] + "/checkpoints/*.h5"))]
strain = states[-1]["elements/plastic_strain"][()]
assert (strain[:300] > 0.0).sum() > 100, "the bin does not yield"  # all elements of the bin come first
assert abs(states[-1]["nodes/angular_velocity"][()]).max() > 1.0
shown = h5py.File(sys.argv[1] + "/snapshots/step_000000001000.h5")["solids"]
thickness = [thick for name in ("bin", "cloth", "blade") for thick in shown[name]["elements/thickness"][()]]
before = states[-1]["elements/thickness"][()]  # snapshots show the step's own strain as well
assert abs(thickness - before).max() < 1e-3 * before.min(), "snapshots show another thickness than checkpoints"
assert min(thickness[:300]) < 0.99 * 0.004, "the bin's steel, 4 and 6 mm thick, does not thin"
touched = set().union(*(set(state["facet_contacts/body"][()]) for state in states))
assert touched == {0, 1, 2}, f"only bodies {touched} are touched"
assert last["bin.force_x"] != 0.0 and abs(last["blade.top.work"]) > 1.0
END
if grep -q "No module named" seen; then
    echo "skip what happens: python3-h5py is not installed"
else
    [ ! -s seen ] || why+=" $(tail -n 1 seen);"
    result "spheres on all sheets, plastic flow, the balance of energy"
fi

# Substeps cost accuracy, and how much (THEORY.md 12.4).
run 1 five sheets --set time.substeps=5
near "the balance of five substeps" "$(balance five)" 0.75e-3 1
"$python" - one five << 'END' > seen 2>&1
import sys
import h5py
import numpy as np
one, five = (h5py.File(run + "/snapshots/step_000000001000.h5")["solids"] for run in sys.argv[1:])
for name in one:
    a, b = one[name]["nodes/displacement"][()], five[name]["nodes/displacement"][()]
    assert 0 < np.linalg.norm(b - a) < 0.006 * np.linalg.norm(a), name
END
if grep -q "No module named" seen; then
    echo "skip substeps: python3-h5py is not installed"
else
    [ ! -s seen ] || why+=" $(tail -n 1 seen);"
    result "five substeps move bodies as one does within 0.6 %, the balance within 0.15 %"
fi
rm -rf five
if command -v pvpython > pvpython && [ "${FLAVOUR:-release}" = release ]; then
    timeout 120 pvpython "$readers/sheets_paraview.py" one 2> said || tail -n 5 said
else
    echo "skip ParaView: pvpython is not installed"
fi

"$bin/tremie-info" one/snapshots/step_000000001000.h5 > said 2>&1 || why+=" tremie-info ends with status $?;"
says "solid cloth         324 elements, 181 nodes of cloth"
"$bin/tremie-render" one/snapshots/step_000000001000.h5 -o snapshot.png > said 2>&1 || why+=" tremie-render ends with status $?;"
"$bin/tremie-profile" one --body cloth --from x_min --slices 2 --csv cloth.csv > said 2>&1 || why+=" tremie-profile ends with status $?;"
awk -F, 'NR > 1 { n += $2; bad += !($3 > 0) } END { exit !(n == 324 && bad == 0) }' cloth.csv || why+=" the cloth is not stretched;"
result "tools read them"
