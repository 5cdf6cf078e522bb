/*
 * Reading by the table: every value is checked for type, unit, bounds and choice, and whatever
 * is wrong is listed with its place, so a person mends a file in one go.  Defaults take the
 * same path as values that were given, so a wrong default shows in the first test.
 *
 * After SCHEMA_MISTAKES mistakes the rest is cut off: nobody mends more at once, and a file of
 * a million wrong keys must not take minutes.
 */
#include "job/schema.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/array.h"
#include "base/report.h"
#include "base/units.h"
#include "base/vec3.h"
#include "job/yaml_tree.h"

enum { PATH_LENGTH = 200, WORD_LENGTH = 40 };

/* One value on its way from the file into the struct. */
struct item {
    const struct schema_reader *reader;
    const struct schema_key *key;
    const struct yaml_tree_node *node;
    const char *path; /* "spheres.0.radius" */
    char *into;       /* the struct */
};

static void mistake(const struct schema_reader *reader, const char *file, int line, int column,
                    const char *format, ...) __attribute__((format(printf, 5, 6)));

static void mistake(const struct schema_reader *reader, const char *file, int line, int column,
                    const char *format, ...)
{
    if (reader->mistakes->n > SCHEMA_MISTAKES)
        return;
    if (reader->mistakes->n == SCHEMA_MISTAKES) {
        mistakes_add(reader->mistakes, file, line, column,
                     "there may be more mistakes from here on");
        return;
    }
    va_list arguments;
    va_start(arguments, format);
    char text[1024];
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    for (char *c = text; *c != '\0'; c++)
        if ((unsigned char)*c < ' ') /* the file's text must not steer a terminal */
            *c = '?';
    mistakes_add(reader->mistakes, file, line, column, "%s", text);
}

/* ------------------------------------------------------------------------------- words */

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

/* Changes (insert, delete, replace, swap neighbours) that turn one word into another. */
static int edit_distance(const char *a, const char *b)
{
    int rows[3][WORD_LENGTH + 1];
    const int n = (int)strlen(a), m = (int)strlen(b);
    if (n > WORD_LENGTH || m > WORD_LENGTH)
        return WORD_LENGTH;
    for (int j = 0; j <= m; j++)
        rows[0][j] = j;
    for (int i = 1; i <= n; i++) {
        int *now = rows[i % 3];
        const int *last = rows[(i + 2) % 3], *before = rows[(i + 1) % 3];
        now[0] = i;
        for (int j = 1; j <= m; j++) {
            const int p = tolower((unsigned char)a[i - 1]),
                      q = tolower((unsigned char)b[j - 1]);
            now[j] = smaller(smaller(last[j], now[j - 1]) + 1, last[j - 1] + (p != q));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                now[j] = smaller(now[j], before[j - 2] + 1);
        }
    }
    return rows[n % 3][m];
}

const char *schema_suggestion(const char *word, const char *const *candidates, int n)
{
    const char *nearest = NULL;
    int least = ((int)strlen(word) + 2) / 3 + 1;
    for (int i = 0; i < n; i++) {
        const int distance = edit_distance(word, candidates[i]);
        if (distance < least && distance < (int)strlen(candidates[i])) {
            least = distance;
            nearest = candidates[i];
        }
    }
    return nearest;
}

const char *schema_double(char text[SCHEMA_DOUBLE], double value)
{
    char tried[SCHEMA_DOUBLE];
    snprintf(text, SCHEMA_DOUBLE, "%.17g", value);
    for (int digits = 16; digits > 0; digits--) { /* 600 rather than 6e+02 */
        snprintf(tried, sizeof tried, "%.*g", digits, value);
        if (strtod(tried, NULL) == value && strlen(tried) < strlen(text))
            memcpy(text, tried, sizeof tried);
    }
    return text;
}

