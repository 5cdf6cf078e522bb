#!/bin/bash
# timeout: 1200
# The bits do not depend on the compiler: what gcc and clang make of the program gives equal states and series, with
# every kernel.
set -uo pipefail
root=$PWD build=$(realpath "$BUILD")
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

case ${CC:-gcc} in
*clang*) compiler=gcc ;;
*) compiler=clang ;;
esac
if [ -z "$thorough" ] || ! command -v "$compiler" > /dev/null; then
    echo "skip the other compiler: $compiler is not here, or this is not the release flavour"
    exit 0
fi
other=$build/other/bin
env -u MAKEFLAGS -u MAKELEVEL make -s -C "$root" CC="$compiler" BUILD="$build/other" BIN="$other" "$other/tremie" > said 2>&1 ||
    why=" does not compile;"
result "$compiler compiles the program"
[ -x "$other/tremie" ] || exit 0

ours=$bin
# compare NAME SCENE OPTIONS...: a run of our program, and of the other one with each kernel.
compare()
{
    local name=$1 scene=$2 isa
    shift 2
    run 1 ours "$scene" "$@"
    result "$name by ${CC:-gcc}"
    for isa in v2 v3 v4; do
        bin=$other
        if tremie 1 check "$scenes/$scene.yaml" --isa $isa; then
            run 2 theirs "$scene" "$@" --isa $isa
            bin=$ours
            same_run ours theirs
            result "$name by $compiler, kernel $isa on 2 ranks"
        else
            bin=$ours
            grep -q "isa $isa does not run" said || echo "FAIL kernel $isa: $(head -n 1 said)"
        fi
        rm -rf theirs
    done
    rm -rf ours
}
compare heap heap
compare mixed mixed
compare "mixed without ledger" mixed --set contact.ledger=false
compare machines machines
compare solids deform
compare shells sheets
compare "bodies that touch" slide
compare periodic periodic
