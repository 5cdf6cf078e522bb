/*
 * See sweep.h.
 *
 * The entries of the list are axes, each of one column of values, or of several that vary
 * together; what the axes span is written out in full, as there are few variants beside what a
 * run of any of them costs.
 */
#include "job/sweep.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/elementary.h"
#include "base/report.h"
#include "job/job_keys.h"
#include "job/schema.h"
#include "job/yaml_tree.h"

enum {
    PATH_LENGTH = 64,
    WORD_LENGTH = 24,
    TEXT_LENGTH = 100,
    FOLDER_LENGTH = 200,
    KEYS_MOST = 100
};

/* The values of a key. */
struct column {
    const struct sweep_item *item;
    const struct yaml_tree_node *entry, *place; /* the mapping, and its key */
    char *name;
    int n;
    const struct yaml_tree_node **nodes;
    char **texts, **words; /* as the job writes them; as folders are called */
};

struct axis {
    int first, n_columns, n; /* values */
};

struct plan {
    struct yaml_tree *tree;
    struct mistakes *mistakes;
    int n_axes, n_columns, column_capacity;
    struct sweep_item *items; /* an item an axis */
    struct axis *axes;
    struct column *columns;
};

static void refuse(const struct plan *plan, const struct yaml_tree_node *node,
                   const char *format, ...) __attribute__((format(printf, 3, 4)));
static void refuse(const struct plan *plan, const struct yaml_tree_node *node,
                   const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    mistakes_add(plan->mistakes, node->file, node->line, node->column, "%s", text);
}

/* Is the second key the first one, or inside it? */
static bool covers(const char *outer, const char *key)
{
    const size_t n = strlen(outer);
    return strncmp(outer, key, n) == 0 && (key[n] == '\0' || key[n] == '.');
}

/* ------------------------------------------------------------------------------- a range */

/* A number and what is written behind it. */
struct quantity {
    double value;
    const char *unit;
};

static bool quantity_read(const struct plan *plan, const struct column *column,
                          const char *path, const char *key, const char *text,
                          struct quantity *quantity)
{
    char *end, shown[YAML_TREE_SHOWN];
    const struct yaml_tree_node *node = yaml_tree_find(column->entry, key);
    if (text == NULL) {
        refuse(plan, column->entry,
               "%s.%s is missing; values, or from, to and count, are expected", path, key);
        return false;
    }
    quantity->value = strtod(text, &end);
    quantity->unit = end + strspn(end, " \t");
    if (end != text && isfinite(quantity->value))
        return true;
    refuse(plan, node, "%s.%s is '%s'; a number, with or without a unit, is expected", path,
           key, yaml_tree_shown(shown, text));
    return false;
}

/* The k-th of n values, at least two. */
static double value_between(double from, double to, enum sweep_spacing spacing, int k, int n)
{
    const double share = (double)k / (double)(n - 1);
    if (spacing == SWEEP_LINEAR)
        return from + (to - from) * share;
    const double low = elementary_log(from);
    return elementary_exp(low + (elementary_log(to) - low) * share);
}

/* Values from `from` to `to`, whose own texts are the first and the last. */
static void range_make(struct plan *plan, struct column *column, const char *path)
{
    const struct sweep_item *item = column->item;
    struct quantity from, to;
    if (!quantity_read(plan, column, path, "from", item->from, &from) ||
        !quantity_read(plan, column, path, "to", item->to, &to))
        return;
    const struct yaml_tree_node *place = yaml_tree_find(column->entry, "from");
    if (strcmp(from.unit, to.unit) != 0)
        refuse(plan, yaml_tree_find(column->entry, "to"),
               "%s.to is in another unit than %s.from; the same is expected", path, path);
    else if (item->spacing == SWEEP_LOG && !(from.value > 0.0 && to.value > 0.0))
        refuse(plan, place, "%s: equal ratios do not reach 0; values above it are expected",
               path);
    else if (item->count == 0)
        refuse(plan, column->entry, "%s.count is missing; a whole number from 2 on is expected",
               path);
    else
        column->n = item->count;
    column->nodes = array_allocate((size_t)column->n, sizeof *column->nodes);
    for (int k = 0; k < column->n; k++) {
        struct yaml_tree_node *node = yaml_tree_new(plan->tree, YAML_TREE_SCALAR, place);
        const double value = value_between(from.value, to.value, item->spacing, k, column->n);
        char *text =
            k == 0 ? array_string(item->from)
            : k == column->n - 1
                ? array_string(item->to)
                : array_format("%.12g%s%s", value, from.unit[0] != '\0' ? " " : "", from.unit);
        node->text = yaml_tree_text(plan->tree, text, strlen(text));
        column->nodes[k] = node;
        free(text);
    }
}

