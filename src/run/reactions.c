/*
 * See reactions.h.  A row comes before the nodes move, and with them what is booked: the force
 * of its step is found here ahead and booked as taken away, so that what is booked when nodes
 * move leaves nothing, exactly.
 */
#include "run/reactions.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "job/job.h"
#include "run/simulation.h"
#include "store/series.h"

/* ------------------------------------------------------------------------------- columns */

/* A set's name as part of a column's: files may give names of any letters. */
static char *plain_name(const char *set)
{
    char *name = array_string(set);
    for (char *c = name; *c != '\0'; c++)
        if (!isalnum((unsigned char)*c) && *c != '-' && *c != '_')
            *c = '_';
    return name;
}

/* "plate.x_min", or "plate.x_min.3" where an item before item 3 has the name already.  The
 * caller frees it. */
static char *column_owner(const struct job_body *body, int item)
{
    char *set = plain_name(body->solid.boundary[item].set);
    bool taken = false;
    for (int k = 0; k < item && !taken; k++) {
        char *other = plain_name(body->solid.boundary[k].set);
        taken = job_boundary_holds(&body->solid.boundary[k]) && strcmp(set, other) == 0;
        free(other);
    }
    char *owner = taken ? array_format("%s.%s.%d", body->name, set, item)
                        : array_format("%s.%s", body->name, set);
    free(set);
    return owner;
}

static void add_columns(struct series *table, const struct job_body *body, int item)
{
    const struct job_boundary *asked = &body->solid.boundary[item];
    const int directions = asked->n_motions > 0 ? 7
                           : asked->fixed != 0  ? asked->fixed
                                                : 1 << asked->direction;
    char *owner = column_owner(body, item), help[160];
    for (int d = 0; d < 3; d++) {
        if ((directions >> d & 1) == 0)
            continue;
        snprintf(help, sizeof help,
                 "force of what %s set %.60s along %c, mean since the row before",
                 asked->fixed != 0 ? "holds" : "moves", asked->set, "xyz"[d]);
        series_add_column(table, "N", help, "%s.reaction_%c", owner, "xyz"[d]);
        if (asked->fixed == 0 && asked->n_motions == 0)
            series_add_column(table, "J", "work of what moves the set", "%s.work_%c", owner,
                              "xyz"[d]);
    }
    if (asked->n_motions > 0)
        series_add_column(table, "J", "work of the motion that the set follows", "%s.work",
                          owner);
    free(owner);
}

void reactions_add_columns(const struct simulation *sim, struct series *table)
{
    for (int k = 0; k < sim->deform.n; k++) {
        const struct job_body *body = &sim->job->bodies[sim->deform.list[k].body];
        for (int item = 0; item < body->solid.n_boundary; item++)
            if (job_boundary_holds(&body->solid.boundary[item]))
                add_columns(table, body, item);
    }
}

/* --------------------------------------------------------------------------------- values */

enum { WORK = 3, PARTS }; /* of a support: forces along x, y, z, then this */

/* Work of moments in the first half of the step. */
static void add_turning(const struct solid *solid, int i, double dt, struct exact_sum *sums)
{
    double moment[3];
    if (solid->turns.n_nodes == 0)
        return;
    solid_turns_support(solid, i, dt, moment);
    for (int d = 0; d < 3; d++) {
        const int held = solid->supports.turn_of_node[i][d];
        if (held >= 0 && solid->supports.list[held].kind != SOLID_SUPPORT_FIXED)
            exact_sum_add(&sums[PARTS * held + WORK],
                          0.5 * dt * (moment[d] * solid_turn_spin(&solid->turns, i)[d]));
    }
}

/* Adds what supports do in this step to totals, and takes forces away from what is booked.
 * Half of its work is done by now. */
static void add_step(struct solid *solid, int64_t step, double dt, struct exact_sum *sums)
{
    struct solid_supports *supports = &solid->supports;
    solid_supports_set(supports, step + 1, dt);
    for (int i = 0; i < solid->n_nodes; i++) {
        const int *held = supports->of_node[i];
        if (!solid->moves[i])
            continue;
        if (step > 0)
            add_turning(solid, i, dt, sums);
        if (held[0] < 0 && held[1] < 0 && held[2] < 0)
            continue;
        const struct solid_advance advance = solid_advance(solid, i, dt);
        const double *v = solid_velocity(solid, i);
        for (int d = 0; d < 3; d++) {
            if (held[d] < 0)
                continue;
            const double force = advance.support[d];
            exact_sum_add(&sums[PARTS * held[d] + d], force);
            exact_sum_add(&supports->list[held[d]].force[d], -force);
            if (step > 0 && supports->list[held[d]].kind != SOLID_SUPPORT_FIXED)
                exact_sum_add(&sums[PARTS * held[d] + WORK], 0.5 * dt * (force * v[d]));
        }
    }
}

static int add_values(struct simulation *sim, struct solid *solid, double n_steps, double *row,
                      int n)
{
    struct solid_supports *supports = &solid->supports;
    struct exact_sum *sums = array_allocate((size_t)supports->n * PARTS, sizeof *sums);
    for (int s = 0; s < supports->n; s++) {
        memcpy(sums + PARTS * s, supports->list[s].force, sizeof supports->list[s].force);
        memset(supports->list[s].force, 0, sizeof supports->list[s].force);
        sums[PARTS * s + WORK] = supports->list[s].work;
    }
    add_step(solid, deform_step(&sim->deform, sim->step), deform_dt(&sim->deform, sim->dt),
             sums);
    exact_sum_reduce(sim->comm, sums, PARTS * supports->n);
    for (int s = 0; s < supports->n; s++) {
        const struct solid_support *support = &supports->list[s];
        for (int d = 0; d < 3; d++)
            if (solid_support_pushes(support, d))
                row[n++] = exact_sum_value(&sums[PARTS * s + d]) / n_steps;
        if (support->kind != SOLID_SUPPORT_FIXED)
            row[n++] = exact_sum_value(&sums[PARTS * s + WORK]);
    }
    free(sums);
    return n;
}

int reactions_values(struct simulation *sim, double n_steps, double *row, int n)
{
    /* Of this step the first is counted; in the first row there is no rest of one before. */
    const bool is_first = n_steps == (double)(sim->step + 1);
    const double n_substeps = is_first ? (n_steps - 1.0) * sim->deform.substeps + 1.0
                                       : n_steps * sim->deform.substeps;
    for (int k = 0; k < sim->deform.n; k++)
        n = add_values(sim, &sim->deform.list[k].solid, n_substeps, row, n);
    return n;
}
