#!/bin/bash
# What a contact costs in beds of one size, of two that differ by 20, and of all sizes between.
#
#   tests/bench/mixture.sh [ROUNDS=3] [STEPS=4000]
#
# Three beds of 6000 spheres settle once, in about half a minute each, into build/bench/mixture.  Then,
# ROUNDS times in turn, each goes on for STEPS steps: once as it comes, once with a search forced every 20
# steps, which is what fast flow asks for.  User CPU time less that of a run of hardly any steps is divided
# by steps and touching contacts, with bodies included.
set -euo pipefail
cd "$(dirname "$0")/../.."

BIN=$(realpath "${BIN:-bin}")
ROUNDS=${ROUNDS:-3} STEPS=${STEPS:-4000}
HERE=$PWD/tests/bench
WORK=$PWD/build/bench/mixture
DT=2e-5 SETTLED=40000 # [s], steps; as in mixture.yaml
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_btl_base_warn_component_unused=0

mkdir -p "$WORK"
cd "$WORK"
cp "$HERE/mixture.yaml" .

declare -A sizes=(
    [equal]="{kind: list, radii: [{radius: 0.01, share: 1}]}"
    [two]="{kind: list, by: mass, radii: [{radius: 0.01, share: 3}, {radius: 0.2, share: 8}]}"
    [spread]=
)

# timed SCENE OUT OPTION...: a run; user CPU time [s] into OUT.user.
timed()
{
    local scene=$1 out=$2 TIMEFORMAT=%U
    shift 2
    [ -z "${sizes[$scene]}" ] || set -- "$@" --set "spheres.0.sizes=${sizes[$scene]}"
    rm -rf "$out"
    { time "$BIN/tremie" run mixture.yaml --out "$out" "$@" > "$out.out" 2>&1; } 2> "$out.user" || {
        echo "failed: $scene" >&2
        tail -n 5 "$out.out" >&2
        exit 1
    }
}

# on SCENE OUT STEPS OPTION...: goes on from the settled bed.
on()
{
    local scene=$1 out=$2 steps=$3
    shift 3
    timed "$scene" "$out" --restart "$(ls "$WORK/settled-$scene"/checkpoints/*.h5)" \
        --set time.end="$(awk -v n=$((SETTLED + steps)) -v dt=$DT 'BEGIN { printf "%.12g", n * dt }')" "$@"
}

# last RUN COLUMN: the last value of a column of the series.
last()
{
    h5dump -w 0 -y -d "/series/$2" "$(find "$1/series" -name 'step_*.h5' | sort | tail -n 1)" |
        sed -n 's/^ *\([-0-9.e+]*\)$/\1/p; s/^.*, \([-0-9.e+]*\)$/\1/p' | tail -n 1
}

for scene in equal two spread; do
    if [ ! -d "settled-$scene/checkpoints" ]; then
        echo "letting the bed '$scene' settle, once"
        timed "$scene" "settling-$scene" --set output.series.every=0.1
        mv "settling-$scene" "settled-$scene"
    fi
done

echo "round,scene,search,contacts,kinetic_J,user_s,ns_a_contact" | tee "$HERE/mixture.csv"
for round in $(seq "$ROUNDS"); do
    for scene in equal two spread; do
        on $scene start 10
        for search in 0 20; do
            on $scene measured "$STEPS" --set testing.search_every=$search
            contacts=$(($(last measured n_contacts) + $(last measured n_facet_contacts)))
            awk -v OFS=, -v round="$round" -v scene=$scene -v search=$search -v n="$contacts" -v steps="$STEPS" \
                -v energy="$(last measured kinetic_translation)" -v user="$(cat measured.user)" \
                -v start="$(cat start.user)" 'BEGIN {
                    user -= start
                    print round, scene, search, n, energy, user, sprintf("%.1f", 1e9 * user / n / steps)
                }' | tee -a "$HERE/mixture.csv"
        done
    done
done
awk -F, 'NR > 1 { sum[$2 "," $3] += $7; n[$2 "," $3]++ }
    END { for (s = 0; s <= 20; s += 20) for (k = split("equal two spread", name, " "); k > 0; k--)
        printf "%-7s search every %s: %5.1f ns a contact and step, %.2f of equal spheres\n", name[k],
            s == 0 ? "so often as due" : s " steps", sum[name[k] "," s] / n[name[k] "," s],
            sum[name[k] "," s] / n[name[k] "," s] / (sum["equal," s] / n["equal," s]) }' "$HERE/mixture.csv"
