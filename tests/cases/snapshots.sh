#!/bin/bash
# timeout: 600
# Snapshots: the same bytes from any number of ranks and across a kill, a trajectory that does
# not know of them, an index that ParaView and h5py find right, and disks that fail.
# shellcheck disable=SC2046,SC2086,SC2102 # options are words
set -uo pipefail
readers=$PWD/tests/cases
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"
cp "$scenes"/{mixed.{yaml,csv},periodic.yaml} .
scenes=.

plain="--set output.snapshots.every=0.005 --set output.snapshots.contacts=true"
packed="$plain --set output.snapshots.compress=lossless --set output.snapshots.precision=single"

# ------------------------------------------------------------------ bits
run 1 without mixed
run 1 plain mixed $plain
same_run without plain
[ ! -e without/snapshots ] || why+=" a run without snapshots has a folder for them;"
result "snapshots change no bit of a run"
run 1 packed mixed $packed
for ranks in 2 3; do
    for kind in plain packed; do
        run $ranks this mixed ${!kind}
        [ -n "$why" ] || same_snapshots $kind this
        result "$kind snapshots on $ranks ranks: the same bytes"
        rm -rf this
    done
done
why=

run 1 periodic periodic $plain
run 3 this periodic $plain
[ -n "$why" ] || same_snapshots periodic this
result "snapshots of a periodic scene on 3 ranks: the same bytes"
rm -rf this periodic

# 20000 spheres are several pieces, which ranks share unevenly.
cat > many.yaml << 'END'
title: many
time: {end: 2.0e-4, step: 1.0e-4}
materials: {ore: {density: 2500, young: 1.0e8, poisson: 0.2}}
contact: {pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.5}]}
spheres:
  - name: heap
    material: ore
    radius: 0.05
    velocity: [0.1, 0.2, 0.3]
    packing: {kind: lattice, count: 20000, spacing: 0.1, corner: [0, 0, 0], size: [3, 3]}
output: {snapshots: {every: 2.0e-4, fields: [], compress: lossless}}
END
run 1 many many
run 3 this many
[ -n "$why" ] || same_snapshots many this
result "packed pieces on 3 ranks: the same bytes"
rm -rf many this

# ------------------------------------------------------------------ killed and resumed
# As if killed after step 479: later snapshots are there, a half-written one too.
run 3 killed mixed $plain --set checkpoint.every.steps=170
rm killed/checkpoints/step_00000000{0510,0680,0850,1000}.h5
: > killed/snapshots/.step_000000000550.h5.part
run 2 killed mixed $plain --set checkpoint.every.steps=170
says "resumes at step 340 "
same_snapshots plain killed
[ -e killed/set_aside_1/snapshots/step_000000000350.h5 ] || why+=" later ones were not set aside;"
[ -z "$(find killed/snapshots -name '.*.part')" ] || why+=" a half-written one is left;"
result "resumed on 2 ranks: the same bytes, each time once"

# Killed indeed: the index describes whole files, in the midst and afterwards.
rm -rf killed
mpirun --oversubscribe --bind-to none -q -n 3 "$bin/tremie" run mixed.yaml --out killed $plain \
    --set checkpoint.every.steps=100 --set testing.search_every=1 > said 2>&1 < /dev/null &
job=$!
for ((tries = 0; tries < 3000; tries++)); do
    [ ! -e killed/snapshots/step_000000000250.h5 ] || break
    sleep 0.02
done
kill -KILL $(pgrep -P $job) $job 2> /dev/null
wait $job 2> /dev/null || true
/usr/bin/python3 "$readers/snapshots_index.py" killed || why+=" the index of the killed run is wrong;"
run 2 killed mixed $plain --set checkpoint.every.steps=100
same_snapshots plain killed
result "killed on 3 ranks, resumed on 2: the same bytes"
rm -rf killed

# What is recorded may change on a resume; what was there stays in the index.
run 2 changed mixed $plain --set time.end=0.05
run 2 changed mixed --set output.snapshots.every=0.01 --set "output.snapshots.fields=[mass]"
/usr/bin/python3 "$readers/snapshots_index.py" changed $(seq 0 50 500) $(seq 600 100 1000) ||
    why+=" the index is wrong;"
