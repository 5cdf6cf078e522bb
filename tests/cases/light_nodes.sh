#!/bin/bash
# Light things between stiff ones: nodes at the end of a rod that strikes, and a free plate that is struck.  Within what
# their springs allow of the step they rebound as they should; beyond it the run names the node at the step at which it
# touches, whenever that is, and keeps what was saved before.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

# named RANKS OUT SCENE STEP TEXT OPTIONS...: a run that ends with status 3 at that step, saying TEXT; what is saved is older.
named()
{
    local ranks=$1 out=$2 scene=$3 step=$4 text=$5 status=0
    shift 5
    tremie "$ranks" run "$scenes/$scene.yaml" --out "$out" "$@" || status=$?
    [ "$status" = 3 ] || why+=" $out ends with status $status;"
    says "error: step too large at step $step "
    says "$text"
    says "set time.step to"
    [ "$(newest "$out")" -gt 0 ] && [ "$(newest "$out")" -lt "$step" ] || why+=" its newest checkpoint is $(newest "$out");"
    grep '^error' said > "$out.error"
}

# rebound RUN: the rod's mean speed at the end, from the impulse on its 1e-5 kg.
rebound()
{
    series "$1"
    columns '{ sum += $at["rod.force_x_N"] } END { print 1 + sum * 0.8e-6 / 1e-5 }'
}

# grows RUN: the largest kinetic energy over that of the start.
grows()
{
    series "$1"
    columns '{ k = $at["kinetic_translation_J"]; most = k > most ? k : most } END { print most / 5e-6 }'
}

# Ten masses and springs that meet a spring gamma leave with -0.9951 (gamma 0.5) and -0.9877 (1), which is the elastic
# impact less what goes on ringing; at .8 h/c the phase of the first touch makes up to 0.01 of difference.
run 1 half light_node --set contact.pairs.0.stiffness=0.5e6
near "gamma 0.5: the speed after" "$(rebound half)" -0.9951 0.012
near "and the largest energy" "$(grows half)" 1 0.003
run 1 one light_node
near "gamma 1: the speed after" "$(rebound one)" -0.9877 0.012
near "and the largest energy" "$(grows one)" 1 0.003
run 3 three light_node
same_run one three
result "springs within the bound: it rebounds"
# The bound is 1 / sqrt(1 + gamma / 2) of h/c.
named 1 two light_node 8 "of the critical step there with its contacts, 7.071e-07 s" --set contact.pairs.0.stiffness=2e6
says "node 11 of body 'rod' at ("
named 1 ten light_node 8 "of the critical step there with its contacts, 4.082e-07 s" --set contact.pairs.0.stiffness=10e6
named 3 on_three light_node 8 "4.082e-07 s" --set contact.pairs.0.stiffness=10e6
diff ten.error on_three.error > compared || why+=" 3 ranks say something else;"
result "springs beyond it are named as they touch, with nothing sampled between"
# That is no false alarm: the rod would leave with a multiple of its energy, as the same masses and springs do in leapfrog.
lax=(--set watch.step=1000 --set watch.energy=0)
run 1 two_lax light_node --set contact.pairs.0.stiffness=2e6 "${lax[@]}"
run 1 ten_lax light_node --set contact.pairs.0.stiffness=10e6 "${lax[@]}"
near "gamma 2: the speed after" "$(rebound two_lax)" -1.2541 0.005
near "gamma 10: the speed after" "$(rebound ten_lax)" -2.4112 0.005
result "without the watch they gain"
tremie 1 check "$scenes/light_node.yaml" --set contact.pairs.0.stiffness=10e6
says "with contacts of spheres, most on node 1 of element 1"
says "the step is 3.67 of it"
result "check expects it"

# With balls of its own the end's spring is 3 s E A / h, as its nodes stand for a share of the sides as well, two thirds of
# it on the last nodes and one on those before: ten masses and springs leave with -0.9574.
run 1 soft_end light_end
near "the speed after" "$(rebound soft_end)" -0.9574 0.012
near "and the largest energy" "$(grows soft_end)" 1 0.003
named 1 stiff_end light_end 8 "node 11 of body 'rod' at (" --set bodies.0.touches.stiffness=2
says "warning: body 'rod': time.step is about"
says "allows as it touches bodies; the run stops there if it is too much"
named 1 stiffer_end light_end 8 "with its contacts, 3.015e-07 s" --set bodies.0.touches.stiffness=10
result "the end's own springs"
run 1 end_auto light_end --set bodies.0.touches.stiffness=10 --set time.step=auto --set checkpoint.every.steps=200
near "the largest energy" "$(grows end_auto)" 1 0.003
result "step: auto bears them"

# 81 springs of 5.25e8 N/m on 1.5 g.  They touch between two looks at all contacts.
named 1 plate free_plate 102 "node 1 of body 'block' at ("
named 3 plates free_plate 102 "node 1 of body 'block' at ("
diff plate.error plates.error > compared || why+=" 3 ranks say something else;"
result "a free plate, struck with a step that is too large"
# The bound: the plate yields like the mean of 1/m + r x n I^-1 r x n over the springs, on all of them at once.
run 1 advised free_plate --set time.step="$(sed -n 's/.*set time.step to \([^ ]*\) s.*/\1/p' plate.error)" --set time.end=149.4us \
    --set output.series.every=8.3us
series advised
near "what is found of the energy" "$(columns '{ off = $at["balance_J"] ^ 2; worst = off > worst ? off : worst } END { print 1 + sqrt(worst) / 0.2512 }')" 1 2e-4
result "with the step that is advised"
run 1 plate_auto free_plate --set time.step=auto
series plate_auto
near "what is found of the energy" "$(columns '{ off = $at["balance_J"] ^ 2; worst = off > worst ? off : worst } END { print 1 + sqrt(worst) / 0.2512 }')" 1 2e-4
result "and with auto"
