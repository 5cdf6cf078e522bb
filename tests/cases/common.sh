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
