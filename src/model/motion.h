/*
 * One prescribed motion of a body as a function of time: translation, rotation, oscillation,
 * swing and path of struct job_motion (THEORY.md, section 3).
 *
 * Places are those at a time; velocities are those between two times, such that they lead from
 * the one place to the other: velocities at half steps.  Nothing is accumulated.
 */
#ifndef TREMIE_MODEL_MOTION_H
#define TREMIE_MODEL_MOTION_H

#include <stdbool.h>

#include "base/vec3.h"

struct job_motion;

/* X -> pivot + Q (X - pivot) + shift, Q by the angle whose sine and cosine these are. */
struct motion_place {
    struct vec3 pivot, axis; /* [m]; length 1, or 0 where nothing turns */
    struct vec3 shift;       /* [m] */
    double sine, cosine;
};

/* The point pivot + shift moves at velocity, everything turns about it at spin. */
struct motion_rate {
    struct vec3 velocity; /* [m/s] */
    struct vec3 spin;     /* [rad/s] */
};

/* Does it ever move anything? */
bool motion_moves(const struct job_motion *motion);
/* Changes where `time` changes what motion_place() gives: how long it has lasted [s]. */
double motion_duration(const struct job_motion *motion, double time);
struct motion_place motion_place(const struct job_motion *motion, double time);
struct vec3 motion_apply(const struct motion_place *place, struct vec3 x);
/* Only turned about the axis. */
struct vec3 motion_turn(const struct motion_place *place, struct vec3 r);
/* Mean velocities between two times, half a step before `half` and half a step after. */
struct motion_rate motion_rate(const struct job_motion *motion, double half, double dt);

/* Bounds over all time up to `until`. */
double motion_speed_most(const struct job_motion *motion);               /* [m/s] */
double motion_spin_most(const struct job_motion *motion);                /* [rad/s] */
double motion_shift_most(const struct job_motion *motion, double until); /* [m] */

#endif
