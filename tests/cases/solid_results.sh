#!/bin/bash
# What series and snapshots tell of deformable bodies: known states of blocks at rest, the same bytes on
# any number of ranks and across a kill, files that h5py and ParaView read, profiles over depth.
# shellcheck disable=SC2086 # options are words
set -uo pipefail
readers=$PWD/tests/cases
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"
cp "$scenes"/{solid_results,deform}.yaml .
scenes=.

# last COLUMN: its value in the last row of series.csv.
last() { columns 'END { print $at[column] }' -v column="$1"; }
# small COLUMN MOST: the last value is no larger either way.
small() { awk -v value="$(last "$1")" -v most="$2" 'BEGIN { exit !(value <= most && value >= -most) }' || why+=" $1 is not within $2 of 0;"; }

# ------------------------------------------------------------------ under weight
run 1 heavy solid_results
series heavy
near "what bears the block's weight" "$(last block.z_min.reaction_z_N)" 19.62 1e-9
small block.z_min.reaction_x_N 1e-9
near "what bears the plate and the ball" "$(last plate.bottom.reaction_z_N)" 32.1131363 1e-8
near "the ball on the plate" "$(last plate.force_z_N)" -0.328736255 1e-8
near "its torque about the origin" "$(last plate.torque_y_N_m)" 0.328736255 1e-8
result "supports bear the weight of blocks and of a ball on one"

# ------------------------------------------------------------------ without
run 1 light solid_results --set gravity=[0,0,0]
series light
# 1 kPa make the bar longer by exp(s / E) and thinner by exp(-nu s / E).
near "what holds the pulled bar" "$(last pulled.x_min.reaction_x_N)" -2.49875031 1e-7
near "its stress" "$(last pulled_all.stress_xx_Pa)" 1000 1e-7
near "its greatest equivalent stress" "$(last pulled_all.von_mises_max_Pa)" 1000 1e-5
near "the way of its end" "$(last pulled_end.displacement_x_m)" 2.0010003e-4 1e-6
near "how it contracts" "$(last pulled_end.displacement_y_m)" -6.249219e-6 1e-5
small pulled_all.stress_yy_Pa 1e-4
small pulled_end.velocity_x_m_s 1e-9
near "what draws the drawn bar" "$(last drawn.x_max.reaction_x_N)" 2.5e-3 1e-5
near "what holds it" "$(last drawn.x_min.reaction_x_N)" -2.5e-3 1e-5
# Half of the force times the way, and what damping takes: 300/s x 1 kg x (4 um/s)^2 / 3 over 50 ms.
near "the work of that" "$(last drawn.x_max.work_x_J)" 3.3e-10 0.02
near "its stress" "$(last drawn_middle.stress_xx_Pa)" 1 1e-5
near "its equivalent stress" "$(last drawn_middle.von_mises_Pa)" 1 1e-5
near "the way of its corner" "$(last drawn_corner.displacement_x_m)" 2e-7 1e-8
near "how it contracts" "$(last drawn_corner.displacement_y_m)" -1.25e-8 1e-4
# Shear modulus 0.4 MPa, shear 1e-6.
near "the stress of the sheared block" "$(last shear.stress_zx_Pa)" 0.4 1e-5
near "its equivalent stress" "$(last shear.von_mises_Pa)" 0.69282032 1e-5
near "what shears it" "$(last sheared.z_max.2.reaction_x_N)" 4e-3 1e-5
near "the work of that" "$(last sheared.z_max.2.work_x_J)" 2e-10 1e-3
result "bars that are pulled and drawn, a block that is sheared"

# ------------------------------------------------------------------ bits
for ranks in 2 3; do
    run $ranks this solid_results
    [ -n "$why" ] || same_run heavy this
    [ -n "$why" ] || same_snapshots heavy this
    result "probes, reactions and snapshots on $ranks ranks: the same bytes"
    rm -rf this
done

fine="--set output.series.every=1.0e-5 --set output.snapshots.every=0.002 --set time.end=0.009"
fine+=" --set checkpoint.every.steps=50 --set output.snapshots.compress=lossless"
run 1 rolling deform $fine
start 2 killed deform $fine
wait_until_after killed 300
kill_ranks
run 3 killed deform $fine
says "resumes at step"
same_run rolling killed
same_snapshots rolling killed
result "killed on 2 ranks, resumed on 3: the same bytes"

