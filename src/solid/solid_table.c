/* See solid_table.h. */
#include "solid/solid_table.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "job/job.h"
#include "model/solid_condition.h"

struct solid_table solid_table_of(const struct solid_condition *condition)
{
    const int n = condition->n > 0 ? condition->n : 1;
    struct solid_table table = {n, array_allocate((size_t)n, sizeof *table.points)};
    table.points[0].value = condition->constant;
    for (int k = 0; k < condition->n; k++)
        table.points[k] =
            (struct solid_table_point){condition->rows[k].time, condition->rows[k].value};
    return table;
}

struct solid_table solid_table_copy(const struct solid_table *table)
{
    struct solid_table copy = {table->n, NULL};
    if (table->n > 0) {
        copy.points = array_allocate((size_t)table->n, sizeof *copy.points);
        memcpy(copy.points, table->points, (size_t)table->n * sizeof *copy.points);
    }
    return copy;
}

void solid_table_clear(struct solid_table *table)
{
    free(table->points);
    *table = (struct solid_table){0};
}

/* Between two points. */
static double between(const struct solid_table_point *a, const struct solid_table_point *b,
                      double time)
{
    return a->value + (b->value - a->value) * ((time - a->time) / (b->time - a->time));
}

double solid_table_value(const struct solid_table *table, double time)
{
    if (table->n == 0)
        return 1.0;
    const struct solid_table_point *points = table->points;
    if (time <= points[0].time)
        return points[0].value;
    for (int k = 1; k < table->n; k++)
        if (time < points[k].time)
            return between(&points[k - 1], &points[k], time);
    return points[table->n - 1].value;
}

/* Integral from the table's first time, of times behind it. */
static double from_first(const struct solid_table *table, double time)
{
    const struct solid_table_point *points = table->points;
    double sum = 0.0;
    for (int k = 1; k < table->n; k++) {
        if (time < points[k].time)
            return sum + 0.5 *
                             (points[k - 1].value + between(&points[k - 1], &points[k], time)) *
                             (time - points[k - 1].time);
        sum += 0.5 * (points[k - 1].value + points[k].value) *
               (points[k].time - points[k - 1].time);
    }
    return sum + points[table->n - 1].value * (time - points[table->n - 1].time);
}

double solid_table_integral(const struct solid_table *table, double time)
{
    if (time <= 0.0)
        return 0.0;
    if (table->n == 0)
        return time;
    const struct solid_table_point *first = &table->points[0];
    const double before = first->time > 0.0 ? first->time : 0.0;
    if (time <= before)
        return first->value * time;
    const double at_zero = first->time < 0.0 ? from_first(table, 0.0) : -first->value * before;
    return from_first(table, time) - at_zero;
}
