/* See forced.h.  Loads are running sums; what a step adds is their difference, exactly. */
#include "run/forced.h"

#include <stdlib.h>

#include "base/array.h"
#include "model/rigid.h"
#include "run/simulation.h"

enum { PARTS = 6 }; /* of force and torque */

void forced_init(struct forced *forced, const struct simulation *sim)
{
    forced->before = array_allocate((size_t)sim->bodies.n_forced, sizeof *forced->before);
}

void forced_clear(struct forced *forced)
{
    free(forced->before);
    forced->before = NULL;
}

static const struct exact_sum *part_of(const struct body_load *load, int k)
{
    return k < 3 ? &load->force[k] : &load->torque[k - 3];
}

void forced_begin(struct simulation *sim)
{
    for (int b = 0, f = 0; b < sim->bodies.n; b++) {
        if (sim->bodies.list[b].rigid == NULL)
            continue;
        for (int k = 0; k < PARTS; k++)
            sim->forced.before[f][k] = *part_of(&sim->facets.loads[b], k);
        f++;
    }
}

static void subtract(struct exact_sum *sum, const struct exact_sum *before)
{
    for (int l = 0; l < 3; l++)
        sum->limb[l] -= before->limb[l];
    sum->overflow -= before->overflow;
}

static void plan(struct simulation *sim, struct rigid *rigid, const struct exact_sum *sums)
{
    double v[PARTS];
    for (int k = 0; k < PARTS; k++)
        v[k] = exact_sum_value(&sums[k]);
    const struct rigid_load load = {.force = {v[0], v[1], v[2]},
                                    .torque = {v[3], v[4], v[5]},
                                    .gravity = sim->gravity,
                                    .gravity_change = sim->gravity_change};
    rigid_plan(rigid, &load, (double)sim->step * sim->dt, sim->dt);
}

void forced_plan(struct simulation *sim)
{
    const int n = sim->bodies.n_forced;
    if (n == 0)
        return;
    struct exact_sum *sums = array_allocate((size_t)n * PARTS, sizeof *sums);
    for (int b = 0, f = 0; b < sim->bodies.n; b++) {
        if (sim->bodies.list[b].rigid == NULL)
            continue;
        for (int k = 0; k < PARTS; k++) {
            sums[f * PARTS + k] = *part_of(&sim->facets.loads[b], k);
            subtract(&sums[f * PARTS + k], &sim->forced.before[f][k]);
        }
        f++;
    }
    exact_sum_reduce(sim->comm, sums, n * PARTS);
    for (int b = 0, f = 0; b < sim->bodies.n; b++) {
        if (sim->bodies.list[b].rigid != NULL)
            plan(sim, sim->bodies.list[b].rigid, &sums[PARTS * f++]);
    }
    free(sums);
}

void forced_move(struct simulation *sim)
{
    for (int b = 0; sim->bodies.n_forced > 0 && b < sim->bodies.n; b++) {
        struct body *body = &sim->bodies.list[b];
        if (body->rigid == NULL)
            continue;
        rigid_move(body->rigid);
        body->speed_max = rigid_speed(body->rigid);
    }
}
