#!/bin/bash
# Bodies that deform and touch bodies: what comes of it against theory, the same bits whatever the number of ranks and
# however often a run was killed.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

# columns RUN PROGRAM: awk over the run's series; at["NAME"] is the place of a column.
columns()
{
    "$bin/tremie-info" "$1" --csv "$1.csv" > said 2>&1 || why+=" tremie-info ends with status $?;"
    awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }'" $2" "$1.csv"
}

# near WHAT VALUE EXPECTED TOLERANCE: it is, within the tolerance.
near()
{
    awk -v value="$2" -v expected="$3" -v off="$4" \
        'BEGIN { exit !(value != "" && value >= expected - off && value <= expected + off) }' ||
        why+=" $1 is $2, not $3 within $4;"
}

# balanced RUN SHARE COLUMN: no more energy is lost or found than that share of the column's greatest value.
balanced()
{
    near "what is lost or found of the energy" "$(columns "$1" '{
        off = $at["balance_J"] ^ 2; worst = off > worst ? off : worst
        all = $at["'"$3"'"] > all ? $at["'"$3"'"] : all
    } END { print (all > 0 ? sqrt(worst) / all : 1) }')" 0 "$2"
}

# alike SCENE RANKS...: the scene on other numbers of ranks, and with searches at other steps.
alike()
{
    local scene=$1 n
    shift
    for n in "$@"; do
        run "$n" "$scene-$n" "$scene"
        same_run "$scene" "$scene-$n"
    done
    run 1 "$scene-v2" "$scene" --isa v2
    same_run "$scene" "$scene-v2"
    run 2 "$scene-forced" "$scene" --set testing.search_every=7 --set testing.repartition_every=50
    same_run "$scene" "$scene-forced"
}

# Bars of 0.0785 kg at 1 m/s and -1 m/s: each stops at rho c v A = 4060 N, for 2 L / c = 38.7 us and what the springs
# between them take, and leaves as fast as it came.
run 1 bars bars
near "the force between bars" "$(columns bars \
    '$at["time_s"] > 9.5e-6 && $at["time_s"] < 36.5e-6 { sum += $at["left.force_x_N"]; n++ } END { print sum / n }')" -4060 80
near "their impulse" "$(columns bars '{ sum += $at["left.force_x_N"] * 1e-6 } END { print sum }')" -0.157 0.002
near "what both feel together" "$(columns bars '{ sum = $at["left.force_x_N"] + $at["right.force_x_N"]
    worst = sum * sum > worst * worst ? sum : worst } END { print worst + 0 }')" 0 1e-9
balanced bars 1e-3 kinetic_translation_J
result "two bars meet"
alike bars 2 3 5 8
result "on other ranks"
start 2 killed bars
wait_until_after killed 300
kill_ranks
run 3 killed bars
says "resumes at step"
same_run bars killed
result "killed on 2 ranks, resumed on 3"

# Friction of 0.3 stops both blocks from 0.316 m/s in 0.1075 s: it takes their kinetic energy of 29.9 mJ.  Then they
# stay where they are and press on what is below with their weights, 5.87 N and 1.55 N.
run 1 slide slide
near "what is left of the motion at 0.09 s" "$(columns slide \
    '$at["time_s"] > 0.0895 && n++ == 0 { print $at["kinetic_translation_J"] / 0.02992 }')" "$(awk 'BEGIN { print (1 - 0.09 / 0.10746) ^ 2 }')" 0.01
near "and at 0.2 s" "$(columns slide 'END { print $at["kinetic_translation_J"] / 0.02992 }')" 0 1e-4
near "the force on the ground" "$(columns slide \
    '$at["time_s"] > 0.1501 { sum += $at["ground.force_z_N"]; n++ } END { print sum / n }')" -5.8665 0.02
near "the force on the upper block" "$(columns slide \
    '$at["time_s"] > 0.1501 { sum += $at["upper.force_z_N"]; n++ } END { print sum / n }')" 1.5540 0.02
balanced slide 1e-4 dissipated_friction_J
result "blocks slide and stop"
alike slide 3
result "the same on 3 ranks"
# With friction that never slides memory is all that holds: a run in two pieces must be the run.
sticky=(--set contact.pairs.0.friction=10 --set contact.pairs.1.friction=10 --set time.step=10us --set time.end=0.04
    --set checkpoint.every.steps=2000)
run 1 sticky slide "${sticky[@]}"
run 2 pieces slide "${sticky[@]}" --set time.end=0.02
run 3 pieces slide "${sticky[@]}"
says "resumes at step"
same_run sticky pieces
result "friction of 10, in two pieces on 2 and 3 ranks"

# Tips of tetrahedra have nothing deeper in; they touch all the same.
run 1 tip tip
near "the depth of the corner" "$(columns tip '{ way = $at["tip.displacement_z_m"]
    least = way < least ? way : least } END { print least }')" -0.0027 0.0004
near "the speed after it" "$(columns tip 'END { print $at["all.velocity_z_m_s"] }')" 1 0.02
balanced tip 1e-3 kinetic_translation_J
result "the tip of a tetrahedron"

# Bodies that are in each other at the start are named.
status=0
tremie 2 run "$scenes/bars.yaml" --out inside --set bodies.1.mesh.min.0=-0.5mm || status=$?
[ "$status" = 3 ] || why+=" ends with status $status;"
says "m in body"
says "at the start; move them apart"
result "bodies in each other"

# A spring that is too stiff for its nodes is named, not left to blow up.
status=0
tremie 2 run "$scenes/bars.yaml" --out stiff --set bodies.0.touches.stiffness=50 || status=$?
[ "$status" = 3 ] || why+=" ends with status $status;"
says "step too large at step"
says "of body 'right' at ("
says "there with its contacts"
result "a contact too stiff for the step"

# The tube's wall meets itself when the blocks are 8 mm apart, and takes up what they press it with.
run 1 squeeze squeeze
near "the work at 0.115 s" "$(columns squeeze '$at["time_s"] > 0.1145 && n++ == 0 { print $at["work_bodies_J"] }')" 0.0422 0.003
balanced squeeze 5e-3 work_bodies_J
alike squeeze 3
result "a tube meets itself"
tremie 2 run "$scenes/squeeze.yaml" --out deeper --set time.end=0.12
[ $? = 3 ] || why+=" does not end with status 3;"
says "of body 'tube'"
says "its contact reaches"
result "pressed too deep"
