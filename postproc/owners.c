/* See owners.h. */
#include "owners.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/array.h"
#include "base/report.h"
#include "model/sphere.h"
#include "records.h"

/* One rank's box: low <= x < high. */
struct box {
    int rank;
    double low[3], high[3]; /* [m] */
};

struct box_list {
    int n;
    struct box *list;
};

enum { N_COLUMNS = 8 };

/* The values of a row in the order of `names`, wherever the table has them. */
static void take_row(const struct series *series, const int columns[N_COLUMNS], int row,
                     double values[N_COLUMNS])
{
    for (int k = 0; k < N_COLUMNS; k++)
        values[k] =
            series->values[(size_t)row * (size_t)series->n_columns + (size_t)columns[k]];
}

/* The boxes of the newest save that is not after the step; returns its step, -1 for none. */
static int64_t select_boxes(struct box_list *boxes, const struct series *series, int64_t step)
{
    static const char *const names[N_COLUMNS] = {"step",  "rank",   "low_x",  "low_y",
                                                 "low_z", "high_x", "high_y", "high_z"};
    int columns[N_COLUMNS];
    double newest = -1.0, values[N_COLUMNS];
    for (int k = 0; k < N_COLUMNS; k++) {
        columns[k] = series_column_index(series, names[k]);
        if (columns[k] < 0)
            return -1;
    }
    for (int i = 0; i < series->n_rows; i++) {
        take_row(series, columns, i, values);
        if (values[0] > newest && values[0] <= (double)step)
            newest = values[0];
    }
    boxes->n = 0;
    boxes->list = array_allocate((size_t)series->n_rows, sizeof *boxes->list);
    for (int i = 0; i < series->n_rows; i++) {
        take_row(series, columns, i, values);
        if (values[0] != newest || !(values[1] >= 0.0 && values[1] < series->n_rows))
            continue;
        struct box *box = &boxes->list[boxes->n++];
        box->rank = (int)values[1];
        memcpy(box->low, values + 2, sizeof box->low);
        memcpy(box->high, values + 5, sizeof box->high);
    }
    return (int64_t)newest;
}

static int rank_at(const struct box_list *boxes, const double *x)
{
    for (int b = 0; b < boxes->n; b++) {
        const struct box *box = &boxes->list[b];
        bool inside = true;
        for (int k = 0; k < 3; k++)
            inside = inside && x[k] >= box->low[k] && x[k] < box->high[k];
        if (inside)
            return box->rank;
    }
    return -1;
}

int64_t owners_of_rows(int *owner, const struct spheres *spheres, const struct series *series,
                       int64_t step)
{
    struct box_list boxes = {0};
    int64_t found = select_boxes(&boxes, series, step);
    for (int i = 0; i < spheres->n_owned && found >= 0; i++) {
        owner[i] = rank_at(&boxes, sphere_position(spheres, i));
        if (owner[i] < 0)
            found = -2;
    }
    free(boxes.list);
    return found;
}

/* The run's folder: the path itself, or two above the checkpoint that it is. */
static char *run_of(const char *path)
{
    struct stat entry;
    if (stat(path, &entry) == 0 && S_ISDIR(entry.st_mode))
        return array_string(path);
    char whole[PATH_MAX];
    if (realpath(path, whole) == NULL)
        return array_string(path);
    for (int k = 0; k < 2; k++) {
        char *slash = strrchr(whole, '/');
        if (slash != NULL)
            *slash = '\0';
    }
    return array_string(whole[0] != '\0' ? whole : "/");
}

int owners_find(int *owner, const struct spheres *spheres, const char *path, int64_t step)
{
    struct series series;
    char *run = run_of(path), *why = NULL;
    int64_t found = -1;
    if (series_read(&series, run, "subdomains", &why)) {
        found = owners_of_rows(owner, spheres, &series, step);
        series_clear(&series);
    }
    if (why != NULL)
        report_error("cannot tell whose spheres %s holds: %s; colour by rank asks for a "
                     "checkpoint that lies in its run's folder",
                     path, why);
    else if (found == -1)
        report_error("the series of %s know no subdomains at step %lld or before; colour by "
                     "something else",
                     run, (long long)step);
    else if (found == -2)
        report_error("the subdomains in the series of %s leave spheres of %s out; give the "
                     "folder that the checkpoint belongs to",
                     run, path);
    else if (found < step)
        report_warn("subdomains are those of step %lld: the series have none of step %lld",
                    (long long)found, (long long)step);
    free(why);
    free(run);
    return found >= 0 ? REPORT_FINISHED : REPORT_STORAGE;
}
