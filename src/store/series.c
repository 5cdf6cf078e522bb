/*
 * See series.h.
 *
 * Space is reserved before HDF5 begins, so that a full disk shows itself in the simplest
 * place.  Columns carry HDF5's Fletcher32 checksums, which any reader verifies; the order of
 * columns is an attribute of the table's group.
 */
#include "store/series.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/array.h"
#include "base/report.h"
#include "store/file.h"
#include "store/h5.h"
#include "store/run_folder.h"

static const char FORMAT[] = "tremie series";

enum { FORMAT_VERSION = 1 };

void series_init(struct series *series, const char *name)
{
    *series = (struct series){.name = array_string(name)};
}

void series_clear(struct series *series)
{
    for (int k = 0; k < series->n_columns; k++) {
        free(series->columns[k].name);
        free(series->columns[k].unit);
        free(series->columns[k].help);
    }
    free(series->columns);
    free(series->values);
    free(series->name);
    *series = (struct series){0};
}

/* Takes the name; the rest is copied. */
static void add_column(struct series *series, char *name, const char *unit, const char *help)
{
    ARRAY_GROW(series->columns, series->n_columns + 1, series->column_capacity);
    series->columns[series->n_columns++] =
        (struct series_column){name, array_string(unit), array_string(help)};
}

void series_add_column(struct series *series, const char *unit, const char *help,
                       const char *name_format, ...)
{
    CHECK(series->row_capacity == 0, "a column of %s comes after rows", series->name);
    va_list arguments, copy;
    va_start(arguments, name_format);
    va_copy(copy, arguments);
    const int length = vsnprintf(NULL, 0, name_format, arguments);
    CHECK(length > 0, "cannot format a column's name");
    char *name = array_allocate((size_t)length + 1, 1);
    vsnprintf(name, (size_t)length + 1, name_format, copy);
    va_end(copy);
    va_end(arguments);
    CHECK(strpbrk(name, "/\n") == NULL && series_column_index(series, name) < 0,
          "%s cannot be the name of a column, or is one already", name);
    add_column(series, name, unit, help);
}

/* Makes room for the values of one more row. */
static double *next_row(struct series *series)
{
    const size_t n_columns = (size_t)series->n_columns;
    const size_t was = (size_t)series->row_capacity, needed = (size_t)series->n_rows + 1;
    if (needed > was) {
        const size_t now = array_capacity(was, needed);
        series->values = array_resize(series->values, was * n_columns, now * n_columns,
                                      sizeof *series->values);
        series->row_capacity = (int)now;
    }
    return series->values + (size_t)series->n_rows++ * n_columns;
}

void series_add_row(struct series *series, const double *values)
{
    double *row = next_row(series);
    if (series->n_columns > 0)
        memcpy(row, values, (size_t)series->n_columns * sizeof *row);
}

void series_clear_rows(struct series *series)
{
    series->n_rows = 0;
}

int series_column_index(const struct series *series, const char *name)
{
    for (int k = 0; k < series->n_columns; k++)
        if (strcmp(series->columns[k].name, name) == 0)
            return k;
    return -1;
}

/* ---------------------------------------------------------------------------------- writing */

static char *column_names(const struct series *series)
{
    size_t size = 1;
    for (int k = 0; k < series->n_columns; k++)
        size += strlen(series->columns[k].name) + 1;
    char *names = array_allocate(size, 1), *at = names;
    for (int k = 0; k < series->n_columns; k++)
        at += sprintf(at, "%s\n", series->columns[k].name);
    return names;
}

static void put_table(struct h5 *h5, const struct series *series)
{
    char *group = array_format("/%s", series->name), *names = column_names(series);
    const size_t n_rows = (size_t)series->n_rows, n_columns = (size_t)series->n_columns;
    double *values = array_allocate(n_rows, sizeof *values);
    h5_group(h5, group);
    h5_put_text(h5, group, "columns", names);
    h5_put_int(h5, group, "n_rows", series->n_rows);
    for (size_t k = 0; k < n_columns; k++) {
        const struct series_column *column = &series->columns[k];
        const struct field field = {
            column->name, column->unit, column->help, FIELD_DOUBLE, 1, 0};
        char *path = array_format("%s/%s", group, column->name);
        for (size_t i = 0; i < n_rows; i++)
            values[i] = series->values[i * n_columns + k];
        h5_put_column(h5, path, &field, series->n_rows, values);
        free(path);
    }
    free(values);
    free(names);
    free(group);
}

/* What the file takes at most, HDF5's own needs included. */
static int64_t file_size(int n_tables, const struct series *const *tables)
{
    enum { OF_FILE = 1 << 14, OF_COLUMN = 1 << 12 };
    int64_t size = OF_FILE;
    for (int k = 0; k < n_tables; k++)
        size +=
            tables[k]->n_columns * (OF_COLUMN + (int64_t)sizeof(double) * tables[k]->n_rows);
    return size;
}

/* Returns NULL or the reason. */
static char *write_file(const char *path, const char *title, int n_tables,
                        const struct series *const *tables)
{
    unlink(path);
    /* HDF5 gives this space back when it creates the file; but it has been there. */
    char *why = file_reserve(path, file_size(n_tables, tables));
    if (why != NULL)
        return why;
    struct h5 h5;
    h5_create(&h5, path);
    h5_group(&h5, "/run");
    h5_put_text(&h5, "/run", "format", FORMAT);
    h5_put_int(&h5, "/run", "format_version", FORMAT_VERSION);
    h5_put_text(&h5, "/run", "title", title);
    for (int k = 0; k < n_tables; k++)
        put_table(&h5, tables[k]);
    h5_save(&h5, path);
    return h5.why;
}

