#!/bin/bash
# What `tremie check` tells of deformable bodies: their size and mass, their elements, the step that
# waves through them allow, what is probably not meant; the same on any number of ranks.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

# checked OPTIONS...: a check of the scene, which is accepted; without mpirun, which mixes what is said
# and what is warned of in the midst of lines.
checked()
{
    { timeout "$patience" "$bin/tremie" check "$scenes/solids.yaml" "$@" 2> warned || why+=" is refused;"; } > said
    cat warned >> said
}

checked
# Steel 8 mm x 0.2 m x 0.2 m; a regular polygon of 16 sides. Waves of c = 6001 m/s through cells of 5 mm x 5 mm x
# h = 2 mm: by (12.11) w^2 = 4 c^2 [nu/(1-nu) (1/h^2 + 2/(5 mm)^2) + (1-2 nu)/(1-nu)/h^2], 2/w = 3.1254e-7 s.
says "body      plate: solid, steel, 6400 hexahedra, 8405 nodes, mass 2.512 kg"
says "waves run at 6001 m/s, fastest through element"
says "critical step 3.125e-07 s without contacts, the step is 0.64 of it"
says "set side: 800 nodes, 640 sides, 0 elements"
says "volume 0.000122459 m3"
says "body      pipe: solid, steel, 3120 tetrahedra, 1092 nodes"
says "body      column: solid, steel, 2 hexahedra, 12 nodes, mass 0.0157 kg"
says "set lid: 4 nodes, 1 sides, 0 elements"
# 10000 steps of 7202 hexahedra, 136 ns each, 3120 tetrahedra, 62 ns each; 340 bytes an element, 370 each of 10488 nodes.
says "cost      1e+04 particle-steps and 1.03e+08 element-steps: of the order of 11.7 s on 1 rank; memory of the order of 7.39 MB"
says "of that solids: 7.39 MB on each rank, 716 bytes an element"
! grep -q '^warning:' said || why+=" warns;"
grep '^body\|^    ' said | sort > one
result "shapes, sets, steps"

timeout "$patience" mpirun --oversubscribe --bind-to none -q -n 3 "$bin/tremie" check "$scenes/solids.yaml" \
    > said 2> warned < /dev/null || why+=" is refused;"
grep '^body\|^    ' said | sort > three
[ -s three ] || why+=" tells nothing;"
diff one three > /dev/null || why+=" tells something else;"
result "the same on 3 ranks"

checked --set time.step=4e-7
says "warning: body 'plate': time.step is 1.28 of the critical step of element"
result "a step that waves outrun"
checked --set "bodies.1.velocity=[0, 0, 200]" # 7850 kg/m3 (200 m/s)^2 / 2 / 400 MPa
says "brought to rest it would flow by about 0.393 in the mean"
result "elements that will be pressed together"
# A copper bar that flows by 0.575: auto takes .7 exp(-2.5 flow), a sixth of what its cells bear at first; .7 is too much.
taylor=(run "$scenes/../../../jobs/taylor_bar.yaml" --set "bodies.0.mesh.cells=[4, 4, 80]" --set time.end=24us
    --set output.snapshots.every=24us --set watch.hourglass=0 --set output.series.every=2us)
timeout "$patience" "$bin/tremie" "${taylor[@]}" --set time.step=auto --out foreseen > said 2>&1 || why+=" auto is stopped;"
grep -q '^  step: 9.9e-09 ' foreseen/job.yaml || why+=" takes $(grep '^  step:' foreseen/job.yaml);"
timeout "$patience" "$bin/tremie" "${taylor[@]}" --set time.step=40ns --out unforeseen > said 2>&1
[ $? = 3 ] || why+=" .7 is not stopped;"
says "error: step too large at step"
says "of body 'bar' at ("
rm -rf foreseen unforeseen
result "auto foresees it"

# stopped STEP: a run of the scene with this step is.
stopped()
{
    timeout "$patience" "$bin/tremie" run "$scenes/solids.yaml" --out stopped --set time.step="$1" --set time.end=3.2us \
        > said 2>&1
    [ $? -eq 3 ] || why+=" is not stopped;"
    rm -rf stopped
}
stopped 3.2e-7
says "time.step = 3.2e-07 s is 1.02 of the critical step there, 3.125e-07 s"
result "a run goes by the same bound"

