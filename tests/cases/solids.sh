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
# Steel 8 mm x 0.2 m x 0.2 m; waves of 6001 m/s through cells of 2 mm; a regular polygon of 16 sides.
says "body      plate: solid, steel, 6400 hexahedra, 0 tetrahedra, 8405 nodes, mass 2.512 kg"
says "waves run at 6001 m/s, through 0.002 m of element"
says "critical step about 3.33e-07 s without contacts, the step is 0.6 of it"
says "set side: 800 nodes, 640 sides, 0 elements"
says "volume 0.000122459 m3"
says "body      pipe: solid, steel, 0 hexahedra, 3120 tetrahedra, 1092 nodes"
says "body      column: solid, steel, 2 hexahedra, 0 tetrahedra, 12 nodes, mass 0.0157 kg"
says "set lid: 4 nodes, 1 sides, 0 elements"
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
says "warning: body 'plate': time.step is 1.2 of the critical step of element"
result "a step that waves outrun"
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
