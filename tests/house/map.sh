#!/bin/bash
# What the guides name is there, and what is there they name.
set -euo pipefail

why=
for header in src/*/*.h; do
    floor=$(basename "$(dirname "$header")")
    module=$(basename "${header%.h}")
    sed -n "/^### $floor\$/,/^### /p" src/README.md | grep -q "^| \`$module\` |" ||
        why+=" $floor/$module is not in src/README.md;"
done
for module in $(sed -n -E 's/^\| `([a-z0-9_]+)` \|.*/\1/p' src/README.md); do
    compgen -G "src/*/$module.h" > /dev/null || [[ $module =~ ^(run|store|domain|contact|physics|solid|model|job|base)$ ]] ||
        why+=" src/README.md names $module, which is not there;"
done
[ -z "$why" ] && echo "ok modules" || echo "FAIL modules:$why"

why=
for tool in postproc/tremie_*.c; do
    name=$(basename "$tool" .c | tr _ -)
    grep -q "^| \`$name\` |" README.md || why+=" $name is not in README.md;"
done
for name in $(sed -n -E 's/^\| `(tremie-[a-z]+)` \|.*/\1/p' README.md); do
    [ -e "postproc/$(tr - _ <<< "$name").c" ] || why+=" README.md names $name, which is not there;"
done
[ -z "$why" ] && echo "ok programs" || echo "FAIL programs:$why"

why=
for page in README.md src/README.md charts/README.md; do
    for link in $(grep -oE '\]\([^)#:]+\)' "$page" | sed 's/^](//; s/)$//'); do
        [ -e "$(dirname "$page")/$link" ] || why+=" $page links to $link, which is not there;"
    done
done
[ -z "$why" ] && echo "ok links" || echo "FAIL links:$why"

# The goals that the help lists are goals of the makefile.
why=
for goal in $(make --no-print-directory help | sed -n -E 's/^make +([a-z-]+) .*/\1/p'); do
    [ "$goal" = build ] || grep -qE "^$goal:" Makefile || why+=" make $goal is not there;"
done
[ -z "$why" ] && echo "ok goals" || echo "FAIL goals:$why"