# A cube of h = 0.1 m and c = 1000 m/s, nu = 0: 4 c^2/h^2 (12.11), with an eigenvalue from above. A sphere's linear spring of 1.5e8 N/m on one corner of
# 1/8 of 1 kg adds 12, its own balls, (2/3 + 1/3) s E 3/4 h a corner, 6, in c^2/h^2.
cube()
{
    timeout "$patience" "$bin/tremie" check "$scenes/cube.yaml" "$@" > said 2>&1 || why+=" is refused;"
}
cube
says "critical step 9.999e-05 s without contacts"
says "with contacts of spheres, most on node 1 of element 1 at (0.05, 0.05, 0.05) m: about 5e-05 s"
cube --set "bodies.0.touches={what: bodies, stiffness: 1}"
says "with contacts of spheres and bodies, most on node 1 of element 1 at (0.05, 0.05, 0.05) m: about 4.26e-05 s"
result "springs on nodes"
# What strikes rigid bodies is m = 4.18879 kg at 1 m/s: F = v sqrt(k m) = 25066 N, v sqrt(m/k) = 1.6711e-4 m deep. A block
# of 0.3 m x 0.3 m x 0.2 m and 1 GPa yields by F (0.3 m)^2 / E V = 1.2533e-4 m; a plate of 2 m x 2 m bends by as much as the
# contact is deep if its thickness^3 = 12 * 0.0056 F (2 m)^2 / E w = (0.3429 m)^3.
cube
says "being rigid neglects about 0.000125 m, 0.75 of the 0.000167 m by which contacts yield: a block under 2.51e+04 N, an impact"
says "contacts yield, 0.000167 m, where a wall of the largest facet is about 0.343 m thick: a plate under 2.51e+04 N, an impact"
# Four spheres weigh 4 m g = 164.4 N, and strike softer than that where k is 100 N/m.
cube --set contact.stiffness=100 --set "gravity=[0, 0, -9.81]" --set spheres.0.packing.count=4 --set "spheres.0.packing.size=[0.2, 0.2]"
says "a block under 164 N, weight of all spheres"
result "what rigid bodies neglect"
cube --set "bodies.0.touches={what: bodies, stiffness: 1}" --set time.step=auto
says "steps of 2.9e-05 s"
result "an automatic step"

for scene in slide solid_results; do
    timeout "$patience" "$bin/tremie" run "$scenes/$scene.yaml" --out auto --set time.step=auto > said 2>&1 ||
        why+=" $scene fails;"
    says "finished at step"
    rm -rf auto
done
result "runs bear the automatic step"
checked --set "bodies.0.mesh.cells=[40, 40, 1]"
says "warning: body 'plate': 1 cell through the thickness: hourglass control bears the bending; 3 or more are better"
result "a plate of one layer"
checked --set "bodies.0.mesh.cells=[40, 2, 4]"
says "m differ by a factor of 50; below 20 is better"
result "elements that are long and thin"
checked --set materials.steel.young=210e3
says "warning: body 'plate': steel yields at 4e+08 Pa, more than a tenth of young; are their units right?"
result "a modulus in MPa"
checked --set materials.steel.density=7.85e-9
says "warning: body 'plate': steel has a density of 7.85e-09 kg/m3, as no solid has; is its unit right?"
says "warning: body 'plate': waves would run at 6e+09 m/s in steel, as in no solid; are the units of density and young right?"
result "a density in t/mm3"
checked --set bodies.3.mesh.scale=10 --set "bodies.3.mesh.move=[20, 0, 0]" --set spheres.0.radius=0.1mm
says "warning: body 'column', column.msh: is 20 m wide, 2e+05 radii of the largest sphere; a file in mm takes scale: 0.001"
result "a file in other units"

# What fails is named with the element and its place, and the last checkpoint stays, which resumes.
status=0
crushed=(--set checkpoint.every.steps=100 --set "bodies.0.boundary=[{set: z_max, pressure_table: [{time: 0, pressure: 0}, {time: 1 ms, pressure: 0}, {time: 1.1 ms, pressure: 1 GPa}]}]")
tremie 2 run "$scenes/dents.yaml" --out crushed "${crushed[@]}" || status=$?
[ "$status" = 3 ] || why+=" ends with status $status;"
says "of body 'one' at ("
says "is turned inside out"
[ -e crushed/checkpoints/step_000000000500.h5 ] || why+=" does not keep the checkpoint before;"
result "an element inside out"
status=0
tremie 2 run "$scenes/dents.yaml" --out folded --set watch.hourglass=0.02 || status=$?
[ "$status" = 3 ] || why+=" ends with status $status;"
says "hourglass modes at step"
says "most in element"
result "energy in hourglass modes"

timeout "$patience" "$bin/tremie" check "$scenes/odd_sheets.yaml" > said 2> warned || why+=" odd sheets are refused;"
says "body      thick: shell, ore, 16 quads, 25 nodes, mass 710.1 kg"
cat warned > said
says "body 'thick': it is 0.3 to 0.3 m thick and 1.41 m large; is the unit of its thickness right?"
says "body 'thick': element 1 at (-0.375, -0.375, -1) m is 1.2 times as thick as wide;"
says "body 'thin': it is 1e-06 to 1e-06 m thick and 1.41 m large; is the unit of its thickness right?"
says "body 'warped': element 1 at (0.5, 0.5, 2.075) m is warped by 0.29 of its width;"
[ "$(wc -l < warned)" = 4 ] || why+=" there are not 4 warnings;"
result "thick, thin and warped sheets"
