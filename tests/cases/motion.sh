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