static bool name_is_valid(const char *name)
{
    if (!isalpha((unsigned char)name[0]) || strlen(name) > WORD_LENGTH)
        return false;
    for (size_t i = 0; name[i] != '\0'; i++)
        if (!isalnum((unsigned char)name[i]) && name[i] != '-' && name[i] != '_')
            return false;
    return true;
}

/* -------------------------------------------------------------------------------
 * expectations */

static size_t n_components(const struct schema_key *key)
{
    return key->type == SCHEMA_NUMBER ? key->size / sizeof(double) : key->size / sizeof(int);
}

/* " above 0 m", " between 0.05 and 1", " above 0 and below 1 m" */
static void bounds_describe(const struct schema_key *key, char *text, size_t n)
{
    char low[SCHEMA_DOUBLE], high[SCHEMA_DOUBLE];
    const char *unit = key->unit == NULL || strcmp(key->unit, "1") == 0 ? "" : key->unit;
    const char *blank = unit[0] != '\0' ? " " : "";
    const bool above = (key->bounds & SCHEMA_ABOVE) != 0,
               below = (key->bounds & SCHEMA_BELOW) != 0;
    const bool has_low = above || (key->bounds & SCHEMA_AT_LEAST) != 0;
    const bool has_high = below || (key->bounds & SCHEMA_AT_MOST) != 0;
    schema_double(low, key->min);
    schema_double(high, key->max);
    text[0] = '\0';
    if (has_low && has_high && !above && !below)
        snprintf(text, n, " between %s and %s%s%s", low, high, blank, unit);
    else if (has_low && has_high)
        snprintf(text, n, " %s %s and %s %s%s%s", above ? "above" : "of at least", low,
                 below ? "below" : "at most", high, blank, unit);
    else if (has_low)
        snprintf(text, n, " %s %s%s%s", above ? "above" : "of at least", low, blank, unit);
    else if (has_high)
        snprintf(text, n, " %s %s%s%s", below ? "below" : "of at most", high, blank, unit);
}

static void choices_describe(const struct schema_key *key, char *text, size_t n)
{
    size_t used = 0;
    for (int i = 0; key->choices[i] != NULL && used < n; i++)
        used +=
            (size_t)snprintf(text + used, n - used, "%s%s", i > 0 ? ", " : "", key->choices[i]);
}

