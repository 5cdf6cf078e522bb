/*
 * tremie-compare: are two states, or two series, the same to the last bit?
 *
 * Whatever the files hold is compared, field by field: numbers as 64-bit integers, so that -0
 * is not 0 and a NaN equals itself; a field that only one has, or that has another shape, is a
 * difference.  The distance of two doubles is given in units in the last place (ulp): how many
 * doubles lie between.  Left out are the checksums and descriptions, which follow from the
 * rest, the timings of a series file, and, unless --all is given, the job's text and title (the
 * end of a job, say, may differ).
 */
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "arguments.h"
#include "base/array.h"
#include "base/report.h"
#include "content.h"
#include "records.h"
#include "sheet.h"

enum { EQUAL = 0, DIFFERENT = 1, CANNOT_COMPARE = 2, LABEL_SIZE = 96 };

/* What is known of a comparison so far. */
struct comparison {
    int shown_most; /* differences shown of each field */
    bool all;
    int n_fields, n_different;
    struct sheet summary; /* of the fields that differ */
};

/* The columns that name the rows of a group: their ids. */
struct labels {
    const char *group;
    int n_columns;
    const char *names[3];
    int64_t *values[3];
    int64_t n_rows;
};

/* Two arrays of the same length and kind. */
struct pair {
    const char *name;
    int64_t n_rows, width;
    const int64_t *ints[2];   /* or NULL, */
    const double *doubles[2]; /* then these */
};

/* ------------------------------------------------------------------------------ the numbers */

/* Doubles in their order as integers: neighbours differ by 1, and -0 and 0 too. */
static int64_t place_of(double value)
{
    int64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits >= 0 ? bits : INT64_MIN - bits - 1;
}

static uint64_t distance(const struct pair *pair, int64_t i)
{
    const bool whole = pair->ints[0] != NULL;
    const int64_t a = whole ? pair->ints[0][i] : place_of(pair->doubles[0][i]);
    const int64_t b = whole ? pair->ints[1][i] : place_of(pair->doubles[1][i]);
    return a > b ? (uint64_t)a - (uint64_t)b : (uint64_t)b - (uint64_t)a;
}

static void write_label(char label[LABEL_SIZE], const struct labels *labels,
                        const struct pair *pair, int64_t i)
{
    const int64_t row = i / pair->width;
    int used = 0;
    if (labels == NULL || row >= labels->n_rows)
        used = pair->n_rows > 1 ? snprintf(label, LABEL_SIZE, "row %" PRId64, row) : 0;
    else
        for (int k = 0; k < labels->n_columns; k++)
            used += snprintf(label + used, LABEL_SIZE - (size_t)used, "%s%s %" PRId64,
                             k > 0 ? ", " : "", labels->names[k], labels->values[k][row]);
    if (pair->width > 1)
        used +=
            snprintf(label + used, LABEL_SIZE - (size_t)used, "[%" PRId64 "]", i % pair->width);
    label[used] = '\0';
}

static void print_difference(const struct pair *pair, const struct labels *labels, int64_t i)
{
    char label[LABEL_SIZE];
    write_label(label, labels, pair, i);
    if (pair->ints[0] != NULL)
        printf("  %s %s: %" PRId64 " and %" PRId64 "\n", pair->name, label, pair->ints[0][i],
               pair->ints[1][i]);
    else
        printf("  %s %s: %.17g and %.17g, %" PRIu64 " ulp\n", pair->name, label,
               pair->doubles[0][i], pair->doubles[1][i], distance(pair, i));
}

static double size_of_difference(const struct pair *pair, int64_t i)
{
    if (pair->ints[0] != NULL)
        return (double)distance(pair, i);
    return fabs(pair->doubles[0][i] - pair->doubles[1][i]);
}

static void note_difference(struct comparison *comparison, const char *name, const char *format,
                            ...) __attribute__((format(printf, 3, 4)));

