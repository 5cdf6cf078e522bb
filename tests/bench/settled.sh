#!/bin/bash
# How fast tremie steps a bed of 8768 spheres at rest, on one core, beside LIGGGHTS where that is installed.
#
#   make bench [ROUNDS=5] [STEPS=6000] [CORE=0] [LIGGGHTS=liggghts]
#
# The bed settles once, in about a minute and a half, into build/bench/settled; `make clean` forgets it.
# From it both codes start at rest and without memory, run until contacts hold what they have to, and keep
# that state.  Then, ROUNDS times in turn, each runs STEPS steps from there: tremie without its energy
# ledger, which LIGGGHTS has not, tremie as it comes, and LIGGGHTS with the best of three skins.
#
# Rates come twice, without start-up: by wall clock (tremie's runtime table, LIGGGHTS' loop time) and by
# the process's user CPU time less that of a run of hardly any steps, which other work on the machine
# disturbs less.  All of it goes to tests/bench/settled.csv; README.md there keeps results of one machine.
set -euo pipefail
cd "$(dirname "$0")/../.."

BIN=$(realpath "${BIN:-bin}")
ROUNDS=${ROUNDS:-5} STEPS=${STEPS:-6000} CORE=${CORE:-0} LIGGGHTS=${LIGGGHTS:-liggghts}
HERE=$PWD/tests/bench
WORK=$PWD/build/bench/settled
TABLE=$HERE/settled.csv
SKINS=(0.0025 0.005 0.01) # [m]
N_SPHERES=8768
RELAX=2000 EVERY=1000     # steps; a row of tremie's runtime table every EVERY
DT=1e-5                   # [s], as in settled.yaml and settled.in
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_btl_base_warn_component_unused=0

[ $((STEPS % EVERY)) = 0 ] || { echo "STEPS: $STEPS: expected a multiple of $EVERY" >&2; exit 2; }
mkdir -p "$WORK"
cd "$WORK"
cp "$HERE/settled.yaml" "$HERE/settled.in" .

# seconds STEPS: simulated time of so many steps, for a job file.
seconds() { awk -v n="$1" -v dt="$DT" 'BEGIN { printf "%.12g", n * dt }'; }

# timed NAME COMMAND...: runs it on the one core; user CPU time [s] into NAME.user, what it prints to NAME.out.
timed()
{
    local name=$1 TIMEFORMAT=%U
    shift
    if ! { time taskset -c "$CORE" "$@" > "$name.out" 2>&1; } 2> "$name.user"; then
        echo "failed: $*" >&2
        tail -n 20 "$name.out" >&2
        exit 1
    fi
}

# --------------------------------------------------------------------------------- the state to start from

if [ ! -s bed.data ]; then
    echo "letting the bed settle, once: about a minute and a half"
    rm -rf settling
    "$HERE/settled.py" loose > loose.csv
    timed settling "$BIN/tremie" run settled.yaml --out settling --set spheres.0.packing.file=loose.csv \
        --set contact.ledger=false --set damping=3 --set time.step=2.5e-5 --set time.end=2.5 \
        --set output.series.every=0.5
    "$HERE/settled.py" export settling/checkpoints/*.h5 bed.csv bed.tmp
    mv bed.tmp bed.data
fi

# tremie NAME LEDGER UNTIL [OPTION...]: a run of its own, to step UNTIL.
tremie()
{
    local name=$1 ledger=$2 until=$3
    shift 3
    rm -rf "run-$name"
    timed "$name" "$BIN/tremie" run settled.yaml --out "run-$name" --set contact.ledger="$ledger" \
        --set time.end="$(seconds "$until")" "$@"
}

# liggghts NAME STEPS START LAST [SKIN]
liggghts()
{
    timed "$1" "$LIGGGHTS" -in settled.in -log none -var start "$3" -var skin "${5:-$skin}" -var steps "$2" \
        -var last "$4"
}

echo "letting contacts take up their loads"
for ledger in false true; do
    tremie "relaxed-$ledger" $ledger $RELAX
done
has_liggghts=$(command -v "$LIGGGHTS" || true)
if [ -n "$has_liggghts" ]; then
    liggghts relaxed 2000 "read_data bed.data" "write_restart relaxed.bin" 0.01
else
    echo "$LIGGGHTS is not here, so tremie is measured alone; to compare, on Debian: apt-get install liggghts"
fi

# ---------------------------------------------------------------------------------------------- measuring

# from_relaxed NAME LEDGER STEPS
from_relaxed()
{
    tremie "$1" "$2" $((RELAX + $3)) --restart "$WORK/run-relaxed-$2/checkpoints/$(ls "run-relaxed-$2/checkpoints")"
}

# record ROUND CODE NAME START: adds a line to the table.  START: user CPU time of starting up [s].
record()
{
    local round=$1 code=$2 name=$3 result
    case $code in
    liggghts) result=$("$HERE/settled.py" liggghts "$name.out") ;;
    *) result=$("$HERE/settled.py" tremie "run-$name") ;;
    esac
    awk -F, -v OFS=, -v n=$N_SPHERES -v head="$round,$code" -v user="$(cat "$name.user")" -v start="$4" '{
        user -= start
        head = head OFS $1 OFS $2 OFS sprintf("%.3f", user)
        rates = sprintf("%.4f,%.4f", n * $1 / $2 * 1e-6, n * $1 / user * 1e-6)
        sub(/^[^,]*,[^,]*,/, "")
        print head, rates, $0
    }' <<< "$result" | tee -a "$TABLE"
}

from_relaxed start false 10
start_tremie=$(cat start.user)
if [ -n "$has_liggghts" ]; then
    best=
    for try in "${SKINS[@]}" "${SKINS[@]}"; do # twice: the machine may have been busy
        liggghts skin 1000 "read_restart relaxed.bin" "print done" "$try"
        used=$(cat skin.user)
        echo "liggghts with skin $try m: $used s for 1000 steps"
        if [ -z "$best" ] || awk "BEGIN { exit !($used < $best) }"; then
            best=$used skin=$try
        fi
    done
    liggghts start 10 "read_restart relaxed.bin" "print done"
    start_liggghts=$(cat start.user)
    echo "liggghts runs with skin $skin m"
fi

echo "round,code,steps,wall_s,user_s,rate_wall,rate_user,kinetic_J,contacts,pairs_ns,facets_ns,integrate_ns,search_ns,others_ns" |
    tee "$TABLE"
for round in $(seq "$ROUNDS"); do
    from_relaxed without false "$STEPS"
    record "$round" "tremie without ledger" without "$start_tremie"
    from_relaxed with true "$STEPS"
    record "$round" tremie with "$start_tremie"
    if [ -n "$has_liggghts" ]; then
        liggghts measured "$STEPS" "read_restart relaxed.bin" "print done"
        record "$round" liggghts measured "$start_liggghts"
    fi
done
"$HERE/settled.py" summary "$TABLE"
