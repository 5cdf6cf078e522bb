/* The reference page by the table, in Markdown: what stands in it is what is checked. */
#include "job/schema.h"

#include <string.h>

enum { PATH_LENGTH = 200 };

/* "for lattice: ", when a key is for some kinds only. */
static void kinds_write(FILE *out, const struct schema_key *table, const struct schema_key *key)
{
    const struct schema_key *kind = table;
    while (kind->name != NULL && !schema_tells_kind(kind))
        kind++;
    if (key->kinds == 0 || kind->name == NULL)
        return;
    bool first = true;
    for (int i = 0; kind->choices[i] != NULL; i++) {
        if ((key->kinds >> i & 1u) != 0) {
            fprintf(out, "%s`%s`", first ? "for " : ", ", kind->choices[i]);
            first = false;
        }
    }
    fputs(": ", out);
}

static void row_write(FILE *out, const struct schema_key *table, const struct schema_key *key,
                      const char *path)
{
    char text[SCHEMA_EXPECTED];
    const char *expected = schema_expected(key, text);
    const size_t length = strlen(expected);
    const bool comma = length > 0 && expected[length - 1] == ','; /* is for sentences */
    fprintf(out, "| `%s` | %.*s", path, (int)(comma ? length - 1 : length), expected);
    if (key->unit != NULL && strcmp(key->unit, "1") != 0 && strstr(expected, key->unit) == NULL)
        fprintf(out, " [%s]", key->unit);
    if (key->required)
        fputs(" | required | ", out);
    else if (key->standard != NULL && key->standard[0] != '\0')
        fprintf(out, " | `%s` | ", key->standard);
    else
        fputs(" | | ", out);
    kinds_write(out, table, key);
    fprintf(out, "%s |\n", key->help);
}

static bool has_inside(const struct schema_key *key)
{
    return key->inside != NULL;
}

/* Rows of a table and of what is inside it. */
static void rows_write(FILE *out, const struct schema_key *table, const char *parent)
{
    for (const struct schema_key *key = table; key->name != NULL; key++) {
        char path[PATH_LENGTH], inner[PATH_LENGTH];
        snprintf(path, sizeof path, "%s%s", parent, key->name);
        row_write(out, table, key, path);
        snprintf(inner, sizeof inner, "%.150s%s", path,
                 key->type == SCHEMA_LIST || key->type == SCHEMA_ELSEWHERE ? "[]."
                 : key->type == SCHEMA_NAMED                               ? ".NAME."
                                                                           : ".");
        if (has_inside(key))
            rows_write(out, key->inside, inner);
    }
}

static const char table_head[] =
    "\n| key | value | default | meaning |\n| --- | --- | --- | --- |\n";

void schema_reference(FILE *out, const struct schema_key *table)
{
    fprintf(out, "\n## general\n%s", table_head);
    for (const struct schema_key *key = table; key->name != NULL; key++)
        if (!has_inside(key))
            row_write(out, table, key, key->name);
    for (const struct schema_key *key = table; key->name != NULL; key++) {
        if (!has_inside(key))
            continue;
        const struct schema_key only[2] = {*key, {.name = NULL}};
        fprintf(out, "\n## %s\n%s", key->name, table_head);
        rows_write(out, only, "");
    }
}
