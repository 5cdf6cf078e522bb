/*
 * A ball that rests on a plane under gravity, at the start already as deep as its weight asks
 * for; with a speed or spin of its own.  An incline is a level plane under tilted gravity.
 */
#ifndef TREMIE_TESTS_VERIFICATION_RESTING_H
#define TREMIE_TESTS_VERIFICATION_RESTING_H

#include "base/vec3.h"
#include "impact.h"

struct simulation;

extern const struct impact_solid resting_solid; /* of ball and plane */
extern const double resting_radius;             /* [m] */
extern const double resting_gravity;            /* [m/s2] */
extern const double resting_step;               /* [s] */

struct resting {
    double friction;
    const char *more; /* further keys of the pair, each after a comma; NULL: none */
    double stiffness; /* of the linear law, which `more` asks for [N/m]; 0: Hertz */
    double angle;     /* of the incline, which falls along x [rad] */
    double speed;     /* along x [m/s] */
    struct vec3 spin; /* [rad/s] */
};

/* Overlap at rest [m]. */
double resting_overlap(const struct resting *resting);
/* Restitution is .5.  verify_scene_free() releases it. */
struct simulation *resting_scene(const struct resting *resting);

/* n steps after each of which the ball's spin is cleared: a job has no means to keep a sphere
 * from turning. */
void resting_slide(struct simulation *sim, int n);

#endif
