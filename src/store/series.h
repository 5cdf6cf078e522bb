/*
 * Tables over time: what a run reports.
 *
 * Rows are kept in memory on rank 0 and written as one segment file with each checkpoint, so
 * that rows and checkpoint always agree; a running job's readers never meet a file that is
 * open.  A segment is RUN/series/step_000000050000.h5, named after its checkpoint, and holds
 * the rows since the one before in HDF5 groups, one a table, each with one 1-D double dataset a
 * column (attributes: unit, description).  Tables: "series" (bits do not depend on ranks or
 * clock: samples of energies, bodies, sections), "runtime" (timings; never compared).  Tools
 * read the chain of segments in order.
 */
#ifndef TREMIE_STORE_SERIES_H
#define TREMIE_STORE_SERIES_H

#include <stdbool.h>

struct run_folder;

struct series_column {
    char *name, *unit, *help;
};

struct series {
    char *name; /* of the table */
    int n_columns, n_rows, column_capacity, row_capacity;
    struct series_column *columns;
    double *values; /* n_rows x n_columns */
};

void series_init(struct series *series, const char *name);
void series_clear(struct series *series);
/* Columns are added before the first row. */
void series_add_column(struct series *series, const char *unit, const char *help,
                       const char *name_format, ...) __attribute__((format(printf, 4, 5)));
/* Appends a row of n_columns values. */
void series_add_row(struct series *series, const double *values);
/* Forgets the rows, once they are on the disk. */
void series_clear_rows(struct series *series);
/* Column index by name, -1 when there is none. */
int series_column_index(const struct series *series, const char *name);

/* Writes the rows of these tables as one segment (temporary name, fsync, rename).  On one
 * process.  `folder` is the run's, NULL: nobody's.  `title` is kept as an attribute of /run.
 * Returns a REPORT_ status, the reason said. */
int series_write_segment(const struct run_folder *folder, const char *path, const char *title,
                         int n_tables, const struct series *const *tables);

/* Reads one table of a run: the chain of segments of RUN/series in order.  A segment that
 * cannot be read is left out with a warning; a column that some segments lack is not-a-number
 * there.  Returns false with the reason in `why` (caller frees) when nothing can be read; then
 * there is nothing to clear. */
bool series_read(struct series *series, const char *run_folder, const char *table, char **why);

#endif
