#!/bin/bash
# The measurements of tests/bench, at next to no size: what they write down is of the run they made.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
root=$PWD
. "$(dirname "$0")/common.sh"

if ! /usr/bin/python3 -c 'import h5py' 2> /dev/null; then
    echo "skip bench: python3-h5py is not installed"
    exit 0
fi

# bench WORDS...: spheres that fall for 100 steps.
bench()
{
    BIN=$bin WORK=$PWD/work OUT=$PWD CORE=$core CASE=${case:-fall} STEPS=100 ROUNDS=1 timeout -k 5 $patience \
        "$root/tests/bench/run" "$@" > said 2>&1
}
core=$(taskset -cp $$ | sed 's/.*[ ,-]//') # one that may be used

# of COLUMN FILE: its value in a table's first row.
of()
{
    awk -F, -v column="$1" 'NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k } NR == 2 { print $at[column] }' "$2"
}

RANKS="1 2" bench || why+=" status $?;"
[ "$(wc -l < suite.csv)" = 3 ] || why+=" suite.csv has not two rows;"
# Half of the mass of 8768 spheres times the square of g t; they are at rest half a step before the start.
awk -v energy="$(of kinetic_J suite.csv)" -v rate="$(of rate suite.csv)" -v bytes="$(of bytes_a_sphere suite.csv)" 'BEGIN {
    fall = 8768 * 2367 * 4 / 3 * 3.14159265 * 0.1 ^ 3 / 2 * (9.81 * 1.005e-3) ^ 2
    exit !(energy / fall > 0.999 && energy / fall < 1.001 && rate > 0 && bytes > 100)
}' || why+=" kinetic energy $(of kinetic_J suite.csv) J;"
result "the suite measures a fall"

bench --walls || why+=" status $?;"
[ "$(wc -l < walls.csv)" = 6 ] && [ "$(of over_rigid walls.csv)" = 1 ] && [ "$(of elements walls.csv)" = "" ] ||
    why+=" walls.csv does not begin with rigid walls;"
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "softness") at = i + 1 } # a comma stands in names
    NR > 2 { if (!($at > last && $at < 1)) exit 1; last = $at }' walls.csv || why+=" finer meshes are no softer;"
says "cell: 2.1"
result "walls that deform are measured beside walls that do not"

case=nothing bench && why+=" runs a case that is not there;"
says "expected one of"
result "a case that is not there is named"

if command -v liggghts > work/where && command -v lmp > work/where; then
    LEDGER=off bench --peers || why+=" status $?;"
    [ "$(cut -d , -f 2 peers.csv | tr '\n' ' ')" = "code tremie without ledger liggghts lammps " ] ||
        why+=" peers.csv has other rows;"
    says "kinetic energies by"
    result "peers fall alike"
else
    echo "skip bench beside peers: liggghts and lammps are not installed"
fi
