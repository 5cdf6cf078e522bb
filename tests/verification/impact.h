/*
 * One impact, sphere on sphere or sphere on plane, for cases that need many of them.
 *
 * The normal at first touch is z.  Sphere 0 is above and sphere 1, or the plane, below; places
 * at the start are such that surfaces first touch a chosen share of a step after a step, with
 * the centres one above the other.
 */
#ifndef TREMIE_TESTS_VERIFICATION_IMPACT_H
#define TREMIE_TESTS_VERIFICATION_IMPACT_H

#include "base/vec3.h"

struct impact_solid {
    double young, poisson, density; /* [Pa], [-], [kg/m3] */
};

/* As stiff as a job may say. */
extern const struct impact_solid impact_rigid;

struct impact {
    const struct impact_solid *solid[2]; /* of sphere 0, and of sphere 1 or the plane */
    double friction, restitution;
    const char *more; /* further keys of the pair, each after a comma; NULL: none */
    double radius[2]; /* [m]; the second 0: a plane */
    struct vec3 velocity[2], spin[2];
    double dt;    /* [s] */
    double phase; /* of first touch, 0 to 1 [-] */
};

struct impact_result {
    double overlap_max, force_max; /* [m], [N]; largest of parabolas through the steps */
    double duration;               /* from touch to touch [s] */
    double pushed;                 /* from touch to the last step with a normal force [s] */
    int steps;                     /* with overlap */
    double mass[2], inertia[2];    /* [kg], [kg m2] */
    struct vec3 velocity[2], spin[2];
    double kinetic[2]; /* before and after, rotation included [J] */
    double balance;    /* of the ledger at the end, over the kinetic energy before [-] */
};

struct impact_result impact_run(const struct impact *impact);

/* Elastic Hertz impact (1.25): largest overlap [m], its force [N], duration [s]. */
struct impact_hertz {
    double overlap, force, duration;
};
/* That of an impact, were it elastic; dt and phase need not be known yet. */
struct impact_hertz impact_hertz(const struct impact *impact);

/* Effective modulus of two solids [Pa] (1.1). */
double impact_modulus(const struct impact_solid *a, const struct impact_solid *b);
/* Mass of a sphere [kg]. */
double impact_mass(const struct impact_solid *solid, double radius);

#endif
