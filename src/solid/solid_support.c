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

void solid_supports_init_turns(struct solid_supports *supports)
{
    supports->turn_of_node =
        array_allocate((size_t)supports->n_nodes, sizeof *supports->turn_of_node);
    for (int i = 0; i < supports->n_nodes; i++)
        for (int k = 0; k < 3; k++)
            supports->turn_of_node[i][k] = -1;
}

void solid_supports_clear(struct solid_supports *supports)
{
    for (int s = 0; s < supports->n; s++) {
        solid_table_clear(&supports->list[s].table);
        free(supports->list[s].places);
    }
    free(supports->list);
    free(supports->of_node);
    free(supports->turn_of_node);
    *supports = (struct solid_supports){0};
}

static void append(struct solid_supports *supports, const struct solid_support *support)
{
    ARRAY_GROW(supports->list, supports->n + 1, supports->capacity);
    supports->list[supports->n++] = *support;
}

static void hold(struct solid_supports *supports, int (*of_node)[3],
                 enum solid_support_kind kind, int direction, const struct solid_table *table,
                 int n_nodes, const int *nodes)
{
    CHECK(direction >= 0 && direction < 3, "there is no direction %d", direction);
    struct solid_support support = {
        .kind = kind, .direction = direction, .turns = of_node == supports->turn_of_node};
    if (kind != SOLID_SUPPORT_FIXED)
        support.table = solid_table_copy(table);
    append(supports, &support);
    for (int k = 0; k < n_nodes; k++)
        of_node[nodes[k]][direction] = supports->n - 1;
}

void solid_supports_add(struct solid_supports *supports, enum solid_support_kind kind,
                        int direction, const struct solid_table *table, int n_nodes,
                        const int *nodes)
{
    hold(supports, supports->of_node, kind, direction, table, n_nodes, nodes);
}

void solid_supports_add_turn(struct solid_supports *supports, enum solid_support_kind kind,
                             int direction, const struct solid_table *table, int n_nodes,
                             const int *nodes)
{
    CHECK(supports->turn_of_node != NULL, "no node turns about the axis %d", direction);
    hold(supports, supports->turn_of_node, kind, direction, table, n_nodes, nodes);
}

void solid_supports_add_motion(struct solid_supports *supports, int n_motions,
                               const struct job_motion *motions, int n_nodes, const int *nodes)
{
    struct solid_support support = {
        .kind = SOLID_SUPPORT_MOTION, .n_motions = n_motions, .motions = motions};
    support.places = array_allocate((size_t)n_motions, sizeof *support.places);
    append(supports, &support);
    for (int k = 0; k < n_nodes; k++)
        for (int direction = 0; direction < 3; direction++) {
            supports->of_node[nodes[k]][direction] = supports->n - 1;
            if (supports->turn_of_node != NULL)
                supports->turn_of_node[nodes[k]][direction] = supports->n - 1;
        }
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

/* Turned by all motions at a time, or turned back. */
static struct vec3 turned(const struct solid_support *support, double time, struct vec3 r)
{
    for (int m = 0; m < support->n_motions; m++) {
        const struct motion_place place = motion_place(&support->motions[m], time);
        r = motion_turn(&place, r);
    }
    return r;
}

/* The angular velocity with which a step's Cayley rotation is the one from where motions were
 * to where they are.  (13.17) */
static struct vec3 spin_of_motion(const struct solid_support *support, double time, double dt)
{
    static const struct vec3 unit[3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    struct vec3 sum = {0.0, 0.0, 0.0};
    double trace = 0.0;
    for (int k = 0; k < 3; k++) {
        const struct vec3 before = turned(support, time - dt, unit[k]),
                          now = turned(support, time, unit[k]);
        sum = vec3_add(sum, vec3_cross(before, now));
        trace += vec3_dot(before, now);
    }
    return vec3_scale(2.0 / ((1.0 + trace) * dt), sum);
}

static struct vec3 spin_at(const struct solid_support *support, double time, double dt)
{
    if (support->kind == SOLID_SUPPORT_MOTION)
        return spin_of_motion(support, time, dt);
    const double rate = (shift_at(support, time) - shift_at(support, time - dt)) / dt;
    return (struct vec3){rate, rate, rate};
}

void solid_supports_set(struct solid_supports *supports, int64_t step, double dt)
{
    const double time = (double)step * dt;
    for (int s = 0; s < supports->n; s++) {
        struct solid_support *support = &supports->list[s];
        support->shift = shift_at(support, time);
        for (int m = 0; m < support->n_motions; m++)
            support->places[m] = motion_place(&support->motions[m], time);
        if (supports->turn_of_node != NULL)
            support->spin = spin_at(support, time, dt);
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

void solid_supports_book_turn(struct solid_supports *supports, int node, const double moment[3],
                              const double w[3], double dt)
{
    const int *held = supports->turn_of_node[node];
    for (int k = 0; k < 3; k++)
        if (held[k] >= 0 && supports->list[held[k]].kind != SOLID_SUPPORT_FIXED)
            exact_sum_add(&supports->list[held[k]].work, moment[k] * w[k] * dt);
}

void solid_supports_spin(const struct solid_supports *supports, int node, double spin[3])
{
    const int *held = supports->turn_of_node[node];
    for (int k = 0; k < 3; k++) {
        if (held[k] < 0)
            continue;
        const struct vec3 *own = &supports->list[held[k]].spin;
        spin[k] = k == 0 ? own->x : k == 1 ? own->y : own->z;
    }
}
