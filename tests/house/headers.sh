#!/bin/bash
# Each header compiles alone, and its include guard is named after it.
set -euo pipefail

why= guards=
for header in src/*/*.h postproc/*.h tests/unit/check.h tests/verification/*.h charts/*.h; do
    [ -e "$header" ] || continue
    # shellcheck disable=SC2086 # flags are words
    echo "#include \"$header\"" | ${CC:-gcc} $CPPFLAGS -I. -Itests/verification -std=c11 -Wall -Wextra -Werror -Wno-unused-function \
        -Wno-unused-variable -fsyntax-only -x c - 2> "$SCRATCH/said" || why+=" $header: $(head -n 3 "$SCRATCH/said" | tr '\n' ' ');"
    guard=TREMIE_$(sed -e 's|^src/||' -e 's|^tests/unit/|tests/|' -e 's|[/.]|_|g' <<< "$header" | tr '[:lower:]' '[:upper:]')
    grep -qx "#ifndef $guard" "$header" || guards+=" $header lacks $guard;"
done
[ -z "$why" ] && echo "ok compile alone" || echo "FAIL compile alone:$why"
[ -z "$guards" ] && echo "ok guards" || echo "FAIL guards:$guards"
