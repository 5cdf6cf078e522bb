/*
 * Rigid bodies: surfaces that are at rest or move as prescribed.
 *
 * Motion is a function of step x dt alone (never accumulated), so a restart finds the same
 * bits. The sine and cosine are our own (base/elementary.h).
 */
#ifndef TREMIE_MODEL_BODY_H
#define TREMIE_MODEL_BODY_H

#include <stdbool.h>
#include <stdint.h>

#include "base/vec3.h"
#include "model/mesh.h"

struct job;
struct job_body;

struct body {
    char *name;
    int material;
    struct mesh mesh;
    bool moves;
    /* Prescribed motion, as in struct job_body. */
    struct vec3 velocity, pivot, axis;
    double rate, start, stop;
    /* Present motion, set by bodies_place(): the point x of the body moves at
     * velocity_now + spin_now x (x - pivot_now). */
    struct vec3 velocity_now; /* [m/s] */
    struct vec3 spin_now;     /* [rad/s] */
    struct vec3 pivot_now;    /* [m] */
    double placed_for;        /* how long it had moved where the vertices now are [s] */
    double speed_max;         /* fastest vertex over all time, for allowances [m/s] */
};

struct bodies {
    int n;
    struct body *list;
};

void bodies_build(struct bodies *bodies, const struct job *job);
void bodies_clear(struct bodies *bodies);
/* Puts all moving bodies where they are at time step * dt, with the velocity they have at
 * (step - 1/2) * dt as the spheres' half-step velocities have.  Bodies at rest cost nothing. */
void bodies_place(struct bodies *bodies, int64_t step, double dt);

#endif
