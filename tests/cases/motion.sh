#!/bin/bash
# Bodies' motion in whole runs: paths from files, gravity from a table, and what goes wrong with
# bodies that come and go or that forces move.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

# fails RANKS SCENE TEXT OPTIONS...: the run stops as unstable and says this.
fails()
{
    local ranks=$1 scene=$2 text=$3 status=0
    shift 3
    tremie "$ranks" run "$scene" --out failed --fresh "$@" || status=$?
    [ "$status" = 3 ] || why+=" status $status, not 3;"
    says "$text"
}

# ------------------------------------------------------------------ a path from a file
cp "$scenes/plug.yaml" inline.yaml
cat >> inline.yaml << END
title: path
END
sed -i '/^title: plug/d' inline.yaml
cp inline.yaml file.yaml
path='motion: {path: {axis: [0, 0, 1], '
points='points: [{time: 0.01}, {time: 0.02, place: [0, 0.004, 1 mm], angle: 0.3}, {time: 0.05}]}}'
sed -i "s|active: \[0, 0.03\]|$path$points|" inline.yaml
sed -i "s|active: \[0, 0.03\]|${path}file: path.csv}}|" file.yaml
printf 'y_m, t_s, z_m, angle_rad, by\n0,0.01,0,0,me\n0.004,0.02,0.001,0.3,me\n\n0,0.05,0,0,me\n' \
    > path.csv
scenes=.
run 1 inline inline
run 2 file file
equal inline file
equal {inline,file}/checkpoints/step_000000000600.h5
result "a path from a file is that of the job"
rm path.csv
tremie 1 run file.yaml --out file --restart file/checkpoints/step_000000000600.h5 && \
    why+=" a run without its file begins;"
says "path.csv:1:1: cannot be read: No such file or directory; a CSV file of a path is expected"
result "a path's file that has gone is named"
rm -rf inline file

# ------------------------------------------------------------------ gravity from a table
scenes=$OLDPWD/tests/cases/scenes # the shared ones again
run 1 given plug
run 2 table plug --set 'gravity_table=[{time: 0, gravity: [0, 0, -9.81]}, {time: 1, gravity: [0, 0, -9.81]}]'
equal {given,table}/checkpoints/step_000000000600.h5
result "a table of one gravity is that gravity"
rm -rf given table

# ------------------------------------------------------------------ what a body carries
cat > cup.yaml << 'END'
time: {end: 1.2, step: 1.0e-4}
materials:
  ore: {density: 2500, young: 5.0e+7, poisson: 0.25}
contact:
  pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.5}]
spheres:
  - {name: load, material: ore, radius: 0.02, packing: {kind: lattice, count: 8, spacing: 0.0402, corner: [-0.17, -0.02, 0], size: [0.34, 0.0402]}}
bodies:
  - name: cup
    material: ore
    geometry: {kind: box, open: top, min: [-0.2, -0.05, 0], max: [0.2, 0.05, 0.1]}
    motion: {path: {axis: [0, 0, 1], points: [{time: 0.1}, {time: 0.2, place: [0, 0, 0.025], angle: 0.08}, {time: 1.1, place: [0.3, 0, 0.5], angle: 1.57}]}}
contents:
  - {name: cargo, follows: cup, region: {kind: box, min: [-0.2, -0.05, 0], max: [0.2, 0.05, 0.1]}}
  - {name: there, region: {kind: box, min: [0.1, -0.05, 0.5], max: [0.5, 0.05, 0.6]}}
domain: {min: [-1, -1, -1], max: [1, 1, 1]}
checkpoint: {every: {wall: 0}}
END
scenes=.
run 2 cup cup
series cup
near "what is in the cup, whenever it was counted" "$(columns '
    { least = least == "" || $at["cargo.count"] < least ? $at["cargo.count"] : least } END { print least }')" 8 0
near "what is in its box, had it not turned" "$(columns 'END { print $at["there.count"] < 6 }')" 1 0
near "the work that lifts it" "$(columns 'END { print $at["cup.work_J"] }')" \
    "$(awk 'BEGIN { print 8 * 2500 * 4 / 3 * 3.14159265 * 0.02^3 * 9.81 * 0.5 }')" 0.1
near "that work, of all that moves" "$(columns 'END { print $at["cup.work_J"] / $at["work_bodies_J"] }')" 1 0
tremie 1 check cup.yaml --set contents.0.follows=spoon
says "contents.0.follows names 'spoon', which is no rigid body, nor one of which a set follows a motion; the name of one is expected"
result "what a body carries is counted as it goes"
rm -rf cup
scenes=$OLDPWD/tests/cases/scenes

# ------------------------------------------------------------------ failures
fails 2 "$scenes/plug.yaml" "body 'plug' appeared where spheres are, at step 201 (0.0201 s): sphere " \
    --set 'bodies.1.active=[0.02, 1]' --set 'bodies.1.geometry.point=[0, 0, 0.125]'
result "a plug that appears in spheres is named"

piston='{kind: slide, axis: [0, 0, 1], mass: 0.0002, force: 0.01, travel: [0, 0.1]}'
fails 2 "$scenes/plug.yaml" "step too large at step 257 (0.0257 s): time.step = 0.0001 s is " \
    --set bodies.1.active='[0, 1]' --set "bodies.1.driven=$piston" --set watch.energy=0
result "a piston too light for the step"

piston='{kind: slide, axis: [0, 0, 1], mass: 0.1, force: 2 kN}'
fails 3 "$scenes/plug.yaml" "motion too fast at step 11 (0.0011 s): body 'plug' moves 0.11 of the least radius in a step" \
    --set "bodies.1.driven=$piston" --set 'bodies.1.geometry.point=[0, 0, 0.5]'
result "a piston that becomes too fast is named"

fails 3 "$scenes/plug.yaml" "motion too fast at step 0 (0 s): body 'plug' moves 0.25" \
    --set 'bodies.1.motion=[{velocity: [0, 0, 30]}, {oscillation: {direction: [0, 0, 1], amplitude: 0.01, frequency: 318.3}, start: 0.05}]'
result "motions that will be too fast are named before the first step"

fails 3 "$scenes/plug.yaml" "motion too fast at step 0 (0 s): the surface of body 'plug' moves 0.25" \
    --set 'bodies.1.surface={velocity: [0, 30, 40]}'
result "a surface that will run too fast is named before the first step"