const char *schema_expected(const struct schema_key *key, char text[SCHEMA_EXPECTED])
{
    char bounds[128] = "", inner[SCHEMA_EXPECTED - 64] = "";
    bounds_describe(key, bounds, sizeof bounds);
    const bool single = n_components(key) == 1;
    switch (key->type) {
    case SCHEMA_TEXT:
        return "a text";
    case SCHEMA_NAME:
        return "a name of letters, digits, - and _ (a letter first, at most 40)";
    case SCHEMA_FILE:
        return "the path of a file";
    case SCHEMA_FLAG:
        return "true or false";
    case SCHEMA_NUMBER:
        snprintf(inner, sizeof inner, "%s%s", units_name(key->unit), bounds);
        if (single && key->word != NULL)
            snprintf(text, SCHEMA_EXPECTED, "%s, or %s,", inner, key->word);
        else if (single)
            snprintf(text, SCHEMA_EXPECTED, "%s", inner);
        else
            snprintf(text, SCHEMA_EXPECTED, "a list of %zu, each %s,", n_components(key),
                     inner);
        return text;
    case SCHEMA_DIRECTION:
        return "a direction, a list of 3 numbers that are not all 0,";
    case SCHEMA_COUNT:
    case SCHEMA_INT:
        if (single && key->word != NULL)
            snprintf(text, SCHEMA_EXPECTED, "a whole number%s, or %s,", bounds, key->word);
        else if (key->type == SCHEMA_COUNT || single)
            snprintf(text, SCHEMA_EXPECTED, "a whole number%s", bounds);
        else
            snprintf(text, SCHEMA_EXPECTED, "a list of %zu whole numbers%s", n_components(key),
                     bounds);
        return text;
    case SCHEMA_CHOICE:
        choices_describe(key, inner, sizeof inner);
        snprintf(text, SCHEMA_EXPECTED, key->choices[1] != NULL ? "one of %s" : "%s", inner);
        return text;
    case SCHEMA_CHOICES:
        choices_describe(key, inner, sizeof inner);
        snprintf(text, SCHEMA_EXPECTED, "one of %s, or a list of them,", inner);
        return text;
    case SCHEMA_REFERENCE:
        if (single)
            return "the name of a material";
        snprintf(text, SCHEMA_EXPECTED, "a list of the names of %zu materials",
                 n_components(key));
        return text;
    case SCHEMA_NUMBERS:
        snprintf(text, SCHEMA_EXPECTED, "a list, each %s%s,", units_name(key->unit), bounds);
        return text;
    case SCHEMA_POINTS:
        return "a list of points [x, y, z] with lengths";
    case SCHEMA_FACETS:
        return "a list of facets, each a list of 3 or 4 vertex numbers from 0,";
    case SCHEMA_GROUP:
        return "a mapping (key: value)";
    case SCHEMA_LIST:
        snprintf(text, SCHEMA_EXPECTED, "%s list of %s%.0f mappings (- key: value)",
                 key->single ? "a mapping, or a" : "a",
                 (key->bounds & SCHEMA_AT_LEAST) != 0 ? "1 to " : "at most ", key->max);
        return text;
    case SCHEMA_NAMED:
        snprintf(text, SCHEMA_EXPECTED,
                 "a mapping of at most %.0f names to mappings (name: {key: value})", key->max);
        return text;
    case SCHEMA_ELSEWHERE:
        return key->word;
    }
    return "";
}

static const char *kind_described(enum yaml_tree_kind kind)
{
    return kind == YAML_TREE_SCALAR ? "a single value"
           : kind == YAML_TREE_LIST ? "a list"
                                    : "a mapping";
}

/* Lists "path is <what>; <expected> is expected". */
static bool refuse(const struct item *item, const struct yaml_tree_node *node, const char *what)
{
    char text[SCHEMA_EXPECTED];
    mistake(item->reader, node->file, node->line, node->column, "%s is %s; %s is expected",
            item->path, what, schema_expected(item->key, text));
    return false;
}

static bool has_kind(const struct item *item, const struct yaml_tree_node *node,
                     enum yaml_tree_kind kind)
{
    if (node->kind != kind)
        return refuse(item, node,
                      node->kind == YAML_TREE_SCALAR && node->text[0] == '\0'
                          ? "given without a value"
                          : kind_described(node->kind));
    if (kind == YAML_TREE_SCALAR && node->text[0] == '\0' && item->key->type != SCHEMA_TEXT)
        return refuse(item, node, "given without a value");
    return true;
}

static bool refuse_text(const struct item *item, const struct yaml_tree_node *node)
{
    char shown[YAML_TREE_SHOWN], what[YAML_TREE_SHOWN + 2];
    snprintf(what, sizeof what, "'%s'", yaml_tree_shown(shown, node->text));
    return refuse(item, node, what);
}

/* ------------------------------------------------------------------------------- single
 * values */

static bool is_within(const struct schema_key *key, double value)
{
    return (!(key->bounds & SCHEMA_AT_LEAST) || value >= key->min) &&
           (!(key->bounds & SCHEMA_ABOVE) || value > key->min) &&
           (!(key->bounds & SCHEMA_AT_MOST) || value <= key->max) &&
           (!(key->bounds & SCHEMA_BELOW) || value < key->max);
}

