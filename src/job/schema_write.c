/*
 * Writing a struct back as YAML by the table, every default written out.
 *
 * The text is canonical: equal structs give equal bytes, and a double has as many digits as it
 * takes to read back equal.  Groups and lists are written in block style; lists of numbers in
 * flow style; units stand as comments.
 */
#include "job/schema.h"

#include <stdint.h>
#include <string.h>

#include "base/report.h"
#include "base/vec3.h"

/* Where the text goes, and how the next line begins. */
struct page {
    FILE *out;
    const char *const *names; /* what references mean */
    int indent;               /* [spaces] */
    bool dash;                /* the next line begins an element of a list */
};

static void line_begin(struct page *page)
{
    fprintf(page->out, "%*s%s", page->dash ? page->indent - 2 : page->indent, "",
            page->dash ? "- " : "");
    page->dash = false;
}

static void text_write(FILE *out, const char *text)
{
    fputc('"', out);
    for (; *text != '\0'; text++) {
        if (*text == '"' || *text == '\\')
            fprintf(out, "\\%c", *text);
        else if ((unsigned char)*text < ' ')
            fprintf(out, "\\x%02x", (unsigned)*text);
        else
            fputc(*text, out);
    }
    fputc('"', out);
}

static void doubles_write(FILE *out, const double *values, size_t n)
{
    char text[SCHEMA_DOUBLE];
    fputc('[', out);
    for (size_t i = 0; i < n; i++)
        fprintf(out, "%s%s", i > 0 ? ", " : "", schema_double(text, values[i]));
    fputc(']', out);
}

static void number_write(FILE *out, const struct schema_key *key, const double *values)
{
    char text[SCHEMA_DOUBLE];
    const size_t n = key->size / sizeof(double);
    if (n > 1)
        doubles_write(out, values, n);
    else if (key->word != NULL && values[0] == key->word_value)
        fputs(key->word, out);
    else
        fputs(schema_double(text, values[0]), out);
    if (strcmp(key->unit, "1") != 0)
        fprintf(out, " # %s", key->unit);
}

/* Integers, or what they stand for in `words`. */
static void integers_write(FILE *out, const int *values, size_t n, const char *const *words)
{
    if (n > 1)
        fputc('[', out);
    for (size_t i = 0; i < n; i++) {
        fputs(i > 0 ? ", " : "", out);
        if (words != NULL)
            fputs(words[values[i]], out);
        else
            fprintf(out, "%d", values[i]);
    }
    if (n > 1)
        fputc(']', out);
}

static void choices_write(FILE *out, const char *const *choices, int set)
{
    bool first = true;
    fputc('[', out);
    for (int i = 0; choices[i] != NULL; i++) {
        if ((set >> i & 1) != 0) {
            fprintf(out, "%s%s", first ? "" : ", ", choices[i]);
            first = false;
        }
    }
    fputc(']', out);
}

static void points_write(const struct page *page, const struct vec3 *points, int n)
{
    for (int i = 0; i < n; i++) {
        const double values[3] = {points[i].x, points[i].y, points[i].z};
        fprintf(page->out, "\n%*s- ", page->indent + 2, "");
        doubles_write(page->out, values, 3);
    }
}

static void facets_write(const struct page *page, const int (*facets)[4], int n)
{
    for (int i = 0; i < n; i++) {
        fprintf(page->out, "\n%*s- ", page->indent + 2, "");
        integers_write(page->out, facets[i], facets[i][3] < 0 ? 3 : 4, NULL);
    }
}