# Another probe from a resume on; what was there stays.
run 1 changed solid_results --set time.end=0.02
run 1 changed solid_results --set time.end=0.04 --set "output.probes=[{name: other, body: plate, nodes: top}]"
series changed
near "a probe that came later" "$(last other.displacement_z_m)" "$(columns '$at["step"] == 400 { print $at["other.displacement_z_m"] }')" 0
[ -n "$(last top.displacement_z_m)" ] || why+=" a probe that went is not in the series;"
result "other probes from a resume on"

# ------------------------------------------------------------------ read back
cat > mixed.msh << 'END'
$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
12
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
9 2 0 0
10 3 0 0
11 2 1 0
12 2 0 1
$EndNodes
$Elements
2
1 4 2 1 1 9 10 11 12
2 5 2 1 1 1 2 3 4 5 6 7 8
$EndElements
END
cat > mixed.yaml << 'END'
title: a hexahedron and a tetrahedron
time: {end: 1.0e-3, step: 1.0e-4}
materials: {soft: {density: 2000, young: 1.0e6, poisson: 0.25}}
bodies: [{name: two, material: soft, model: solid, mesh: {kind: gmsh, file: mixed.msh}}]
output: {snapshots: {every: 1.0e-3, precision: single, solids: [stress, plastic_strain]}}
END
run 1 mixed mixed
result "elements of both kinds"
if /usr/bin/python3 -c 'import h5py' 2> /dev/null; then
    /usr/bin/python3 "$readers/solid_results_h5py.py" heavy light rolling mixed
else
    echo "skip h5py: python3-h5py is not installed"
fi
if command -v pvpython > pvpython && [ "${FLAVOUR:-release}" = release ]; then
    timeout 120 pvpython "$readers/solid_results_paraview.py" heavy mixed 2> said || tail -n 5 said
else
    echo "skip ParaView: pvpython is not installed"
fi

# ------------------------------------------------------------------ tools
"$bin/tremie-info" heavy/snapshots/step_000000001400.h5 > said 2>&1 || why+=" status $?;"
says "solid drawn         192 elements, 81 nodes of soft"
result "tremie-info shows solids of a snapshot"
"$bin/tremie-render" heavy/snapshots/step_000000001400.h5 -o snapshot.png > said 2>&1 || why+=" status $?;"
says "1 spheres at 0.14 s"
result "tremie-render draws them"

# A column of height h under its own weight: the stress at depth z is -rho g z, in the mean of a layer.
"$bin/tremie-profile" heavy --body block --slices 4 --csv depth.csv --svg depth.svg > said 2>&1 || why+=" status $?;"
says "block at 0.14 s, depth below z_max"
near "stress at a depth of 12.5 mm" "$(awk -F, 'NR == 2 { print $5 }' depth.csv)" -245.25 1e-3
near "stress at a depth of 87.5 mm" "$(awk -F, 'NR == 5 { print $5 }' depth.csv)" -1716.75 1e-3
grep -q "stress_zz" depth.svg || why+=" the plot has no stress_zz;"
"$bin/tremie-profile" heavy --body drawn --from x_min --slices 3 > said 2>&1 || why+=" status $?;"
says "drawn at 0.14 s, depth below x_min"
"$bin/tremie-profile" heavy > said 2>&1 && why+=" it takes any of several bodies;"
says "there are several deformable bodies; give --body one of block, pulled, drawn, sheared, plate"
"$bin/tremie-profile" heavy/snapshots/step_000000001400.h5 --body block --slices 0 > said 2>&1 && why+=" it makes no slices;"
says "--slices is 0; give a number from 1 to 100000"
result "tremie-profile shows stress over depth"

# ------------------------------------------------------------------ mistakes
# refused TEXT OPTIONS...
refused()
{
    local text=$1
    shift
    tremie 1 check ./solid_results.yaml "$@" && why+=" $* is taken;"
    says "$text"
}
refused "output.probes.0 has no place; one of node, nodes, element, elements is expected" \
    --set "output.probes=[{name: a, body: block}]"
refused "output.probes.0 has several places; " --set "output.probes=[{name: a, body: block, nodes: all, node: [0, 0, 0]}]"
refused "names 'ball', which is no body that deforms" --set "output.probes=[{name: a, body: ball, nodes: all}]"
refused "output.probes.0.nodes: there is no set 'z_mix'; z_min is expected" \
    --set "output.probes=[{name: a, body: block, nodes: z_mix}]"
refused "output.probes.0.elements: set 'z_min' has none; some are expected" \
    --set "output.probes=[{name: a, body: block, elements: z_min}]"
refused "output.probes.0.name is 'block' like that of bodies.0; " \
    --set "output.probes=[{name: block, body: block, nodes: all}]"
result "probes that are refused"
