/* See solid_condition.h.  A table is searched from its beginning: it is short and asked once a
 * step. */
#include "model/solid_condition.h"

#include <stdbool.h>

#include "base/report.h"
#include "job/job.h"
#include "model/solid_mesh.h"

struct solid_condition solid_condition_of(const struct job_boundary *asked,
                                          const struct solid_mesh *mesh)
{
    const struct solid_mesh_set *set = solid_mesh_find(mesh, asked->set);
    const int along = 1 << asked->direction;
    CHECK(set != NULL, "there is no set '%s'", asked->set);
    if (asked->fixed != 0)
        return (struct solid_condition){SOLID_CONDITION_FIXED, set, asked->fixed, 0.0, 0, NULL};
    if (asked->n_displacements > 0)
        return (struct solid_condition){
            SOLID_CONDITION_DISPLACEMENT, set, along, 0.0, asked->n_displacements,
            asked->displacements};
    if (asked->has_velocity || asked->n_velocities > 0)
        return (struct solid_condition){
            SOLID_CONDITION_VELOCITY, set, along, asked->velocity, asked->n_velocities,
            asked->velocities};
    if (asked->has_force || asked->n_forces > 0)
        return (struct solid_condition){
            SOLID_CONDITION_FORCE, set, along, asked->force, asked->n_forces, asked->forces};
    return (struct solid_condition){
        SOLID_CONDITION_PRESSURE, set, 0, asked->pressure, asked->n_pressures,
        asked->pressures};
}

double solid_condition_at(const struct solid_condition *condition, double time)
{
    const struct job_value *rows = condition->rows;
    int k = 0;
    if (condition->n == 0)
        return condition->constant;
    while (k < condition->n && rows[k].time <= time)
        k++;
    if (k == 0 || k == condition->n)
        return rows[k == 0 ? 0 : k - 1].value;
    const double share = (time - rows[k - 1].time) / (rows[k].time - rows[k - 1].time);
    return rows[k - 1].value + share * (rows[k].value - rows[k - 1].value);
}

/* Area below the table from time 0 on: trapezia between the rows, rectangles outside. */
static double integral(const struct solid_condition *condition, double time)
{
    const struct job_value *rows = condition->rows;
    const int n = condition->n;
    double sum = rows[0].value * (time < rows[0].time ? time : rows[0].time);
    for (int k = 1; k < n && rows[k - 1].time < time; k++) {
        const bool whole = rows[k].time <= time;
        const double end = whole ? rows[k].time : time;
        const double value = whole ? rows[k].value : solid_condition_at(condition, time);
        sum += 0.5 * (rows[k - 1].value + value) * (end - rows[k - 1].time);
    }
    return time > rows[n - 1].time ? sum + rows[n - 1].value * (time - rows[n - 1].time) : sum;
}

double solid_condition_travel(const struct solid_condition *condition, double time)
{
    switch (condition->kind) {
    case SOLID_CONDITION_FIXED:
        return 0.0;
    case SOLID_CONDITION_DISPLACEMENT:
        return solid_condition_at(condition, time);
    case SOLID_CONDITION_VELOCITY:
        return condition->n > 0 ? integral(condition, time) : condition->constant * time;
    case SOLID_CONDITION_FORCE:
    case SOLID_CONDITION_PRESSURE:
        break;
    }
    CHECK(false, "a load on '%s' goes nowhere", condition->set->name);
}
