/* See path_file.h.  The first line names the columns, in any order; others are passed over. */
#include "job/path_file.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"

enum { POINTS_MOST = 20000, COLUMNS_MOST = 64, MISTAKES_MOST = 20, LINE_MOST = 4096 };
enum { T, X, Y, Z, ANGLE, N_NAMES };
static const char *const NAMES[N_NAMES] = {"t_s", "x_m", "y_m", "z_m", "angle_rad"};

struct table {
    const char *path;
    struct mistakes *mistakes;
    int line;
    int n_columns, names[COLUMNS_MOST]; /* which name a column has; -1: none of ours */
};

/* Cuts the next cell out of a line, without the blanks around it; NULL behind the last. */
static char *next_cell(char **rest)
{
    char *cell = *rest;
    if (cell == NULL)
        return NULL;
    char *end = cell + strcspn(cell, ",\r\n");
    *rest = *end == ',' ? end + 1 : NULL;
    *end = '\0';
    cell += strspn(cell, " \t");
    while (end > cell && (end[-1] == ' ' || end[-1] == '\t'))
        *--end = '\0';
    return cell;
}

static bool read_header(struct table *table, char *line)
{
    bool timed = false;
    char *cell;
    while ((cell = next_cell(&line)) != NULL && table->n_columns < COLUMNS_MOST) {
        int name = N_NAMES - 1;
        while (name >= 0 && strcmp(cell, NAMES[name]) != 0)
            name--;
        timed = timed || name == T;
        table->names[table->n_columns++] = name;
    }
    if (!timed)
        mistakes_add(table->mistakes, table->path, 1, 1,
                     "there is no column t_s; a first line that names it and any of x_m, y_m, "
                     "z_m and angle_rad is expected");
    return timed;
}

static bool read_row(const struct table *table, char *line, struct job_path_point *point)
{
    double values[N_NAMES] = {0.0};
    const char *begin = line;
    for (int c = 0; c < table->n_columns; c++) {
        char *end, *cell = next_cell(&line);
        if (cell == NULL || *cell == '\0') {
            mistakes_add(table->mistakes, table->path, table->line, 1,
                         "column %d is missing; as many as in the first line are expected",
                         c + 1);
            return false;
        }
        if (table->names[c] < 0)
            continue;
        double *value = &values[table->names[c]];
        *value = strtod(cell, &end);
        if (*end != '\0' || !(*value >= -1e9 && *value <= 1e9)) {
            mistakes_add(table->mistakes, table->path, table->line, (int)(cell - begin) + 1,
                         "'%.40s' is no number between -1e9 and 1e9; one is expected", cell);
            return false;
        }
    }
    *point =
        (struct job_path_point){values[T], {values[X], values[Y], values[Z]}, values[ANGLE]};
    return true;
}

static void read_rows(struct table *table, FILE *in, struct job_motion *motion)
{
    char line[LINE_MOST];
    int capacity = 0;
    const int n_before = table->mistakes->n;
    while (fgets(line, sizeof line, in) != NULL &&
           table->mistakes->n < n_before + MISTAKES_MOST) {
        table->line++;
        if (strlen(line) == sizeof line - 1) {
            mistakes_add(table->mistakes, table->path, table->line, 1,
                         "a line of more than %d bytes; shorter ones are expected",
                         LINE_MOST - 2);
            break;
        }
        if (table->line == 1 && !read_header(table, line))
            break;
        if (table->line == 1 || line[strspn(line, " \t\r\n")] == '\0')
            continue;
        if (motion->path.n == POINTS_MOST) {
            mistakes_add(table->mistakes, table->path, table->line, 1,
                         "there are more than %d rows; fewer are expected", POINTS_MOST);
            break;
        }
        ARRAY_GROW(motion->path.points, motion->path.n + 1, capacity);
        if (read_row(table, line, &motion->path.points[motion->path.n]))
            motion->path.n++;
    }
}

static void read_file(struct job_motion *motion, struct mistakes *mistakes)
{
    struct table table = {.path = motion->path.file, .mistakes = mistakes};
    FILE *in = fopen(table.path, "r");
    if (in == NULL) {
        mistakes_add(mistakes, table.path, 1, 1,
                     "cannot be read: %s; a CSV file of a path is expected", strerror(errno));
        return;
    }
    read_rows(&table, in, motion);
    fclose(in);
}

static void read_motions(int n, struct job_motion *motions, struct mistakes *mistakes)
{
    for (int m = 0; m < n; m++) {
        if (motions[m].path.file == NULL || motions[m].path.n > 0)
            continue; /* points and a file: job_check says so */
        read_file(&motions[m], mistakes);
        free(motions[m].path.file);
        motions[m].path.file = NULL;
    }
}

void path_file_read_all(struct job *job, struct mistakes *mistakes)
{
    for (int b = 0; b < job->n_bodies; b++) {
        const struct job_solid *solid = &job->bodies[b].solid;
        read_motions(job->bodies[b].n_motions, job->bodies[b].motions, mistakes);
        for (int k = 0; k < solid->n_boundary; k++)
            read_motions(solid->boundary[k].n_motions, solid->boundary[k].motions, mistakes);
    }
}
