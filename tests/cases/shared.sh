#!/bin/bash
# timeout: 900
# Solids that several ranks share have the bits of the job: their nodes go from rank to rank with what
# they and their elements remember, facets much larger and much smaller than spheres are there where
# spheres may touch them, also past a periodic boundary; and their elements are shared out evenly.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"
python=/usr/bin/python3

# of RUN WHAT: what a Python expression says of the run must be true.
of()
{
    [ -n "$h5py" ] || return
    "$python" - "$1" "$2" << 'END' > seen 2>&1
import glob, sys
import h5py
tables = [h5py.File(name)["runtime"] for name in sorted(glob.glob(sys.argv[1] + "/series/*.h5"))]
state = [h5py.File(name) for name in sorted(glob.glob(sys.argv[1] + "/checkpoints/*.h5"))]
def total(column): return sum(table[column][()].sum() for table in tables)
def last(column): return tables[-1][column][-1]
assert eval(sys.argv[2]), sys.argv[2]
END
    [ ! -s seen ] || why+=" $(tail -n 1 seen);"
}
h5py=yes
"$python" -c "import h5py" 2> /dev/null || h5py=
[ -n "$h5py" ] || echo "skip what happens: python3-h5py is not installed"

run 1 one shared
of one '{0, 1, 2} <= set(state[-1]["facet_contacts/body"][()])'
of one '(state[-1]["elements/plastic_strain"][()] > 0).sum() > 500'
result "spheres roll and strike on three solids, which yield"

run 8 eight shared
same_run one eight
of eight 'total("nodes_migrated") - tables[0]["nodes_migrated"][0] > 500' # after the first distribution
of eight '0 < total("nodes_told") / total("steps") < 0.2 * len(state[-1]["nodes/id"]) * 64 * 7'
result "on 8 ranks, nodes change rank, few of them are told of"
rm -r eight
like one 4 "slices across the periodic boundary, on 4 ranks" shared --set decomposition.grid=[4,1,1]
like one 3 "cut anew every 40 steps, on 3 ranks" shared --set testing.repartition_every=40 \
    --set testing.search_every=9

start 2 killed shared
wait_until_after killed 250
kill_ranks
run 5 killed shared
says "resumes at step"
same_run one killed
result "killed on 2 ranks, resumed on 5"
rm -r killed

# Few spheres beside many elements: what ranks have to do with these is much the same.
run 4 even shared --set "bodies.1.mesh.cells=[60, 40, 4]" --set time.end=0.0005 --set time.step=1e-5 \
    --set spheres.0.packing.count=12
of even 'last("elements.max") < 1.2 * last("elements.mean") and last("nodes.max") < 1.2 * last("nodes.mean")'
result "many elements beside few spheres, on 4 ranks"
