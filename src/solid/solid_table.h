/* Tables over time: straight between their points, constant before the first and behind the
 * last.  No points: 1 throughout. */
#ifndef TREMIE_SOLID_SOLID_TABLE_H
#define TREMIE_SOLID_SOLID_TABLE_H

struct solid_table_point {
    double time; /* [s], ascending */
    double value;
};

struct solid_table {
    int n;
    struct solid_table_point *points;
};

struct solid_condition;

/* A condition's values over time; the caller clears it. */
struct solid_table solid_table_of(const struct solid_condition *condition);
struct solid_table solid_table_copy(const struct solid_table *table);
void solid_table_clear(struct solid_table *table);
double solid_table_value(const struct solid_table *table, double time);
/* Integral from time 0; 0 before. */
double solid_table_integral(const struct solid_table *table, double time);

#endif