/* A field that differs as a whole: says how. */
static void note_difference(struct comparison *comparison, const char *name, const char *format,
                            ...)
{
    va_list arguments;
    va_start(arguments, format);
    printf("  %s: ", name);
    vprintf(format, arguments);
    printf("\n");
    va_end(arguments);
    comparison->n_fields++;
    comparison->n_different++;
}

static void compare_pair(struct comparison *comparison, const struct pair *pair,
                         const struct labels *labels)
{
    const int64_t n = pair->n_rows * pair->width;
    int64_t n_different = 0;
    uint64_t farthest = 0;
    double largest = 0.0;
    for (int64_t i = 0; i < n; i++) {
        const uint64_t apart = distance(pair, i);
        if (apart == 0)
            continue;
        if (n_different++ < comparison->shown_most)
            print_difference(pair, labels, i);
        const double size = size_of_difference(pair, i);
        farthest = apart > farthest ? apart : farthest;
        largest = size > largest ? size : largest;
    }
    comparison->n_fields++;
    if (n_different == 0)
        return;
    comparison->n_different++;
    sheet_cell(&comparison->summary, "%s", pair->name);
    sheet_cell(&comparison->summary, "%" PRId64, n_different);
    sheet_cell(&comparison->summary, "%" PRId64, n);
    sheet_cell(&comparison->summary, "%.3g", largest);
    sheet_cell(&comparison->summary, "%" PRIu64, farthest);
}

/* -------------------------------------------------------------------------------- two files */