/* ------------------------------------------------------------------------------- a column */

static void values_take(struct plan *plan, struct column *column,
                        const struct yaml_tree_node *values, const char *path)
{
    const struct sweep_item *item = column->item;
    if (item->from != NULL || item->to != NULL || item->count > 0)
        refuse(plan, column->entry,
               "%s has values and a range; values, or from, to and count, are expected", path);
    else if (values->kind != YAML_TREE_LIST || values->n == 0 || values->n > SWEEP_MOST)
        refuse(plan, values, "%s.values is no list of them; a list of 1 to %d is expected",
               path, SWEEP_MOST);
    else
        column->n = values->n;
    column->nodes = array_allocate((size_t)column->n, sizeof *column->nodes);
    const struct yaml_tree_node *value = values->first;
    for (int k = 0; k < column->n; k++, value = value->next)
        column->nodes[k] = value;
}

/* Is it made of letters, digits and points, as keys are? */
static bool is_path(const char *key)
{
    static const char usual[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                "0123456789_.-";
    return isalpha((unsigned char)key[0]) && strspn(key, usual) == strlen(key);
}

/* The last word of a key that does not count: "radius" of spheres.0.radius. */
static char *last_word(const char *key)
{
    const char *word = key;
    for (const char *c = key; *c != '\0'; c++)
        if (*c == '.' && !isdigit((unsigned char)c[1]))
            word = c + 1;
    return array_format("%.*s", (int)strcspn(word, "."), word);
}

static void node_print(FILE *out, const struct yaml_tree_node *node)
{
    const bool list = node->kind == YAML_TREE_LIST;
    if (node->kind == YAML_TREE_SCALAR) {
        fputs(node->text, out);
        return;
    }
    fputc(list ? '[' : '{', out);
    for (const struct yaml_tree_node *child = node->first; child != NULL; child = child->next) {
        fputs(child != node->first ? ", " : "", out);
        if (!list)
            fprintf(out, "%s: ", child->key);
        node_print(out, child);
    }
    fputc(list ? ']' : '}', out);
}

static char *node_text(const struct yaml_tree_node *node)
{
    char *text = NULL;
    size_t n = 0;
    FILE *out = open_memstream(&text, &n);
    CHECK(out != NULL, "out of memory for a value");
    node_print(out, node);
    CHECK(fclose(out) == 0, "out of memory for a value");
    return text;
}

/* The text without blanks where that makes a good part of a file's name; else NULL. */
static char *word_of(const char *text)
{
    char *word = array_string(text), *to = word;
    for (const char *c = text; *c != '\0'; c++)
        if (*c != ' ')
            *to++ = *c;
    *to = '\0';
    for (const char *c = word; *c != '\0'; c++)
        if (!isalnum((unsigned char)*c) && strchr(".+-", *c) == NULL)
            *word = '\0';
    if (word[0] != '\0' && strlen(word) <= WORD_LENGTH)
        return word;
    free(word);
    return NULL;
}

/* What the values are called in the names of folders: as they are written, or, where one of
 * them makes no name or two the same, v1, v2 and so on. */
static void words_make(struct column *column)
{
    bool good = true;
    column->texts = array_allocate((size_t)column->n, sizeof *column->texts);
    column->words = array_allocate((size_t)column->n, sizeof *column->words);
    for (int k = 0; k < column->n; k++) {
        column->texts[k] = node_text(column->nodes[k]);
        column->words[k] = word_of(column->texts[k]);
        good = good && column->words[k] != NULL;
        for (int i = 0; i < k && good; i++)
            good = strcmp(column->words[i], column->words[k]) != 0 ||
                   strcmp(column->texts[i], column->texts[k]) == 0;
    }
    for (int k = 0; k < column->n && !good; k++) {
        free(column->words[k]);
        column->words[k] = array_format("v%d", k + 1);
    }
}

static void column_add(struct plan *plan, const struct sweep_item *item,
                       const struct yaml_tree_node *entry, const char *path)
{
    ARRAY_GROW(plan->columns, plan->n_columns + 1, plan->column_capacity);
    struct column *column = &plan->columns[plan->n_columns++];
    const struct yaml_tree_node *values = yaml_tree_find(entry, "values");
    char shown[YAML_TREE_SHOWN];
    *column =
        (struct column){.item = item, .entry = entry, .place = yaml_tree_find(entry, "key")};
    if (item->key == NULL || item->key[0] == '\0') {
        refuse(plan, entry,
               "%s.key is missing; the key that varies, like spheres.0.radius, is expected",
               path);
        return;
    }
    if (!is_path(item->key)) {
        refuse(plan, column->place, "%s.key is '%s'; a path like spheres.0.radius is expected",
               path, yaml_tree_shown(shown, item->key));
        return;
    }
    if (covers("sweep", item->key))
        refuse(plan, column->place, "%s.key is the sweep itself; another key is expected",
               path);
    column->name = item->name != NULL ? array_string(item->name) : last_word(item->key);
    if (values != NULL)
        values_take(plan, column, values, path);
    else
        range_make(plan, column, path);
    words_make(column);
}

/* ------------------------------------------------------------------------------- an axis */

/* Do two values of an axis agree in all of its columns? */
static bool are_equal(const struct plan *plan, const struct axis *axis, int i, int k)
{
    bool equal = true;
    for (int c = axis->first; c < axis->first + axis->n_columns && equal; c++)
        equal = strcmp(plan->columns[c].texts[i], plan->columns[c].texts[k]) == 0;
    return equal;
}

static void axis_check(const struct plan *plan, const struct axis *axis, const char *path)
{
    for (int c = axis->first; c < axis->first + axis->n_columns; c++) {
        if (plan->columns[c].n == 0)
            return; /* which has been said */
        if (plan->columns[c].n == axis->n)
            continue;
        refuse(plan, plan->columns[c].entry,
               "%s.together: '%s' has %d values and '%s' %d; as many are expected", path,
               plan->columns[c].name, plan->columns[c].n, plan->columns[axis->first].name,
               axis->n);
        return;
    }
    for (int k = 0; k < axis->n; k++)
        for (int i = 0; i < k; i++)
            if (are_equal(plan, axis, i, k)) {
                refuse(plan, plan->columns[axis->first].nodes[k],
                       "%s: value %d is the same as value %d; values that differ are expected",
                       path, k + 1, i + 1);
                return;
            }
}

static void axis_add(struct plan *plan, const struct yaml_tree_node *entry)
{
    const struct schema_reader reader = {.mistakes = plan->mistakes};
    const int n_before = plan->mistakes->n, number = plan->n_axes;
    struct axis *axis = &plan->axes[plan->n_axes];
    struct sweep_item *item = &plan->items[plan->n_axes++];
    char path[PATH_LENGTH], inner[PATH_LENGTH];
    snprintf(path, sizeof path, "sweep.%d", number);
    schema_read(&reader, job_keys_sweep, entry, path, item);
    *axis = (struct axis){.first = plan->n_columns};
    if (plan->mistakes->n > n_before)
        return;
    const struct yaml_tree_node *together = yaml_tree_find(entry, "together");
    if (together != NULL && (entry->n > 1 || together->n == 0))
        refuse(plan, entry,
               "%s.together stands beside other keys, or is empty; keys that vary "
               "together, in it alone, are expected",
               path);
    else if (together == NULL)
        column_add(plan, item, entry, path);
    for (int k = 0; k < item->n_together; k++) {
        snprintf(inner, sizeof inner, "sweep.%d.together.%d", number, k);
        column_add(plan, &item->together[k], yaml_tree_child(together, k), inner);
    }
    axis->n_columns = plan->n_columns - axis->first;
    axis->n = axis->n_columns > 0 ? plan->columns[axis->first].n : 0;
    if (plan->mistakes->n == n_before)
        axis_check(plan, axis, path);
}

/* ------------------------------------------------------------------------------- all of it */

static void columns_compare(const struct plan *plan)
{
    for (int k = 1; k < plan->n_columns; k++)
        for (int i = 0; i < k; i++) {
            const struct column *p = &plan->columns[i], *q = &plan->columns[k];
            if (covers(p->item->key, q->item->key) || covers(q->item->key, p->item->key))
                refuse(plan, q->place,
                       "'%s' and '%s' (line %d) vary the same; keys that have nothing in "
                       "common are expected",
                       q->item->key, p->item->key, p->place->line);
            else if (strcmp(p->name, q->name) == 0)
                refuse(plan, q->place,
                       "both this and the key in line %d are called '%s'; a name of its own, "
                       "name: ..., is expected",
                       p->place->line, p->name);
        }
}

/* How many variants there are; 0 with a mistake listed when there are too many. */
static int count_variants(const struct plan *plan, const struct yaml_tree_node *list)
{
    long n = 1;
    if (plan->n_columns > KEYS_MOST)
        refuse(plan, list, "sweep has %d keys; at most %d are expected", plan->n_columns,
               KEYS_MOST);
    for (int a = 0; a < plan->n_axes; a++) {
        n *= plan->axes[a].n;
        if (n > SWEEP_MOST) {
            refuse(plan, list, "sweep has more than %d variants; fewer are expected",
                   SWEEP_MOST);
            return 0;
        }
    }
    return plan->n_columns <= KEYS_MOST ? (int)n : 0;
}

static char *folder_make(const struct plan *plan, const int *chosen, int variant)
{
    char *folder = array_string("");
    for (int c = 0; c < plan->n_columns; c++) {
        char *longer = array_format("%s%s%s_%s", folder, c > 0 ? "_" : "",
                                    plan->columns[c].name, plan->columns[c].words[chosen[c]]);
        free(folder);
        folder = longer;
    }
    if (strlen(folder) <= FOLDER_LENGTH)
        return folder;
    free(folder);
    return array_format("variant_%d", variant + 1);
}

/* A value for a line of text: as it is written, or, where that is long or steers a terminal,
 * as the folder calls it. */
static const char *value_shown(const struct column *column, int k)
{
    bool fits = strlen(column->texts[k]) <= TEXT_LENGTH;
    for (const char *c = column->texts[k]; *c != '\0'; c++)
        fits = fits && (unsigned char)*c >= ' ' && *c != 127;
    return fits ? column->texts[k] : column->words[k];
}

static void variant_make(struct sweep *sweep, const struct plan *plan, int variant)
{
    int *chosen = array_allocate((size_t)plan->n_columns, sizeof *chosen);
    for (int a = plan->n_axes - 1, rest = variant; a >= 0; a--) {
        const struct axis *axis = &plan->axes[a];
        for (int c = axis->first; c < axis->first + axis->n_columns; c++)
            chosen[c] = rest % axis->n;
        rest /= axis->n;
    }
    for (int c = 0; c < plan->n_columns; c++) {
        const size_t at = (size_t)variant * (size_t)plan->n_columns + (size_t)c;
        sweep->nodes[at] = plan->columns[c].nodes[chosen[c]];
        sweep->values[at] = array_string(value_shown(&plan->columns[c], chosen[c]));
    }
    sweep->folders[variant] = folder_make(plan, chosen, variant);
    free(chosen);
}

static void expand(struct sweep *sweep, const struct plan *plan, int n_variants)
{
    const size_t n_keys = (size_t)plan->n_columns, n = (size_t)n_variants * n_keys;
    *sweep =
        (struct sweep){.n_keys = plan->n_columns,
                       .n_variants = n_variants,
                       .keys = array_allocate(n_keys, sizeof *sweep->keys),
                       .names = array_allocate(n_keys, sizeof *sweep->names),
                       .folders = array_allocate((size_t)n_variants, sizeof *sweep->folders),
                       .values = array_allocate(n, sizeof *sweep->values),
                       .nodes = array_allocate(n, sizeof *sweep->nodes),
                       .places = array_allocate(n_keys, sizeof *sweep->places)};
    for (int c = 0; c < plan->n_columns; c++) {
        sweep->keys[c] = array_string(plan->columns[c].item->key);
        sweep->names[c] = array_string(plan->columns[c].name);
        sweep->places[c] = plan->columns[c].place;
    }
    for (int v = 0; v < n_variants; v++)
        variant_make(sweep, plan, v);
}

static void plan_clear(struct plan *plan)
{
    for (int c = 0; c < plan->n_columns; c++) {
        struct column *column = &plan->columns[c];
        for (int k = 0; k < column->n; k++) {
            free(column->texts[k]);
            free(column->words[k]);
        }
        free(column->name);
        free(column->nodes);
        free(column->texts);
        free(column->words);
    }
    for (int a = 0; a < plan->n_axes; a++)
        schema_clear(job_keys_sweep, &plan->items[a]);
    free(plan->columns);
    free(plan->items);
    free(plan->axes);
}

bool sweep_read(struct sweep *sweep, struct yaml_tree *tree, struct mistakes *mistakes)
{
    const struct yaml_tree_node *list = yaml_tree_find(tree->root, "sweep");
    struct plan plan = {.tree = tree, .mistakes = mistakes};
    const int n_before = mistakes->n;
    *sweep = (struct sweep){0};
    if (list == NULL)
        return true;
    if (list->kind != YAML_TREE_LIST || list->n > KEYS_MOST) {
        refuse(&plan, list,
               "sweep is no list of at most %d mappings (- key: value); that is expected",
               KEYS_MOST);
        return false;
    }
    plan.items = array_allocate((size_t)list->n, sizeof *plan.items);
    plan.axes = array_allocate((size_t)list->n, sizeof *plan.axes);
    for (const struct yaml_tree_node *entry = list->first; entry != NULL; entry = entry->next)
        axis_add(&plan, entry);
    if (mistakes->n == n_before)
        columns_compare(&plan);
    const int n = mistakes->n == n_before && list->n > 0 ? count_variants(&plan, list) : 0;
    if (n > 0)
        expand(sweep, &plan, n);
    plan_clear(&plan);
    return mistakes->n == n_before;
}

void sweep_apply(const struct sweep *sweep, int variant, struct yaml_tree *tree,
                 struct mistakes *mistakes)
{
    const size_t n = (size_t)sweep->n_keys, first = (size_t)(variant - 1) * n;
    CHECK(variant > 0 && variant <= sweep->n_variants, "variant %d of %d", variant,
          sweep->n_variants);
    for (size_t k = 0; k < n; k++)
        yaml_tree_put(tree, tree->root, sweep->keys[k], sweep->nodes[first + k],
                      sweep->places[k], mistakes);
}

void sweep_refuse(const struct sweep *sweep, const char *override, struct mistakes *mistakes)
{
    char *key = array_string(override);
    key[strcspn(key, "=")] = '\0';
    for (int k = 0; k < sweep->n_keys; k++)
        if (covers(sweep->keys[k], key))
            mistakes_add(mistakes, "--set", 1, 1,
                         "'%s' varies in the sweep; another key is expected, or sweep=[] for a "
                         "run without it",
                         sweep->keys[k]);
    free(key);
}

void sweep_forget_places(struct sweep *sweep)
{
    free(sweep->nodes);
    free(sweep->places);
    sweep->nodes = sweep->places = NULL;
}

void sweep_clear(struct sweep *sweep)
{
    for (int k = 0; k < sweep->n_keys; k++) {
        free(sweep->keys[k]);
        free(sweep->names[k]);
    }
    for (int v = 0; v < sweep->n_variants; v++)
        free(sweep->folders[v]);
    for (int i = 0; i < sweep->n_variants * sweep->n_keys; i++)
        free(sweep->values[i]);
    free(sweep->keys);
    free(sweep->names);
    free(sweep->folders);
    free(sweep->values);
    sweep_forget_places(sweep);
    *sweep = (struct sweep){0};
}

const char *sweep_value(const struct sweep *sweep, int variant, int key)
{
    return sweep->values[(variant - 1) * sweep->n_keys + key];
}

char *sweep_describe(const struct sweep *sweep, int variant)
{
    char *text = array_string("");
    for (int k = 0; k < sweep->n_keys; k++) {
        char *longer = array_format("%s%s%s %s", text, k > 0 ? ", " : "", sweep->names[k],
                                    sweep_value(sweep, variant, k));
        free(text);
        text = longer;
    }
    return text;
}
