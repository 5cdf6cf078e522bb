#!/bin/bash
# Deformable bodies against theory, as jobs of jobs/ show them: what a sphere loses to the bending wave of
# a plate that it strikes, the force that drives a wave into a bar, the beat of a cantilever.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

scenes=$OLDPWD/jobs

# series NAME JOB OPTIONS...: a run, and its series in series.csv.
series()
{
    local name=$1 job=$2
    shift 2
    run 1 "$name" "$job" "$@"
    "$bin/tremie-info" "$name" --csv series.csv > said 2>&1 || why+=" tremie-info ends with status $?;"
}

# near WHAT VALUE EXPECTED SHARE: it is, within that share of it.
near()
{
    awk -v value="$2" -v expected="$3" -v share="$4" 'BEGIN {
        size = expected < 0 ? -expected : expected
        exit !(value != "" && value >= expected - share * size && value <= expected + share * size)
    }' || why+=" $1 is $2, not $3 within $4 of it;"
}

# columns PROGRAM OPTIONS...: awk over the series; at["NAME"] is the place of a column.
columns()
{
    local program=$1
    shift
    awk -F, "$@" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }'" $program" series.csv
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

series thick plate_impact --set time.end=90us
impact 0.76828 71.23e-6 1506
result "a sphere on a plate of 10 mm"
series thin plate_impact --set time.end=90us --set bodies.0.mesh.thickness=8mm --set bodies.0.mesh.corner.2=-8mm
impact 0.66482 72.64e-6 1396
result "a sphere on a plate of 8 mm"

# push FROM TO: mean force in the bar's driven end, which moves at 1 m/s, in N; rows are 1 us apart.
push()
{
    columns '$at["step"] == 5 * from { first = $at["work_bodies_J"] }
        $at["step"] == 5 * to { print ($at["work_bodies_J"] - first) / ((to - from) * 1e-6) }' \
        -v from="$1" -v to="$2"
}

series bar bar_wave
near "the force before the wave is back" "$(push 10 70)" 4060.2 0.001
near "the force after it" "$(push 90 140)" -4060.2 0.005
balanced 1e-4 work_bodies_J
result "a wave in a bar"

# Time between two crossings of the static deflection, upwards: 100 N have then done 30.476 mJ.
series beam cantilever --set time.end=31.2ms
near "the frequency of the beam" "$(columns '{
    if (NR > 2 && last < static && $at["work_bodies_J"] >= static) {
        crossing = time + (static - last) / ($at["work_bodies_J"] - last) * ($at["time_s"] - time)
        if (before != "")
            print 1 / (crossing - before)
        before = crossing
    }
    last = $at["work_bodies_J"]
    time = $at["time_s"]
}' -v static=0.030476)" 41.776 0.02
balanced 1e-6 elastic_J
result "the beat of a cantilever"
