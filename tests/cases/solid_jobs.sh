#!/bin/bash
# Deformable bodies against theory, as jobs of jobs/ show them: what a sphere loses to the bending wave of
# a plate that it strikes, the force that drives a wave into a bar, the beat of a cantilever.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

scenes=$OLDPWD/jobs

# measure NAME JOB OPTIONS...: a run of jobs/JOB.yaml on one rank, and its series in series.csv.
measure()
{
    local name=$1
    shift
    run 1 "$name" "$@"
    series "$name"
}

# balanced SHARE COLUMN: at no time is more energy lost or found than that share of the column's greatest value.
balanced()
{
    columns '{
        off = $at["balance_J"] < 0 ? -$at["balance_J"] : $at["balance_J"]
        worst = off > worst ? off : worst
        all = $at[column] > all ? $at[column] : all
    } END { exit !(all > 0 && worst <= share * all) }' -v share="$1" -v column="$2" ||
        why+=" more than $1 of its energy is lost or found;"
}

# impact SPEED TIME FORCE: after Zener (1941).
impact()
{
    local speed time force
    read -r speed time force <<< "$(columns '{
        push = $at["plate.force_z_N"] < 0 ? -$at["plate.force_z_N"] : $at["plate.force_z_N"]
        touched += push > 0
        greatest = push > greatest ? push : greatest
        speed = $at["ball.velocity_z_m_s"]
    } END { print speed, touched * 0.2e-6, greatest }')"
    near "the speed after the impact" "$speed" "$1" 0.02
    near "the time of contact" "$time" "$2" 0.03
    near "the greatest force" "$force" "$3" 0.03
    balanced 1e-4 kinetic_translation_J
}

measure thick plate_impact --set time.end=90us
impact 0.76828 71.23e-6 1506
result "a sphere on a plate of 10 mm"
measure thin plate_impact --set time.end=90us --set bodies.0.mesh.thickness=8mm --set bodies.0.mesh.corner.2=-8mm
impact 0.66482 72.64e-6 1396
result "a sphere on a plate of 8 mm"

# mean COLUMN FROM TO: of rows between two times.
mean()
{
    columns '$at["time_s"] > from && $at["time_s"] < to { sum += $at[column]; n++ } END { print sum / n }' \
        -v column="$1" -v from="$2" -v to="$3"
}

# As thick as it is wide, the plate is a half-space to the ball: Hertz (Zener's at no inelasticity).  The bending wave's
# 2 per cent are there no more; some tenths of a per cent leave with sound.
measure block plate_impact --set time.end=90us --set bodies.0.mesh.thickness=200mm --set bodies.0.mesh.corner.2=-0.2 \
    --set bodies.0.mesh.cells=[21,21,21] --set "output.probes=[]"
impact 1 69.1e-6 1750
result "a sphere on a block"

measure bar bar_wave
near "the force before the wave is back" "$(mean bar.z_min.reaction_z_N 10e-6 70e-6)" 4060.2 0.001
near "the force after it" "$(mean bar.z_min.reaction_z_N 90e-6 140e-6)" -4060.2 0.005
near "the speed of the free end" "$(mean free.velocity_z_m_s 50e-6 110e-6)" 2 0.005
balanced 1e-4 work_bodies_J
result "a wave in a bar"

# Time between two crossings of the static deflection, upwards.
measure beam cantilever --set time.end=31.2ms
near "what the clamp bears" "$(mean beam.x_min.reaction_z_N 0 24.3e-3)" -100 0.03
near "the stress near it" "$(mean root.stress_xx_Pa 0 24.3e-3)" -3.375e6 0.05
near "the frequency of the beam" "$(columns '{
    if (NR > 2 && last < static && $at["tip.displacement_z_m"] >= static) {
        crossing = time + (static - last) / ($at["tip.displacement_z_m"] - last) * ($at["time_s"] - time)
        if (before != "")
            print 1 / (crossing - before)
        before = crossing
    }
    last = $at["tip.displacement_z_m"]
    time = $at["time_s"]
}' -v static=0.30476e-3)" 41.776 0.02
balanced 1e-6 elastic_J
result "the beat of a cantilever"