static bool number_read(const struct item *item, const struct yaml_tree_node *node,
                        const char *unit, double *value)
{
    char what[256];
    if (!has_kind(item, node, YAML_TREE_SCALAR))
        return false;
    if (item->key->word != NULL && strcmp(node->text, item->key->word) == 0) {
        *value = item->key->word_value;
        return true;
    }
    if (!units_read(node->text, unit, value, what, sizeof what)) {
        mistake(item->reader, node->file, node->line, node->column, "%s: %s", item->path, what);
        return false;
    }
    return is_within(item->key, *value) || refuse_text(item, node);
}

static bool whole_read(const struct item *item, const struct yaml_tree_node *node,
                       int64_t *value)
{
    double number;
    if (!number_read(item, node, "1", &number))
        return false;
    if (!(number >= -9007199254740992.0 && number <= 9007199254740992.0) ||
        (double)(int64_t)number != number)
        return refuse_text(item, node);
    *value = (int64_t)number;
    return true;
}

static bool text_read(const struct item *item, const char **text)
{
    if (!has_kind(item, item->node, YAML_TREE_SCALAR))
        return false;
    *text = item->node->text;
    return item->key->type != SCHEMA_NAME || name_is_valid(*text) ||
           refuse_text(item, item->node);
}

char *schema_path(const char *path, const char *file)
{
    const char *slash = strrchr(file, '/');
    char *joined = path[0] == '/' || slash == NULL
                       ? array_string(path)
                       : array_format("%.*s/%s", (int)(slash - file), file, path);
    char *resolved = realpath(joined, NULL);
    if (resolved == NULL)
        return joined; /* there is no such file: whoever opens it says so */
    free(joined);
    return resolved;
}

static int choice_find(const struct schema_key *key, const char *text)
{
    for (int i = 0; key->choices[i] != NULL; i++)
        if (strcmp(text, key->choices[i]) == 0)
            return i;
    return -1;
}

static bool choice_read(const struct item *item, const struct yaml_tree_node *node, int *choice)
{
    if (!has_kind(item, node, YAML_TREE_SCALAR))
        return false;
    *choice = choice_find(item->key, node->text);
    return *choice >= 0 || refuse_text(item, node);
}

static bool reference_read(const struct item *item, const struct yaml_tree_node *node,
                           int *index)
{
    const struct schema_reader *reader = item->reader;
    *index = -1; /* 0 would be a material */
    if (!has_kind(item, node, YAML_TREE_SCALAR))
        return false;
    for (int i = 0; i < reader->n_names; i++) {
        if (strcmp(node->text, reader->names[i]) == 0) {
            *index = i;
            return true;
        }
    }
    char shown[YAML_TREE_SHOWN];
    const char *near = schema_suggestion(node->text, reader->names, reader->n_names);
    mistake(reader, node->file, node->line, node->column,
            "%s: there is no material '%s'; %s%s%s is expected", item->path,
            yaml_tree_shown(shown, node->text), near != NULL ? "'" : "the name of a material",
            near != NULL ? near : "", near != NULL ? "'" : "");
    return false;
}

/* ------------------------------------------------------------------------------- lists of
 * values */

/* Is the node a list of n elements? */
static bool has_elements(const struct item *item, const struct yaml_tree_node *node, size_t n)
{
    char what[64];
    if (!has_kind(item, node, YAML_TREE_LIST))
        return false;
    snprintf(what, sizeof what, "a list of %d", node->n);
    return (size_t)node->n == n || refuse(item, node, what);
}

static void numbers_read(const struct item *item, double *values)
{
    const size_t n = n_components(item->key);
    if (n == 1) {
        double value = 0.0;
        *values = number_read(item, item->node, item->key->unit, &value) ? value : 0.0;
        return;
    }
    if (!has_elements(item, item->node, n))
        return;
    const struct yaml_tree_node *node = item->node->first;
    for (size_t i = 0; i < n; i++, node = node->next)
        number_read(item, node, item->key->unit, &values[i]);
}

