#!/bin/bash
# A file of src/ includes only its own floor and those below; postproc/ reads files through store, and
# shares with the solver only base and the headers that store's headers speak of.
set -euo pipefail

floors=(base job model physics solid contact domain store run)
declare -A level
for i in "${!floors[@]}"; do
    level[${floors[i]}]=$i
done

# includes FILE: the floors' headers it includes.
includes()
{
    sed -n -E 's|^ *# *include "([a-z0-9_]+/[a-z0-9_]+\.h)".*|\1|p' "$1"
}

why=
for file in src/*/*.[ch]; do
    floor=$(basename "$(dirname "$file")")
    [ -n "${level[$floor]:-}" ] || why+=" $file is on no floor;"
    for header in $(includes "$file"); do
        below=${level[${header%/*}]:-99}
        [ "$below" -le "${level[$floor]:-0}" ] || why+=" $file includes $header;"
        [ -e "src/$header" ] || why+=" $file includes $header, which is not there;"
    done
done
[ -z "$why" ] && echo "ok includes go down" || echo "FAIL includes go down:$why"

# Headers that store's headers need, however indirectly.
spoken=$(for header in src/store/*.h; do includes "$header"; done | sort -u)
while :; do
    more=$({ echo "$spoken"; for header in $spoken; do includes "src/$header"; done; } | sort -u)
    [ "$more" != "$spoken" ] || break
    spoken=$more
done

# model/sphere.h is what checkpoint_read() fills; job/job.h reads the job text a checkpoint keeps, and
# model/body.h makes its bodies of it.
why=
for file in postproc/*.[ch]; do
    for header in $(includes "$file"); do
        case $header in
        base/* | store/* | model/sphere.h | model/body.h | job/job.h) ;;
        *) grep -qxF "$header" <<< "$spoken" || why+=" $file includes $header;" ;;
        esac
    done
done
[ -z "$why" ] && echo "ok tools read through store" || echo "FAIL tools read through store:$why"
