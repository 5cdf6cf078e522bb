#!/bin/bash
# Every name that a module of src/ gives to others begins with the module's name: functions, data,
# struct and enum tags.  A module may be named in the singular where it also acts on many (sphere,
# spheres), and a few speak with a second word; those are listed here.
set -euo pipefail

# words MODULE: the words its public names may begin with.
words()
{
    case $1 in
    report) echo report mistake mistakes ;;
    contact_set) echo contact contacts contact_set ;;
    facet_contact) echo facet_contact facet_contacts facet body_load ;;
    body) echo body bodies ;;
    solid_energy) echo solid_energy solid_energies ;;
    cell_grid) echo cell_grid cell ;;
    *_blocks_v? | *_blocks_generic | *_blocks | *_rows_v? | *_rows_generic | *_rows) echo "${1%_blocks*}" "${1%_rows*}" ;;
    job_*) echo job ;;
    schema_*) echo schema ;;
    *) echo "$1" "${1}s" "${1%s}" ;;
    esac
}

# strangers MODULE: of the names on standard input, those that begin with none of its words.
strangers()
{
    local pattern
    pattern=$(words "$1" | tr ' ' '|')
    grep -vE "^($pattern)(_|\$)" || true
}

why=
for object in "$BUILD"/src/*/*.o; do
    module=$(basename "${object%.o}")
    [ "$module" != main ] || continue
    [ -e "src/$(basename "$(dirname "$object")")/$module.c" ] || [[ $module == *_v? || $module == *_generic ]] || continue
    names=$(nm --defined-only --extern-only "$object" | awk '{print $3}' | grep -v '^__' | strangers "$module")
    [ -z "$names" ] || why+=" $module has $(tr '\n' ' ' <<< "$names");"
done
[ -z "$why" ] && echo "ok functions and data" || echo "FAIL functions and data:$why"

why=
for header in src/*/*.h; do
    module=$(basename "${header%.h}")
    names=$({ sed -n -E 's/^(struct|enum) ([a-z0-9_]+) \{.*/\2/p' "$header"
        sed -n -E 's/^static inline .*[ *]([a-z0-9_]+)\(.*/\1/p' "$header"; } | strangers "$module")
    [ -z "$names" ] || why+=" $header has $(tr '\n' ' ' <<< "$names");"
done
[ -z "$why" ] && echo "ok tags and inline functions" || echo "FAIL tags and inline functions:$why"