static void direction_read(const struct item *item, double *values)
{
    struct schema_key component = *item->key;
    component.type = SCHEMA_NUMBER;
    component.unit = "1";
    struct item numbers = *item;
    numbers.key = &component;
    const int n_before = item->reader->mistakes->n;
    numbers_read(&numbers, values);
    if (item->reader->mistakes->n > n_before)
        return;
    const double square = values[0] * values[0] + values[1] * values[1] + values[2] * values[2];
    if (!(square > 1e-200) || !isfinite(square)) {
        refuse(item, item->node, "a list without a usable length");
        return;
    }
    if (fabs(square - 1.0) < 1e-14) /* already of length 1: not to be rounded once more */
        return;
    const double length = sqrt(square);
    for (int i = 0; i < 3; i++)
        values[i] = values[i] / length;
}

static void integers_read(const struct item *item, int *values)
{
    const size_t n = n_components(item->key);
    int64_t value = 0;
    if (n == 1) {
        *values = whole_read(item, item->node, &value) ? (int)value : 0;
        return;
    }
    if (!has_elements(item, item->node, n))
        return;
    const struct yaml_tree_node *node = item->node->first;
    for (size_t i = 0; i < n; i++, node = node->next)
        values[i] = whole_read(item, node, &value) ? (int)value : 0;
}

static void choices_read(const struct item *item, int *set)
{
    int choice;
    if (item->node->kind != YAML_TREE_LIST) {
        if (choice_read(item, item->node, &choice))
            *set = 1 << choice;
        return;
    }
    for (const struct yaml_tree_node *node = item->node->first; node != NULL; node = node->next)
        if (choice_read(item, node, &choice))
            *set |= 1 << choice;
}

static void references_read(const struct item *item, int *indices)
{
    const size_t n = n_components(item->key);
    if (n == 1) {
        reference_read(item, item->node, indices);
        return;
    }
    memset(indices, -1, n * sizeof *indices);
    if (!has_elements(item, item->node, n))
        return;
    const struct yaml_tree_node *node = item->node->first;
    for (size_t i = 0; i < n; i++, node = node->next)
        reference_read(item, node, &indices[i]);
}

static void store_list(const struct item *item, void *list, int n)
{
    memcpy(item->into + item->key->offset, &list, sizeof list);
    memcpy(item->into + item->key->count, &n, sizeof n);
}

static void number_list_read(const struct item *item)
{
    if (!has_kind(item, item->node, YAML_TREE_LIST))
        return;
    double *values = array_allocate((size_t)item->node->n, sizeof *values);
    int n = 0;
    for (const struct yaml_tree_node *node = item->node->first; node != NULL; node = node->next)
        number_read(item, node, item->key->unit, &values[n++]);
    store_list(item, values, n);
}

static void points_read(const struct item *item)
{
    if (!has_kind(item, item->node, YAML_TREE_LIST))
        return;
    struct vec3 *points = array_allocate((size_t)item->node->n, sizeof *points);
    int i = 0;
    for (const struct yaml_tree_node *node = item->node->first; node != NULL;
         node = node->next, i++) {
        if (!has_elements(item, node, 3))
            continue;
        number_read(item, node->first, "m", &points[i].x);
        number_read(item, node->first->next, "m", &points[i].y);
        number_read(item, node->last, "m", &points[i].z);
    }
    store_list(item, points, i);
}

static void facets_read(const struct item *item)
{
    if (!has_kind(item, item->node, YAML_TREE_LIST))
        return;
    int(*facets)[4] = array_allocate((size_t)item->node->n, sizeof *facets);
    int i = 0;
    for (const struct yaml_tree_node *node = item->node->first; node != NULL;
         node = node->next, i++) {
        facets[i][3] = -1;
        if (node->kind != YAML_TREE_LIST || (node->n != 3 && node->n != 4)) {
            refuse(item, node, "wrong here");
            continue;
        }
        int k = 0;
        for (const struct yaml_tree_node *v = node->first; v != NULL; v = v->next, k++) {
            int64_t vertex;
            if (whole_read(item, v, &vertex))
                facets[i][k] = (int)vertex;
        }
    }
    store_list(item, facets, i);
}

