/* See records.h. */
#include "records.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/array.h"
#include "base/report.h"

enum { NAME_SIZE = 256 };

int records_read(struct series *series, const char *run_folder, const char *table)
{
    struct stat entry;
    if (stat(run_folder, &entry) != 0 || !S_ISDIR(entry.st_mode)) {
        report_error("%s is not a folder; give the folder of a run", run_folder);
        return REPORT_BAD_INPUT;
    }
    char *why;
    if (series_read(series, run_folder, table, &why))
        return REPORT_FINISHED;
    report_error("%s; is %s the folder of a run, and has the run written its first checkpoint?",
                 why, run_folder);
    free(why);
    return REPORT_STORAGE;
}

static double *copy_column(const struct series *series, int index)
{
    double *values = array_allocate((size_t)series->n_rows, sizeof *values);
    for (int i = 0; i < series->n_rows; i++)
        values[i] = series->values[(size_t)i * (size_t)series->n_columns + (size_t)index];
    return values;
}

double *records_column(const struct series *series, const char *name_format, ...)
{
    char name[NAME_SIZE];
    va_list arguments;
    va_start(arguments, name_format);
    vsnprintf(name, sizeof name, name_format, arguments);
    va_end(arguments);
    const int index = series_column_index(series, name);
    return index >= 0 ? copy_column(series, index) : NULL;
}

char *records_unit(const char *unit)
{
    const bool plain = strcmp(unit, "1") == 0 || unit[0] == '\0';
    char *text = array_format("%s%s", plain ? "" : "_", plain ? "" : unit);
    for (char *c = text; *c != '\0'; c++)
        *c = *c == '/' || *c == ' ' ? '_' : *c;
    return text;
}

/* What a column says as a whole. */
struct summary {
    int n;
    double sum, max, last;
};

static struct summary summary_of(const struct series *series, const char *name)
{
    struct summary summary = {0, 0.0, -INFINITY, (double)NAN};
    const int index = series_column_index(series, name);
    for (int i = 0; index >= 0 && i < series->n_rows; i++) {
        const double value =
            series->values[(size_t)i * (size_t)series->n_columns + (size_t)index];
        if (isnan(value))
            continue;
        summary.n++;
        summary.sum += value;
        summary.max = value > summary.max ? value : summary.max;
        summary.last = value;
    }
    return summary;
}

double records_sum(const struct series *series, const char *name)
{
    const struct summary summary = summary_of(series, name);
    return summary.n > 0 ? summary.sum : (double)NAN;
}

double records_mean(const struct series *series, const char *name)
{
    const struct summary summary = summary_of(series, name);
    return summary.n > 0 ? summary.sum / summary.n : (double)NAN;
}

double records_max(const struct series *series, const char *name)
{
    const struct summary summary = summary_of(series, name);
    return summary.n > 0 ? summary.max : (double)NAN;
}

double records_last(const struct series *series, const char *name)
{
    return summary_of(series, name).last;
}
