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

void solid_turns_begin(struct solid_turns *turns)
{
    if (turns->n_nodes == 0)
        return;
    memset(turns->internal, 0, (size_t)turns->n_nodes * sizeof *turns->internal);
    memset(turns->external, 0, (size_t)turns->n_nodes * sizeof *turns->external);
}

/* A node as it is about to turn. */
struct advance {
    double spin[3];    /* at n + 1/2 [rad/s] */
    double support[3]; /* moment of what holds it [N m] */
};

/* As nodes move, (5.3), with inertia for mass; what is held turns as prescribed. */
static struct advance advance_at(const struct solid *solid, int i, double dt)
{
    const struct solid_turns *turns = &solid->turns;
    const double half = 0.5 * solid->damping * dt, push = 1.0 / (1.0 + half);
    const double *w = solid_turn_spin(turns, i);
    const double inertia = turns->inertia[i];
    struct advance advance = {{0.0}, {0.0}};
    double moment[3], held[3];
    for (int k = 0; k < 3; k++) {
        moment[k] = turns->internal[i][k] + turns->external[i][k] + turns->contact[i][k];
        advance.spin[k] = w[k] * ((1.0 - half) * push) + push * dt * (moment[k] / inertia);
        held[k] = advance.spin[k];
    }
    solid_supports_spin(&solid->supports, i, held);
    for (int k = 0; k < 3; k++) {
        if (solid->supports.turn_of_node[i][k] < 0)
            continue;
        advance.spin[k] = held[k];
        advance.support[k] =
            inertia * ((held[k] - w[k]) / dt + solid->damping * (0.5 * (held[k] + w[k]))) -
            moment[k];
    }
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
    const struct advance advance = advance_at(solid, i, dt);
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
    const struct advance advance = advance_at(solid, i, dt);
    memcpy(moment, advance.support, sizeof none);
}

void solid_turns_move(struct solid *solid, int64_t step, double dt, bool forget)
{
    struct solid_turns *turns = &solid->turns;
    const double earlier = step > 0 ? 0.5 : 0.0; /* nothing was done before the start */
    for (int i = 0; i < solid->n_nodes; i++) {
        if (!solid->moves[i] || !(turns->inertia[i] > 0.0))
            continue;
        const struct advance advance = advance_at(solid, i, dt);
        double *spin = solid_turn_spin(turns, i), w[3], power[SOLID_N_WORKS] = {0.0};
        for (int k = 0; k < 3; k++)
            w[k] = earlier * spin[k] + 0.5 * advance.spin[k];
        add_power(solid, i, &advance, w, power);
        for (int k = 0; k < SOLID_N_WORKS; k++)
            solid->work[i][k] += power[k] * dt;
        solid_supports_book_turn(&solid->supports, i, advance.support, w, dt);
        memcpy(spin, advance.spin, sizeof advance.spin);
        if (forget)
            memset(turns->contact[i], 0, sizeof turns->contact[i]);
    }
}