/* ------------------------------------------------------------------------------- tables */

static const char *path_join(char path[PATH_LENGTH], const char *parent, const char *key)
{
    snprintf(path, PATH_LENGTH, "%s%s%s", parent, parent[0] != '\0' ? "." : "", key);
    return path;
}

static int by_key(const void *a, const void *b)
{
    const struct yaml_tree_node *const *p = a, *const *q = b;
    return strcmp((*p)->key, (*q)->key);
}

/* Elements of a list or, sorted by name, of a mapping: the order of a mapping means nothing. */
static const struct yaml_tree_node **elements_sorted(const struct yaml_tree_node *node)
{
    const struct yaml_tree_node **elements = array_allocate((size_t)node->n, sizeof *elements);
    int n = 0;
    for (const struct yaml_tree_node *child = node->first; child != NULL; child = child->next)
        elements[n++] = child;
    if (node->kind == YAML_TREE_MAPPING)
        qsort(elements, (size_t)n, sizeof *elements, by_key);
    return elements;
}

static void elements_read(const struct item *item)
{
    const struct schema_key *key = item->key;
    const struct yaml_tree_node *node = item->node;
    const bool named = key->type == SCHEMA_NAMED;
    if (!has_kind(item, node, named ? YAML_TREE_MAPPING : YAML_TREE_LIST))
        return;
    if (!is_within(key, node->n)) {
        char what[64];
        snprintf(what, sizeof what, "%s of %d", kind_described(node->kind), node->n);
        refuse(item, node, what);
        return;
    }
    char *list = array_allocate((size_t)node->n, key->element);
    const struct yaml_tree_node **elements = elements_sorted(node);
    for (int i = 0; i < node->n; i++) {
        char number[16], path[PATH_LENGTH], shown[YAML_TREE_SHOWN];
        char *element = list + (size_t)i * key->element;
        snprintf(number, sizeof number, "%d", i);
        path_join(path, item->path, named ? yaml_tree_shown(shown, elements[i]->key) : number);
        if (named && !name_is_valid(elements[i]->key))
            mistake(
                item->reader, elements[i]->file, elements[i]->key_line, elements[i]->key_column,
                "%s is no name; letters, digits, - and _ are expected (a letter first, at most "
                "40)",
                path);
        if (named) {
            char *name = array_string(elements[i]->key);
            memcpy(element, &name, sizeof name);
        }
        schema_read(item->reader, key->inside, elements[i], path, element);
    }
    free(elements);
    store_list(item, list, node->n);
}

/* A mapping that stands for a list of one. */
static void element_read(const struct item *item)
{
    char *element = array_allocate(1, item->key->element);
    schema_read(item->reader, item->key->inside, item->node, item->path, element);
    store_list(item, element, 1);
}