/* Everything that fits behind "key: ". */
static void value_write(const struct page *page, const struct schema_key *key, const char *from)
{
    FILE *out = page->out;
    const void *place = from + key->offset;
    switch (key->type) {
    case SCHEMA_TEXT:
    case SCHEMA_FILE:
        text_write(out, *(char *const *)place);
        break;
    case SCHEMA_NAME:
        fputs(*(char *const *)place, out);
        break;
    case SCHEMA_FLAG:
        fputs(*(const bool *)place ? "true" : "false", out);
        break;
    case SCHEMA_NUMBER:
        number_write(out, key, place);
        break;
    case SCHEMA_DIRECTION:
        doubles_write(out, place, 3);
        break;
    case SCHEMA_COUNT:
        fprintf(out, "%lld", (long long)*(const int64_t *)place);
        break;
    case SCHEMA_INT:
        if (key->word != NULL && *(const int *)place == (int)key->word_value) {
            fputs(key->word, out);
            break;
        }
        integers_write(out, place, key->size / sizeof(int), NULL);
        break;
    case SCHEMA_REFERENCE:
        integers_write(out, place, key->size / sizeof(int), page->names);
        break;
    case SCHEMA_CHOICE:
        fputs(key->choices[key->size > 0 ? *(const int *)place : 0], out);
        break;
    case SCHEMA_CHOICES:
        choices_write(out, key->choices, *(const int *)place);
        break;
    case SCHEMA_NUMBERS:
        doubles_write(out, *(double *const *)place,
                      (size_t) * (const int *)(const void *)(from + key->count));
        break;
    case SCHEMA_POINTS:
        points_write(page, *(struct vec3 *const *)place,
                     *(const int *)(const void *)(from + key->count));
        break;
    case SCHEMA_FACETS:
        facets_write(page, *(const int(*const *)[4])place,
                     *(const int *)(const void *)(from + key->count));
        break;
    case SCHEMA_GROUP:
    case SCHEMA_LIST:
    case SCHEMA_NAMED:
    case SCHEMA_ELSEWHERE:
        CHECK(false, "%s is no value", key->name);
    }
    fputc('\n', out);
}

static void table_write(struct page *page, const struct schema_key *table, const char *from);

static void elements_write(struct page *page, const struct schema_key *key, const char *from)
{
    const bool named = key->type == SCHEMA_NAMED;
    const int n = *(const int *)(const void *)(from + key->count);
    const char *list = *(char *const *)(const void *)(from + key->offset);
    if (n == 0) {
        fprintf(page->out, " %s\n", named ? "{}" : "[]");
        return;
    }
    fputc('\n', page->out);
    if (key->single && n == 1) {
        page->indent += 2;
        table_write(page, key->inside, list);
        page->indent -= 2;
        return;
    }
    for (int i = 0; i < n; i++) {
        const char *element = list + (size_t)i * key->element;
        if (named)
            fprintf(page->out, "%*s%s:\n", page->indent + 2, "",
                    *(char *const *)(const void *)element);
        page->indent += 4;
        page->dash = !named;
        table_write(page, key->inside, element);
        page->indent -= 4;
    }
}

static bool is_present(const struct schema_key *key, int kind, const char *from)
{
    if (key->type == SCHEMA_ELSEWHERE || (key->kinds != 0 && (key->kinds >> kind & 1u) == 0))
        return false;
    for (size_t i = 0; i < key->given_size; i++)
        if (from[key->given + i] != 0)
            return true;
    return key->given_size == 0;
}

static void table_write(struct page *page, const struct schema_key *table, const char *from)
{
    int kind = 0;
    for (const struct schema_key *key = table; key->name != NULL; key++) {
        if (schema_tells_kind(key))
            kind = *(const int *)(const void *)(from + key->offset);
        if (!is_present(key, kind, from))
            continue;
        line_begin(page);
        fprintf(page->out, "%s:", key->name);
        if (key->type == SCHEMA_GROUP) {
            fputc('\n', page->out);
            page->indent += 2;
            table_write(page, key->inside, from + key->offset);
            page->indent -= 2;
        } else if (key->type == SCHEMA_LIST || key->type == SCHEMA_NAMED) {
            elements_write(page, key, from);
        } else {
            if (key->type != SCHEMA_POINTS && key->type != SCHEMA_FACETS)
                fputc(' ', page->out);
            value_write(page, key, from);
        }
    }
}

void schema_write(FILE *out, const struct schema_key *table, const void *from,
                  const char *const *names)
{
    struct page page = {.out = out, .names = names};
    table_write(&page, table, from);
}
