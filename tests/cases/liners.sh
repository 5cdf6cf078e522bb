#!/bin/bash
# Solids with shells and membranes that share their nodes: a sandwich bends as theory says, a block with a liner has the
# same bits on any ranks and across a kill, a Gmsh file's surfaces become shells, mistakes are told of.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

# Deflection by bending and shear, with the core's modulus and that of the faces, whose middles are h apart.
run 1 sandwich sandwich
series sandwich
near "how far a sandwich bends" "$(columns 'END { print $at["end.displacement_z_m"] }')" "$(awk 'BEGIN {
    h = 0.02; t = 0.001; length_ = 0.2; core = 1e8; face = 1e9
    bending = h * (core * h^3 / 12 + 2 * face * (t * h^2 / 4 + t^3 / 12))
    for (i = 0; i < 1000; i++) {
        y = h * ((i + 0.5) / 1000 - 0.5)
        first = face * t * h / 2 + core * (h^2 / 4 - y^2) / 2
        shear += first^2 / (core / 2) * h / 1000
    }
    print -length_^3 / 3 / bending - length_ * shear * h / bending^2 }')" 0.02
result "a core between two shells bends as a sandwich"

run 1 one liner
for ranks in 2 3; do
    run $ranks this liner --set testing.repartition_every=40 --set testing.search_every=7
    [ -n "$why" ] || same_run one this
    [ -n "$why" ] || same_snapshots one this
    result "a block with a liner on $ranks ranks, cut anew every 40 steps"
    rm -rf this
done
start 2 killed liner
wait_until_after killed 100
kill_ranks
run 3 killed liner
same_run one killed
result "killed on 2 ranks, resumed on 3"
if /usr/bin/python3 - one << 'END' > seen 2>&1
import glob, sys
import h5py
series = [h5py.File(name)["series"] for name in sorted(glob.glob(sys.argv[1] + "/series/*.h5"))]
last = {name: series[-1][name][-1] for name in series[-1]}
turned = sum(abs(last[name]) for name in last if name.startswith(("kinetic", "elastic", "dissipated", "work")))
strain = h5py.File(sorted(glob.glob(sys.argv[1] + "/checkpoints/*.h5"))[-1])["elements/plastic_strain"][()]
assert abs(last["balance"]) < 3e-3 * turned, last["balance"] / turned
assert (strain[160:240] > 0).all() and not strain[:160].any() and not strain[240:].any()  # the liner alone is of steel
END
then
    result "the liner yields, the block does not"
else
    grep -q "No module named" seen || why=" $(tail -n 1 seen);"
    [ -z "$why" ] && echo "skip what happens: python3-h5py is not installed" || result "the liner yields, the block does not"
fi

# ------------------------------------------------------------------ files
# A cube whose bottom has a shell that goes on beyond it, in a surface of which one facet is no side.
cat > fin.msh << 'END'
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 5 "fin"
3 6 "cube"
$EndPhysicalNames
$Nodes
11
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
9 2 0 0
10 2 1 0
11 9 9 9
$EndNodes
$Elements
3
1 3 2 5 1 1 2 3 4
2 3 2 5 1 2 9 10 3
3 5 2 6 1 1 2 3 4 5 6 7 8
$EndElements
END
cat > fin.yaml << 'END'
title: a cube with a fin
time: {end: 1.0e-3, step: 1.0e-4}
materials:
  soft: {density: 2000, young: 1.0e6, poisson: 0.25}
  hard: {density: 8000, young: 1.0e7, poisson: 0.25}
bodies:
  - name: cube
    material: soft
    model: solid
    mesh: {kind: gmsh, file: fin.msh, group: cube}
    shells: [{set: fin, thickness: 10 mm, material: hard}]
    boundary: [{set: fin, pressure: 1 kPa}]
output: {snapshots: {every: 1.0e-3}}
END
scenes=.
tremie 1 check ./fin.yaml || why+=" is refused;"
says "body      cube: solid, soft, 1 hexahedra, 2 quads, 10 nodes, mass 2160 kg"
says "set fin: 6 nodes, 2 sides, 2 elements"
run 1 fin fin
result "a shell on a cube's side and beyond it, out of a Gmsh file"

# refused TEXT OPTIONS...
refused()
{
    local text=$1
    shift
    tremie 1 check ./fin.yaml "$@" && why+=" $* is taken;"
    says "$text"
}
refused "bodies.0.shells.0.set: there is no set 'fni'; fin is expected" --set bodies.0.shells.0.set=fni
refused "bodies.0.shells.0.thickness is '0'; a length above 0" --set bodies.0.shells.0.thickness=0
refused "bodies.0.shells.0.material: there is no material 'hrad'; 'hard' is expected" --set bodies.0.shells.0.material=hrad
refused "bodies.0.shells.0.model is 'solid'; one of shell, membrane is expected" --set bodies.0.shells.0.model=solid
refused "element 6 at (0.5, 0.5, 0) m has the nodes of element 4; each element once is expected, and one sheet in a place" --set "bodies.0.shells=[{set: fin, thickness: 1 mm}, {set: bottom_, thickness: 1 mm}]" \
    --set "bodies.0.sets=[{name: bottom_, region: {kind: box, min: [0, 0, 0], max: [1, 1, 0.1]}}]"
refused "bodies.0.boundary.0.fixed_turns holds what does not turn; nodes of a shell are expected" \
    --set bodies.0.shells.0.model=membrane --set "bodies.0.boundary=[{set: fin, fixed_turns: x}]"
result "mistakes"
