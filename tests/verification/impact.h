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

struct impact {
    const char *rest; /* YAML: materials and contact */
    const char *material[2];
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

/* Effective modulus of a pair [Pa] (THEORY.md (1.1)). */
double impact_modulus(double young_1, double poisson_1, double young_2, double poisson_2);
/* Elastic Hertz impact (1.25): largest overlap [m], its force [N], duration [s]. */
struct impact_hertz {
    double overlap, force, duration;
};
struct impact_hertz impact_hertz(double modulus, double radius, double mass, double speed);
/* Mass of a sphere [kg]. */
double impact_mass(double density, double radius);

#endif
