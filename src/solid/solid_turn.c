/* See solid_turn.h. */
#include "solid/solid_turn.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "solid/solid.h"

void solid_turns_init(struct solid_turns *turns, int n_nodes)
{
    const size_t n = (size_t)n_nodes;
    turns->n_nodes = n_nodes;
    turns->spin = array_allocate_rows(n + SOLID_ELEMENT_CORNERS, sizeof *turns->spin);
    turns->inertia = array_allocate(n, sizeof *turns->inertia);
    turns->internal = array_allocate(n, sizeof *turns->internal);
    turns->external = array_allocate(n, sizeof *turns->external);
    turns->contact = array_allocate(n, sizeof *turns->contact);
}

void solid_turns_clear(struct solid_turns *turns)
{
    free(turns->spin);
    free(turns->inertia);
    free(turns->internal);
    free(turns->external);
    free(turns->contact);
    *turns = (struct solid_turns){0};
}

void solid_turns_begin(struct solid_turns *turns, bool loaded)
{
    if (turns->n_nodes == 0)
        return;
    memset(turns->internal, 0, (size_t)turns->n_nodes * sizeof *turns->internal);
    if (loaded)
        memset(turns->external, 0, (size_t)turns->n_nodes * sizeof *turns->external);
}

/* A node as it is about to turn. */
struct advance {
    double spin[3];    /* at n + 1/2 [rad/s] */
    double support[3]; /* moment of what holds it [N m] */
};

static void hold(const struct solid *solid, int i, double dt, const double moment[3],
                 struct advance *advance)
{
    const double *w = solid_turn_spin(&solid->turns, i);
    solid_supports_spin(&solid->supports, i, advance->spin);
    for (int k = 0; k < 3; k++) {
        const double held = advance->spin[k];
        if (solid->supports.turn_of_node[i][k] >= 0)
            advance->support[k] =
                solid->turns.inertia[i] *
                    ((held - w[k]) / dt + solid->damping * (0.5 * (held + w[k]))) -
                moment[k];
    }
}

/* Moment on a node about k. */
static inline double moment_at(const struct solid_turns *turns, int i, int k)
{
    return turns->internal[i][k] + turns->external[i][k] + turns->contact[i][k];
}

/* Its angular velocity half a step later, if nothing holds it. */
static inline double spin_at(const struct solid_turns *turns, int i, int k, double moment,
                             double per_inertia, const struct solid_pace *pace)
{
    return solid_turn_spin(turns, i)[k] * pace->keep + pace->kick * (moment * per_inertia);
}

/* As nodes move, (5.3), with inertia for mass; what is held turns as prescribed. */
static struct advance advance_at(const struct solid *solid, int i,
                                 const struct solid_pace *pace)
{
    const double per_inertia = 1.0 / solid->turns.inertia[i];
    struct advance advance = {{0.0}, {0.0}};
    double moment[3];
    for (int k = 0; k < 3; k++) {
        moment[k] = moment_at(&solid->turns, i, k);
        advance.spin[k] = spin_at(&solid->turns, i, k, moment[k], per_inertia, pace);
    }
    if (solid_supports_hold(solid->supports.turn_of_node[i]))
        hold(solid, i, pace->dt, moment, &advance);
    return advance;
}

/* Of what works on a node that turns at w. */
static void add_power(const struct solid *solid, int i, const struct advance *advance,
                      const double w[3], double power[])
{
    const struct solid_turns *turns = &solid->turns;
    const double *before = solid_turn_spin(turns, i);
    for (int k = 0; k < 3; k++) {
        const double now = 0.5 * (before[k] + advance->spin[k]);
        power[SOLID_WORK_INTERNAL] -= turns->internal[i][k] * w[k];
        power[SOLID_WORK_LOADS] += turns->external[i][k] * w[k];
        power[SOLID_WORK_CONTACT] += turns->contact[i][k] * w[k];
        power[SOLID_WORK_SUPPORTS] += advance->support[k] * w[k];
        power[SOLID_WORK_DAMPING] += solid->damping * turns->inertia[i] * now * w[k];
    }
}

double solid_turns_power(const struct solid *solid, int i, double dt, double power[])
{
    const struct solid_turns *turns = &solid->turns;
    const double *w = solid_turn_spin(turns, i);
    double kinetic = 0.0;
    if (!(turns->inertia[i] > 0.0))
        return 0.0;
    const struct solid_pace pace = solid_pace_of(solid, dt);
    const struct advance advance = advance_at(solid, i, &pace);
    add_power(solid, i, &advance, w, power);
    for (int k = 0; k < 3; k++)
        kinetic += 0.5 * turns->inertia[i] * w[k] * advance.spin[k];
    return kinetic;
}

void solid_turns_support(const struct solid *solid, int i, double dt, double moment[3])
{
    static const double none[3] = {0.0, 0.0, 0.0};
    memcpy(moment, none, sizeof none);
    if (solid->turns.n_nodes == 0 || !(solid->turns.inertia[i] > 0.0))
        return;
    const struct solid_pace pace = solid_pace_of(solid, dt);
    const struct advance advance = advance_at(solid, i, &pace);
    memcpy(moment, advance.support, sizeof none);
}

static void move_held(struct solid *solid, int i, const struct solid_pace *pace)
{
    const struct advance advance = advance_at(solid, i, pace);
    double *spin = solid_turn_spin(&solid->turns, i), w[3], power[SOLID_N_WORKS] = {0.0};
    for (int k = 0; k < 3; k++)
        w[k] = pace->earlier * spin[k] + 0.5 * advance.spin[k];
    add_power(solid, i, &advance, w, power);
    for (int k = 0; k < SOLID_N_WORKS; k++)
        solid->work[i][k] += power[k] * pace->dt;
    solid_supports_book_turn(&solid->supports, i, advance.support, w, pace->dt);
    memcpy(spin, advance.spin, sizeof advance.spin);
}

/* The same, component by component, where no support has to be known. */
static void move_free(struct solid *solid, int i, const struct solid_pace *pace)
{
    const struct solid_turns *turns = &solid->turns;
    const double inertia = turns->inertia[i], per_inertia = 1.0 / inertia;
    double *spin = solid_turn_spin(turns, i), *work = solid->work[i];
    double internal = 0.0, loads = 0.0, contact = 0.0, damping = 0.0;
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        const double before = spin[k];
        const double after = spin_at(turns, i, k, moment_at(turns, i, k), per_inertia, pace);
        const double mean = pace->earlier * before + 0.5 * after;
        internal -= turns->internal[i][k] * mean;
        loads += turns->external[i][k] * mean;
        contact += turns->contact[i][k] * mean;
        damping += solid->damping * inertia * (0.5 * (before + after)) * mean;
        spin[k] = after;
    }
    work[SOLID_WORK_INTERNAL] += internal * pace->dt;
    work[SOLID_WORK_LOADS] += loads * pace->dt;
    work[SOLID_WORK_CONTACT] += contact * pace->dt;
    work[SOLID_WORK_DAMPING] += damping * pace->dt;
}

void solid_turns_move(struct solid *solid, const struct solid_pace *pace, bool forget)
{
    struct solid_turns *turns = &solid->turns;
    for (int i = 0; i < solid->n_nodes; i++) {
        if (!solid->moves[i] || !(turns->inertia[i] > 0.0))
            continue;
        if (solid_supports_hold(solid->supports.turn_of_node[i]))
            move_held(solid, i, pace);
        else
            move_free(solid, i, pace);
        if (forget)
            memset(turns->contact[i], 0, sizeof turns->contact[i]);
    }
}
