/* What tools ask of a run's series: columns by name, sums, last values. */
#ifndef TREMIE_POSTPROC_RECORDS_H
#define TREMIE_POSTPROC_RECORDS_H

#include "store/series.h"

/* Reads a table of a run's folder.  Returns a REPORT_ status, the reason said; nothing to clear
 * after a failure. */
int records_read(struct series *series, const char *run_folder, const char *table);

/* A column as an array, which the caller frees; NULL when there is none. */
double *records_column(const struct series *series, const char *name_format, ...)
    __attribute__((format(printf, 2, 3)));
/* A unit as headings of files have it at their end, "_m_s" of m/s; "" of a pure number.  The
 * caller frees it. */
char *records_unit(const char *unit);
/* Sum, mean and largest of a column, last value; not-a-number when there is no such column or
 * no row.  Rows where the value is not a number are left out. */
double records_sum(const struct series *series, const char *name);
double records_mean(const struct series *series, const char *name);
double records_max(const struct series *series, const char *name);
double records_last(const struct series *series, const char *name);

#endif