static void value_read(const struct item *item)
{
    void *into = item->into + item->key->offset;
    const char *text;
    char *copy;
    int choice;
    switch (item->key->type) {
    case SCHEMA_TEXT:
    case SCHEMA_NAME:
    case SCHEMA_FILE:
        if (!text_read(item, &text))
            break;
        copy = item->key->type == SCHEMA_FILE ? schema_path(text, item->node->file)
                                              : array_string(text);
        memcpy(into, &copy, sizeof copy);
        break;
    case SCHEMA_FLAG:
        if (!has_kind(item, item->node, YAML_TREE_SCALAR))
            break;
        *(bool *)into = strcmp(item->node->text, "true") == 0;
        if (!*(bool *)into && strcmp(item->node->text, "false") != 0)
            refuse_text(item, item->node);
        break;
    case SCHEMA_NUMBER:
        numbers_read(item, into);
        break;
    case SCHEMA_DIRECTION:
        direction_read(item, into);
        break;
    case SCHEMA_COUNT:
        whole_read(item, item->node, into);
        break;
    case SCHEMA_INT:
        integers_read(item, into);
        break;
    case SCHEMA_CHOICE:
        if (choice_read(item, item->node, &choice) && item->key->size > 0)
            memcpy(into, &choice, sizeof choice);
        break;
    case SCHEMA_CHOICES:
        choices_read(item, into);
        break;
    case SCHEMA_REFERENCE:
        references_read(item, into);
        break;
    case SCHEMA_NUMBERS:
        number_list_read(item);
        break;
    case SCHEMA_POINTS:
        points_read(item);
        break;
    case SCHEMA_FACETS:
        facets_read(item);
        break;
    case SCHEMA_GROUP:
        schema_read(item->reader, item->key->inside, item->node, item->path, into);
        break;
    case SCHEMA_LIST:
    case SCHEMA_NAMED:
        if (item->key->single && item->node->kind == YAML_TREE_MAPPING)
            element_read(item);
        else
            elements_read(item);
        break;
    case SCHEMA_ELSEWHERE:
        break;
    }
    if (item->key->given_size == sizeof(bool))
        *(bool *)(item->into + item->key->given) = true;
}

/* Gives a key that the file leaves out its default. */
static void default_read(struct item *item)
{
    const char *standard = item->key->standard;
    struct yaml_tree tree = {0};
    struct yaml_tree_node scalar = {
        .kind = YAML_TREE_SCALAR, .file = "default", .text = standard};
    item->node = &scalar;
    if (standard[0] == '[') {
        const bool fine = yaml_tree_parse(&tree, "default", 1, standard, strlen(standard),
                                          item->reader->mistakes);
        CHECK(fine, "the default of %s is not YAML", item->path);
        item->node = tree.root;
    }
    value_read(item);
    item->node = NULL;
    yaml_tree_clear(&tree);
}

bool schema_tells_kind(const struct schema_key *key)
{
    return key->type == SCHEMA_CHOICE && key->size > 0 &&
           (strcmp(key->name, "kind") == 0 || strcmp(key->name, "model") == 0);
}

/* What the mapping says under `kind`: the index of the choice, 0 where the table knows no
 * kinds, -1 where it says nothing usable. */
static int kind_find(const struct schema_key *table, const struct yaml_tree_node *node)
{
    const struct schema_key *key = table;
    while (key->name != NULL && !schema_tells_kind(key))
        key++;
    if (key->name == NULL)
        return 0;
    const struct yaml_tree_node *kind = yaml_tree_find(node, key->name);
    if (kind == NULL)
        return key->standard != NULL ? choice_find(key, key->standard) : -1;
    return kind->kind != YAML_TREE_SCALAR ? -1 : choice_find(key, kind->text);
}

static bool applies(const struct schema_key *key, int kind)
{
    return key->kinds == 0 || (kind >= 0 && (key->kinds >> kind & 1u) != 0);
}

/* Lists a key that the table does not have, with the one that was probably meant. */
static void unknown_report(const struct schema_reader *reader, const struct schema_key *table,
                           int kind, const struct yaml_tree_node *child, const char *path)
{
    const char *candidates[64];
    char all[SCHEMA_EXPECTED] = "", where[PATH_LENGTH], shown[YAML_TREE_SHOWN];
    int n = 0;
    size_t used = 0;
    for (const struct schema_key *key = table; key->name != NULL && n < 64; key++) {
        if (!applies(key, kind))
            continue;
        if (used < sizeof all)
            used += (size_t)snprintf(all + used, sizeof all - used, "%s%s", n > 0 ? ", " : "",
                                     key->name);
        candidates[n++] = key->name;
    }
    path_join(where, path, yaml_tree_shown(shown, child->key));
    const char *near = schema_suggestion(child->key, candidates, n);
    if (near != NULL)
        mistake(reader, child->file, child->key_line, child->key_column,
                "unknown key %s; '%s' is expected", where, near);
    else
        mistake(reader, child->file, child->key_line, child->key_column,
                "unknown key %s; one of %s is expected", where, all);
}