int series_write_segment(const struct run_folder *folder, const char *path, const char *title,
                         int n_tables, const struct series *const *tables)
{
    if (run_folder_is_lost(folder))
        return REPORT_STORAGE;
    char *temporary = file_temporary(path, run_folder_tag(folder));
    char *why = write_file(temporary, title, n_tables, tables);
    const bool lost = why == NULL && run_folder_is_lost(folder);
    if (why == NULL && !lost)
        why = file_publish(temporary, path);
    if (why != NULL || lost)
        unlink(temporary);
    if (why != NULL && !run_folder_is_lost(folder))
        report_error(
            "cannot write the series %s: %s; free some space or mend the disk, then run the "
            "same command again",
            path, why);
    const int status = why != NULL || lost ? REPORT_STORAGE : REPORT_FINISHED;
    free(temporary);
    free(why);
    return status;
}

/* ---------------------------------------------------------------------------------- reading */

/* Index of the column, which is added, not-a-number in all rows so far, if it is new:
 * outputs may change when a run is resumed. */
static int find_or_add(struct series *series, const char *name, const char *unit,
                       const char *help)
{
    const int found = series_column_index(series, name);
    if (found >= 0)
        return found;
    const size_t n_rows = (size_t)series->n_rows, was = (size_t)series->n_columns;
    double *values = array_allocate(n_rows * (was + 1), sizeof *values);
    for (size_t i = 0; i < n_rows; i++) {
        for (size_t k = 0; k < was; k++)
            values[i * (was + 1) + k] = series->values[i * was + k];
        values[i * (was + 1) + was] = (double)NAN;
    }
    free(series->values);
    series->values = values;
    series->row_capacity = series->n_rows;
    add_column(series, array_string(name), unit, help);
    return series->n_columns - 1;
}

/* Appends n rows without values. */
static void add_empty_rows(struct series *series, int64_t n)
{
    for (int64_t i = 0; i < n; i++) {
        double *row = next_row(series);
        for (int k = 0; k < series->n_columns; k++)
            row[k] = (double)NAN;
    }
}

/* One column of a segment into the rows from `first_row` on. */
static void read_column(struct series *series, struct h5 *h5, const char *name, int first_row,
                        int64_t n)
{
    const struct field field = {name, "", "", FIELD_DOUBLE, 1, 0};
    char *path = array_format("/%s/%s", series->name, name);
    if (h5_count_rows(h5, path, &field) != n)
        h5_fail(h5, "%s has another length than its table", path);
    double *values = array_allocate(h5->why == NULL ? (size_t)n : 0, sizeof *values);
    h5_read_rows(h5, path, &field, 0, n, values);
    char *unit = h5_get_text(h5, path, "unit"), *help = h5_get_text(h5, path, "description");
    if (h5->why == NULL) {
        const int k = find_or_add(series, name, unit, help);
        for (int64_t i = 0; i < n; i++)
            series->values[(first_row + i) * series->n_columns + k] = values[i];
    }
    free(unit);
    free(help);
    free(values);
    free(path);
}

static void check_format(struct h5 *h5)
{
    char *format = h5_get_text(h5, "/run", "format");
    const int64_t version = h5_get_int(h5, "/run", "format_version");
    if (strcmp(format, FORMAT) != 0)
        h5_fail(h5, "it is not a series of tremie");
    else if (version < 1 || version > FORMAT_VERSION)
        h5_fail(h5, "its format is newer than this program");
    free(format);
}

/* Appends what a segment holds of the table; a table that it does not have adds
 * nothing.  Returns NULL or the reason; then nothing was appended. */
static char *append_segment(struct series *series, const char *path)
{
    struct h5 h5;
    h5_open(&h5, path);
    check_format(&h5);
    char *group = array_format("/%s", series->name);
    const int first_row = series->n_rows;
    if (h5_has(&h5, group)) {
        const int64_t n = h5_get_int(&h5, group, "n_rows");
        char *names = h5_get_text(&h5, group, "columns"), *rest = names;
        if (n < 0 || n > (1 << 30))
            h5_fail(&h5, "%s: the number of rows makes no sense", group);
        add_empty_rows(series, h5.why == NULL ? n : 0);
        for (char *name; h5.why == NULL && (name = strsep(&rest, "\n")) != NULL;)
            if (*name != '\0')
                read_column(series, &h5, name, first_row, n);
        free(names);
    }
    h5_close(&h5);
    if (h5.why != NULL)
        series->n_rows = first_row;
    free(group);
    return h5.why;
}

/* Reads segment after segment; returns how many could be, *why keeps the last reason. */
static int append_segments(struct series *series, const char *folder, char **why)
{
    int64_t *steps;
    const int n = file_steps(folder, &steps);
    int n_read = 0;
    for (int i = 0; i < n; i++) {
        char *path = file_step_path(folder, steps[i]);
        char *problem = append_segment(series, path);
        if (problem == NULL) {
            n_read++;
        } else {
            report_warn("cannot read %s: %s; its rows are missing", path, problem);
            free(*why);
            *why = array_format("%s: %s", path, problem);
        }
        free(problem);
        free(path);
    }
    free(steps);
    return n_read;
}

bool series_read(struct series *series, const char *run_folder, const char *table, char **why)
{
    char *folder = array_format("%s/series", run_folder);
    *why = array_format("there are no series in %s", folder);
    series_init(series, table);
    const int n_read = append_segments(series, folder, why);
    free(folder);
    if (n_read > 0 && series->n_columns > 0) {
        free(*why);
        *why = NULL;
        return true;
    }
    if (n_read > 0) {
        free(*why);
        *why = array_format("there is no table %s in the series of %s", table, run_folder);
    }
    series_clear(series);
    return false;
}