result "other fields and times from a resume on"
run 2 changed mixed --set time.end=0.12
/usr/bin/python3 "$readers/snapshots_index.py" changed $(seq 0 50 500) $(seq 600 100 1000) ||
    why+=" the index is wrong;"
result "no more snapshots from a resume on"
rm -rf changed

# ------------------------------------------------------------------ read back
cat > collide.yaml << 'END'
title: two clouds that meet
time: {end: 0.02, step: 1.0e-4}
gravity: [0, 0, 0]
materials: {ore: {density: 2500, young: 1.0e8, poisson: 0.2}}
contact: {pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.5}]}
spheres:
  - {name: left, material: ore, radius: 0.05, velocity: [3, 0, 0],
     packing: {kind: lattice, count: 60, spacing: 0.101, corner: [0, 0, 0], size: [0.45, 0.45]}}
  - {name: right, material: ore, radius: 0.04, velocity: [-3, 1, 0],
     packing: {kind: lattice, count: 60, spacing: 0.081, corner: [0.45, 0.02, 0], size: [0.45, 0.45]}}
checkpoint: {every: {wall: 0}}
watch: {overlap: 0.5}
output:
  snapshots: {every: 0.002, contacts: true, fields: [velocity, angular_velocity, force, torque, mass, material,
              group, dissipated_friction, dissipated_damping]}
END
run 2 collide collide
result "a run with all fields"
if /usr/bin/python3 -c 'import h5py' 2> /dev/null; then
    /usr/bin/python3 "$readers/snapshots_h5py.py" plain packed collide
else
    echo "skip h5py: python3-h5py is not installed"
fi
if command -v pvpython > pvpython && [ "${FLAVOUR:-release}" = release ]; then
    timeout 120 pvpython "$readers/snapshots_paraview.py" plain packed 2> said || tail -n 5 said
else
    echo "skip ParaView: pvpython is not installed"
fi

# ------------------------------------------------------------------ tools
"$bin/tremie-info" packed/snapshots/step_000000000500.h5 > said 2>&1 || why+=" status $?;"
says "spheres             172"
says "body trough         8 triangles of steel, as at step 0"
result "tremie-info shows a snapshot"
cp plain/snapshots/step_000000000050.h5 damaged.h5
printf 'xx' | dd of=damaged.h5 bs=1 seek=$(($(stat -c %s damaged.h5) / 2)) conv=notrunc 2> /dev/null
"$bin/tremie-info" damaged.h5 > said 2>&1 && why+=" a damaged one passes;"
result "tremie-info finds a damaged snapshot"
"$bin/tremie-render" plain/snapshots/step_000000001000.h5 -o snapshot.png --color group > said 2>&1 ||
    why+=" a snapshot: status $?;"
says "149 spheres at 0.1 s"
result "tremie-render draws a snapshot"

# ------------------------------------------------------------------ disks that fail
mkdir blocked && : > blocked/snapshots
tremie 2 run mixed.yaml --out blocked $plain
status=$?
[ $status = 2 ] || why+=" status $status, not 2;"
says "blocked/snapshots is no folder of its own; "
result "a folder that is a file"

mkdir small
for kind in plain packed; do
    if ! mount -t tmpfs -o size=450k tmpfs small 2> /dev/null; then
        echo "skip full disk: mounting is not allowed here"
        break
    fi
    trap 'umount small 2> /dev/null' EXIT
    tremie 3 run mixed.yaml --out small/run ${!kind} --set checkpoint.every.steps=170
    status=$?
    [ $status = 4 ] || why+=" status $status, not 4;"
    says "No space left on device; "
    [ -z "$(find small/run -name '.*.part')" ] || why+=" a half-written file is left;"
    /usr/bin/python3 "$readers/snapshots_index.py" small/run || why+=" the index is wrong;"
    mount -o remount,size=8m small
    run 2 small/run mixed ${!kind} --set checkpoint.every.steps=170
    same_snapshots $kind small/run
    result "$kind snapshots on a full disk; with room again the same bytes"
    umount small
done