/* Lists a key that is for another kind than the mapping's. */
static void kind_report(const struct schema_reader *reader, const struct schema_key *table,
                        int kind, const struct yaml_tree_node *child, const char *path)
{
    char where[PATH_LENGTH];
    const struct schema_key *key = table;
    while (!schema_tells_kind(key))
        key++;
    mistake(reader, child->file, child->key_line, child->key_column,
            "%s does not go with %s %s; a key of that %s is expected",
            path_join(where, path, child->key), key->name, key->choices[kind], key->name);
}

static void keys_check(const struct schema_reader *reader, const struct schema_key *table,
                       int kind, const struct yaml_tree_node *node, const char *path)
{
    for (const struct yaml_tree_node *child = node->first; child != NULL; child = child->next) {
        const struct schema_key *key = table;
        while (key->name != NULL && strcmp(key->name, child->key) != 0)
            key++;
        if (key->name == NULL)
            unknown_report(reader, table, kind, child, path);
        else if (kind >= 0 && !applies(key, kind))
            kind_report(reader, table, kind, child, path);
        if (reader->mistakes->n > SCHEMA_MISTAKES)
            break;
    }
}

static void missing_report(const struct item *item, const struct yaml_tree_node *parent)
{
    char text[SCHEMA_EXPECTED];
    mistake(item->reader, parent->file, parent->line, parent->column,
            "%s is missing; %s is expected", item->path, schema_expected(item->key, text));
}

void schema_read(const struct schema_reader *reader, const struct schema_key *table,
                 const struct yaml_tree_node *node, const char *path, void *into)
{
    if (node->kind != YAML_TREE_MAPPING) {
        mistake(reader, node->file, node->line, node->column,
                "%s is %s; a mapping (key: value) is expected",
                path[0] != '\0' ? path : "the file", kind_described(node->kind));
        return;
    }
    const int kind = kind_find(table, node);
    keys_check(reader, table, kind, node, path);
    for (const struct schema_key *key = table; key->name != NULL; key++) {
        char own_path[PATH_LENGTH];
        struct item item = {reader, key, yaml_tree_find(node, key->name),
                            path_join(own_path, path, key->name), into};
        struct yaml_tree_node nothing = {.kind = YAML_TREE_MAPPING,
                                         .file = node->file,
                                         .line = node->line,
                                         .column = node->column};
        if (!applies(key, kind))
            continue;
        if (item.node != NULL) {
            value_read(&item);
        } else if (key->required) {
            missing_report(&item, node);
        } else if (key->standard != NULL) {
            default_read(&item);
        } else if (key->type == SCHEMA_GROUP && key->given_size == 0) {
            item.node = &nothing; /* all of its keys have their defaults */
            value_read(&item);
        }
    }
}

/* ------------------------------------------------------------------------------- freeing */

void schema_clear(const struct schema_key *table, void *from)
{
    for (const struct schema_key *key = table; key->name != NULL; key++) {
        char *place = (char *)from + key->offset;
        const bool list = key->type == SCHEMA_LIST || key->type == SCHEMA_NAMED;
        if (key->type == SCHEMA_GROUP)
            schema_clear(key->inside, place);
        for (int i = 0; list && i < *(const int *)((char *)from + key->count); i++) {
            char *element = *(char **)place + (size_t)i * key->element;
            schema_clear(key->inside, element);
            if (key->type == SCHEMA_NAMED)
                free(*(char **)element);
        }
        if (list || key->type == SCHEMA_TEXT || key->type == SCHEMA_NAME ||
            key->type == SCHEMA_FILE || key->type == SCHEMA_NUMBERS ||
            key->type == SCHEMA_POINTS || key->type == SCHEMA_FACETS) {
            free(*(void **)place);
            *(void **)place = NULL;
        }
    }
}
