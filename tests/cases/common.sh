# What the cases that compare whole runs share; sourced by them, in SCRATCH from then on.
# shellcheck shell=bash disable=SC2034

scenes=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/scenes
bin=$(realpath "$BIN")
cd "$SCRATCH" || exit 1
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1
patience=120 # seconds that any one run may take
thorough=yes # with sanitizers nothing is quick, so less is tried
[ "${FLAVOUR:-release}" = release ] || patience=600 thorough=
why= # reasons why the present case fails

# tremie RANKS WORDS...: runs the program and gives its status; output and messages go to `said`.
tremie()
{
    local ranks=$1
    shift
    timeout -k 5 $patience mpirun --oversubscribe --bind-to none -q -n "$ranks" "$bin/tremie" "$@" \
        > said 2>&1 < /dev/null
}

# run RANKS OUT SCENE OPTIONS...: a run of scenes/SCENE.yaml that is to finish.
run()
{
    local ranks=$1 out=$2 scene=$3 status=0
    shift 3
    tremie "$ranks" run "$scenes/$scene.yaml" --out "$out" "$@" || status=$?
    [ "$status" = 0 ] || why+=" $out on $ranks ranks ends with status $status;"
}

# says TEXT: the last run's messages hold it.
says()
{
    grep -qF -- "$1" said || why+=" does not say '$1';"
}

# equal A B: two files or runs are the same to the last bit.
equal()
{
    "$bin/tremie-compare" "$1" "$2" > compared 2>&1 || why+=" $2 is not $1: $(tail -n 1 compared);"
}

# same_run A B: every checkpoint that A has is also in B, and they and the series are equal.
same_run()
{
    local file n=0
    for file in "$1"/checkpoints/step_*.h5; do
        equal "$file" "$2/checkpoints/${file##*/}"
        n=$((n + 1))
    done
    [ "$n" -gt 0 ] || why+=" $1 has no checkpoints;"
    equal "$1" "$2"
}

# same_snapshots A B: their folders are equal, byte for byte, the index too.
same_snapshots()
{
    diff -r "$1/snapshots" "$2/snapshots" > said 2>&1 || why+=" the snapshots of $2 are not those of $1;"
}

# series RUN: its series in series.csv.
series()
{
    "$bin/tremie-info" "$1" --csv series.csv > said 2>&1 || why+=" tremie-info ends with status $?;"
}

# columns PROGRAM OPTIONS...: awk over series.csv; at["NAME"] is the place of a column.
columns()
{
    local program=$1
    shift
    awk -F, "$@" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }'" $program" series.csv
}

# balance RUN: how far its balance of energy is off at the end, over all that was turned over.
balance()
{
    series "$1"
    columns '{ turned = 0; for (name in at) if (name ~ /^(kinetic|elastic|dissipated|work)/) turned += $at[name] < 0 ? -$at[name] : $at[name]
               off = $at["balance_J"] / turned } END { print off < 0 ? -off : off }'
}

# near WHAT VALUE EXPECTED SHARE: it is, within that share of it.
near()
{
    awk -v value="$2" -v expected="$3" -v share="$4" 'BEGIN {
        size = expected < 0 ? -expected : expected
        exit !(value != "" && value >= expected - share * size && value <= expected + share * size)
    }' || why+=" $1 is $2, not $3 within $4 of it;"
}

# result NAME: ok, or FAIL with the reasons and what was said last.
result()
{
    if [ -z "$why" ]; then
        echo "ok $1"
    else
        echo "FAIL $1:$why"
        tail -n 5 said
    fi
    why=
}

# like REFERENCE RANKS NAME SCENE OPTIONS...: a run that is to equal the reference.
like()
{
    local reference=$1 ranks=$2 name=$3 scene=$4
    shift 4
    run "$ranks" this "$scene" "$@"
    [ -n "$why" ] || same_run "$reference" this
    result "$name"
    rm -rf this
}

# ---- Runs that are killed

job= # process id of a run in the background
# shellcheck disable=SC2046 # words
kill_all() { kill -KILL $(pgrep -P "$job") "$job" 2> /dev/null; }
trap '[ -z "$job" ] || kill_all' EXIT

# start RANKS OUT SCENE OPTIONS...: a run of scenes/SCENE.yaml in the background.
start()
{
    local ranks=$1 out=$2 scene=$3
    shift 3
    mpirun --oversubscribe --bind-to none -q -n "$ranks" "$bin/tremie" run "$scenes/$scene.yaml" \
        --out "$out" "$@" > said 2>&1 < /dev/null &
    job=$!
}

# newest RUN: the step of its newest checkpoint, 0 without one.
newest()
{
    local file
    file=$(find "$1/checkpoints" -name 'step_*.h5' 2> /dev/null | sort | tail -n 1)
    file=${file##*step_}
    file=${file%.h5}
    echo $((10#${file:-0}))
}

# wait_until_after RUN STEP: until the run has a checkpoint later than that.
wait_until_after()
{
    local tries=0
    while [ "$(newest "$1")" -le "$2" ]; do
        sleep 0.02
        tries=$((tries + 1))
        if [ $tries -gt $((patience * 30)) ] || ! kill -0 "$job" 2> /dev/null; then
            why+=" no checkpoint after step $2 came in time;"
            return
        fi
    done
}

# wait_for_end: its exit status; a run that does not end is killed.
wait_for_end()
{
    local tries=0 status=0
    while kill -0 "$job" 2> /dev/null; do
        sleep 0.02
        tries=$((tries + 1))
        [ $tries -le $((patience * 30)) ] || kill_all
    done
    wait "$job" || status=$?
    job=
    return $status
}

# kill_ranks: all ranks at once, as if the power were gone.
# shellcheck disable=SC2046 # words
kill_ranks()
{
    kill -KILL $(pgrep -P "$job") 2> /dev/null || why+=" it ended before it could be killed;"
    wait_for_end && why+=" it ended well though it was killed;"
}

# random_spheres SEED N: a CSV file of N spheres of eight radii and two materials that do not
# touch, in a cube of edge 1 about the origin, with speeds up to 3 m/s along each axis.
random_spheres()
{
    awk -v seed="$1" -v n="$2" 'BEGIN {
        srand(seed)
        made = 0
        print "x_m,y_m,z_m,radius_m,material,vx_m_s,vy_m_s,vz_m_s"
        while (made < n) {
            r = 0.02 * (1 + int(8 * rand()) * (rand() < 0.3))
            for (k = 0; k < 3; k++)
                c[k] = (rand() - 0.5) * (1 - 2 * r)
            for (i = 0; i < made; i++) {
                d2 = (c[0] - x[i])^2 + (c[1] - y[i])^2 + (c[2] - z[i])^2
                if (d2 <= (r + s[i])^2)
                    break
            }
            if (i < made)
                continue
            x[made] = c[0]; y[made] = c[1]; z[made] = c[2]; s[made] = r
            made++
            printf "%.9f,%.9f,%.9f,%.9f", c[0], c[1], c[2], r - 1e-6
            printf ",%s", rand() < 0.5 ? "ore" : "rubber"
            printf ",%.6f,%.6f,%.6f\n", 6 * rand() - 3, 6 * rand() - 3, 6 * rand() - 3
        }
    }'
}