static bool begins(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

static bool is_left_out(const struct comparison *comparison, const char *path)
{
    if (begins(path, "/checksums") || begins(path, "/runtime") || begins(path, "/subdomains"))
        return true;
    if (comparison->all)
        return false;
    return strcmp(path, "/run/job") == 0 || strcmp(path, "/run@title") == 0 ||
           strcmp(path, "/run@version") == 0;
}

static void labels_clear(struct labels *labels)
{
    for (int k = 0; k < labels->n_columns; k++)
        free(labels->values[k]);
    *labels = (struct labels){0};
}

/* The ids of the rows of the group that `path` lies in, as the first file has them. */
static void labels_read(struct labels *labels, const struct content *content, const char *path)
{
    static const struct labels known[] = {
        {.group = "/spheres/", .n_columns = 1, .names = {"id"}},
        {.group = "/contacts/", .n_columns = 2, .names = {"first_id", "second_id"}},
        {.group = "/facet_contacts/", .n_columns = 3, .names = {"id", "body", "feature"}},
        {.group = "/nodes/", .n_columns = 1, .names = {"id"}},
        {.group = "/elements/", .n_columns = 1, .names = {"id"}},
    };
    if (labels->group != NULL && begins(path, labels->group))
        return;
    labels_clear(labels);
    for (size_t g = 0; g < sizeof known / sizeof *known; g++) {
        if (!begins(path, known[g].group))
            continue;
        *labels = known[g];
        labels->n_columns = 0;
        for (int k = 0; k < known[g].n_columns; k++) {
            char *name = array_format("%s%s", known[g].group, known[g].names[k]);
            const struct content_item *item = content_find(content, name);
            int64_t *values = item != NULL ? content_ints(content, item) : NULL;
            free(name);
            if (values == NULL)
                break;
            labels->n_rows = item->n_rows;
            labels->values[labels->n_columns++] = values;
        }
    }
}

static void compare_texts(struct comparison *comparison, const char *path, const char *a,
                          const char *b)
{
    int line = 1;
    const char *start = a;
    for (; *a == *b && *a != '\0'; a++, b++)
        if (*a == '\n') {
            line++;
            start = a + 1;
        }
    if (*a == *b) {
        comparison->n_fields++;
        return;
    }
    note_difference(comparison, path, "the texts differ in line %d, from \"%.*s\" on", line,
                    (int)strcspn(start, "\n"), start);
}

/* Compares an item that both files have in the same shape.  False when it cannot be read. */
static bool compare_values(struct comparison *comparison, const struct content content[2],
                           const struct content_item *const items[2], struct labels *labels)
{
    bool read = false;
    if (items[0]->kind == CONTENT_TEXT) {
        char *texts[2] = {content_text(&content[0], items[0]),
                          content_text(&content[1], items[1])};
        read = texts[0] != NULL && texts[1] != NULL;
        if (read)
            compare_texts(comparison, items[0]->path, texts[0], texts[1]);
        free(texts[0]);
        free(texts[1]);
        return read;
    }
    struct pair pair = {
        items[0]->path, items[0]->n_rows, items[0]->width, {NULL, NULL}, {NULL, NULL}};
    int64_t *ints[2] = {content_ints(&content[0], items[0]),
                        content_ints(&content[1], items[1])};
    double *doubles[2] = {content_doubles(&content[0], items[0]),
                          content_doubles(&content[1], items[1])};
    for (int k = 0; k < 2; k++) {
        pair.ints[k] = ints[k];
        pair.doubles[k] = doubles[k];
    }
    read = (ints[0] != NULL && ints[1] != NULL) || (doubles[0] != NULL && doubles[1] != NULL);
    labels_read(labels, &content[0], items[0]->path);
    if (read)
        compare_pair(comparison, &pair, labels->n_columns > 0 ? labels : NULL);
    for (int k = 0; k < 2; k++) {
        free(ints[k]);
        free(doubles[k]);
    }
    return read;
}

static bool compare_items(struct comparison *comparison, const struct content content[2],
                          const struct content_item *const items[2], struct labels *labels)
{
    const struct content_item *a = items[0], *b = items[1];
    if (a->kind != b->kind) {
        note_difference(comparison, a->path, "of another type");
    } else if (a->kind != CONTENT_TEXT && (a->n_rows != b->n_rows || a->width != b->width)) {
        note_difference(comparison, a->path,
                        "%" PRId64 " x %" PRId64 " values and %" PRId64 " x %" PRId64,
                        a->n_rows, a->width, b->n_rows, b->width);
    } else if (!compare_values(comparison, content, items, labels)) {
        report_error("%s cannot be read from both files; check them with tremie-info", a->path);
        return false;
    }
    return true;
}

static bool compare_contents(struct comparison *comparison, const struct content content[2])
{
    struct labels labels = {0};
    bool read = true;
    for (int i = 0; i < content[0].n; i++) {
        const struct content_item *const items[2] = {
            &content[0].items[i], content_find(&content[1], content[0].items[i].path)};
        if (is_left_out(comparison, items[0]->path))
            continue;
        if (items[1] == NULL)
            note_difference(comparison, items[0]->path, "only in the first");
        else
            read = compare_items(comparison, content, items, &labels) && read;
    }
    for (int i = 0; i < content[1].n; i++) {
        const char *path = content[1].items[i].path;
        if (!is_left_out(comparison, path) && content_find(&content[0], path) == NULL)
            note_difference(comparison, path, "only in the second");
    }
    labels_clear(&labels);
    return read;
}

static bool compare_files(struct comparison *comparison, char *const paths[2])
{
    struct content content[2];
    bool open[2], read = false;
    for (int k = 0; k < 2; k++) {
        char *why = content_open(&content[k], paths[k]);
        open[k] = why == NULL;
        if (why != NULL)
            report_error("%s; give a checkpoint or a series file", why);
        free(why);
    }
    if (open[0] && open[1])
        read = compare_contents(comparison, content);
    for (int k = 0; k < 2; k++)
        if (open[k])
            content_clear(&content[k]);
    return read;
}

/* ------------------------------------------------------------------------- two runs' series */

static void compare_column(struct comparison *comparison, const struct series series[2],
                           const char *name, int64_t n_rows)
{
    double *columns[2] = {records_column(&series[0], "%s", name),
                          records_column(&series[1], "%s", name)};
    const struct pair pair = {name, n_rows, 1, {NULL, NULL}, {columns[0], columns[1]}};
    if (columns[1] == NULL)
        note_difference(comparison, name, "only in the first");
    else
        compare_pair(comparison, &pair, NULL);
    free(columns[0]);
    free(columns[1]);
}

static bool compare_runs(struct comparison *comparison, char *const paths[2])
{
    struct series series[2];
    if (records_read(&series[0], paths[0], "series") != REPORT_FINISHED)
        return false;
    if (records_read(&series[1], paths[1], "series") != REPORT_FINISHED) {
        series_clear(&series[0]);
        return false;
    }
    const int n[2] = {series[0].n_rows, series[1].n_rows};
    if (n[0] != n[1])
        note_difference(comparison, "rows", "%d and %d; the first ones are compared", n[0],
                        n[1]);
    for (int k = 0; k < series[0].n_columns; k++)
        compare_column(comparison, series, series[0].columns[k].name,
                       n[0] < n[1] ? n[0] : n[1]);
    for (int k = 0; k < series[1].n_columns; k++)
        if (series_column_index(&series[0], series[1].columns[k].name) < 0)
            note_difference(comparison, series[1].columns[k].name, "only in the second");
    series_clear(&series[0]);
    series_clear(&series[1]);
    return true;
}

/* --------------------------------------------------------------------------------- the tool */

static int conclude(const struct comparison *comparison)
{
    const char *verdict = comparison->n_different == 0 ? "equal" : "different";
    if (comparison->summary.n_cells > 0)
        sheet_print(&comparison->summary, stdout);
    printf("%s: %d of %d fields differ\n", verdict, comparison->n_different,
           comparison->n_fields);
    return comparison->n_different == 0 ? EQUAL : DIFFERENT;
}

static int compare_paths(struct comparison *comparison, char *const paths[2])
{
    struct stat entries[2];
    for (int k = 0; k < 2; k++)
        if (stat(paths[k], &entries[k]) != 0) {
            report_error(
                "there is no %s; give two checkpoints, two series files or two runs' folders",
                paths[k]);
            return CANNOT_COMPARE;
        }
    const bool folders[2] = {S_ISDIR(entries[0].st_mode), S_ISDIR(entries[1].st_mode)};
    if (folders[0] != folders[1]) {
        report_error("a folder and a file cannot be compared; give two of a kind");
        return CANNOT_COMPARE;
    }
    const bool read =
        folders[0] ? compare_runs(comparison, paths) : compare_files(comparison, paths);
    return read ? conclude(comparison) : CANNOT_COMPARE;
}

int main(int argc, char **argv)
{
    bool all = false;
    double shown = 3.0;
    const struct arguments_entry entries[] = {
        {"all", 0, ARGUMENTS_FLAG, &all, NULL, "compares the job's text and title as well",
         NULL},
        {"show", 0, ARGUMENTS_NUMBER, &shown, "N", "differences shown of each field (3)", NULL},
    };
    const struct arguments_page page = {
        "tremie-compare",
        "A B [--all] [--show N]",
        "Compares two checkpoints, two series files or the series of two runs bit by bit, and shows the\n"
        "first differences of each field with a summary.\n"
        "\n"
        "Exit status: 0 equal; 1 different; 2 they cannot be compared, or bad arguments.\n",
        sizeof entries / sizeof *entries,
        entries,
        2,
        2};
    int n;
    const int status = arguments_read(&page, argc, argv, &n);
    if (status != ARGUMENTS_GO_ON)
        return status;
    if (!(shown >= 0.0 && shown <= 1e6)) {
        report_error("--show is given %g; give a number from 0 to 1000000", shown);
        return CANNOT_COMPARE;
    }
    struct comparison comparison = {.shown_most = (int)shown, .all = all};
    const char *const headings[] = {"field", "different", "of", "largest difference",
                                    "farthest [ulp]"};
    sheet_init(&comparison.summary);
    for (size_t i = 0; i < sizeof headings / sizeof *headings; i++)
        sheet_heading(&comparison.summary, "%s", headings[i]);
    const int verdict = compare_paths(&comparison, argv + 1);
    sheet_clear(&comparison.summary);
    return verdict;
}
