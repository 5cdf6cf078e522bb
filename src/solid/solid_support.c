/* See solid_support.h. */
#include "solid/solid_support.h"

#include <stdlib.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "model/motion.h"

void solid_supports_init(struct solid_supports *supports, int n_nodes)
{
    *supports = (struct solid_supports){.n_nodes = n_nodes};
    supports->of_node = array_allocate((size_t)n_nodes, sizeof *supports->of_node);
    for (int i = 0; i < n_nodes; i++)
        for (int k = 0; k < 3; k++)
            supports->of_node[i][k] = -1;
}

void solid_supports_clear(struct solid_supports *supports)
{
    for (int s = 0; s < supports->n; s++) {
        solid_table_clear(&supports->list[s].table);
        free(supports->list[s].places);
    }
    free(supports->list);
    free(supports->of_node);
    *supports = (struct solid_supports){0};
}

static void append(struct solid_supports *supports, const struct solid_support *support)
{
    ARRAY_GROW(supports->list, supports->n + 1, supports->capacity);
    supports->list[supports->n++] = *support;
}

void solid_supports_add(struct solid_supports *supports, enum solid_support_kind kind,
                        int direction, const struct solid_table *table, int n_nodes,
                        const int *nodes)
{
    CHECK(direction >= 0 && direction < 3, "there is no direction %d", direction);
    struct solid_support support = {.kind = kind, .direction = direction};
    if (kind != SOLID_SUPPORT_FIXED)
        support.table = solid_table_copy(table);
    append(supports, &support);
    for (int k = 0; k < n_nodes; k++)
        supports->of_node[nodes[k]][direction] = supports->n - 1;
}

void solid_supports_add_motion(struct solid_supports *supports, int n_motions,
                               const struct job_motion *motions, int n_nodes, const int *nodes)
{
    struct solid_support support = {
        .kind = SOLID_SUPPORT_MOTION, .n_motions = n_motions, .motions = motions};
    support.places = array_allocate((size_t)n_motions, sizeof *support.places);
    append(supports, &support);
    for (int k = 0; k < n_nodes; k++)
        for (int direction = 0; direction < 3; direction++)
            supports->of_node[nodes[k]][direction] = supports->n - 1;
}

/* Shift since time 0.  (12.15) */
static double shift_at(const struct solid_support *support, double time)
{
    switch (support->kind) {
    case SOLID_SUPPORT_DISPLACEMENT:
        return solid_table_value(&support->table, time) -
               solid_table_value(&support->table, 0.0);
    case SOLID_SUPPORT_VELOCITY:
        return solid_table_integral(&support->table, time);
    case SOLID_SUPPORT_FIXED:
    case SOLID_SUPPORT_MOTION:
    default:
        return 0.0;
    }
}

void solid_supports_set(struct solid_supports *supports, int64_t step, double dt)
{
    const double time = (double)step * dt;
    for (int s = 0; s < supports->n; s++) {
        struct solid_support *support = &supports->list[s];
        support->shift = shift_at(support, time);
        for (int m = 0; m < support->n_motions; m++)
            support->places[m] = motion_place(&support->motions[m], time);
    }
}

static struct vec3 follow(const struct solid_support *support, const double reference[3])
{
    struct vec3 x = {reference[0], reference[1], reference[2]};
    for (int m = 0; m < support->n_motions; m++)
        x = motion_apply(&support->places[m], x);
    return x;
}

void solid_supports_place(const struct solid_supports *supports, int node,
                          const double reference[3], double place[3])
{
    const int *held = supports->of_node[node];
    for (int k = 0; k < 3; k++) {
        if (held[k] < 0)
            continue;
        const struct solid_support *support = &supports->list[held[k]];
        if (support->kind == SOLID_SUPPORT_MOTION) {
            const struct vec3 x = follow(support, reference);
            place[k] = k == 0 ? x.x : k == 1 ? x.y : x.z;
        } else {
            place[k] = reference[k] + support->shift;
        }
    }
}

void solid_supports_book(struct solid_supports *supports, int node, const double force[3],
                         const double v[3], double dt)
{
    const int *held = supports->of_node[node];
    for (int k = 0; k < 3; k++) {
        if (held[k] < 0)
            continue;
        struct solid_support *support = &supports->list[held[k]];
        exact_sum_add(&support->force[k], force[k]);
        if (support->kind != SOLID_SUPPORT_FIXED)
            exact_sum_add(&support->work, force[k] * v[k] * dt);
    }
}
