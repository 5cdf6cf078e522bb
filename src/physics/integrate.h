/*
 * Central differences with half-step velocities (leapfrog), for spheres with rotation
 * (THEORY.md, "Integration"): v(n+1/2) from v(n-1/2) and the force at n, then x(n+1) from
 * v(n+1/2).
 */
#ifndef TREMIE_PHYSICS_INTEGRATE_H
#define TREMIE_PHYSICS_INTEGRATE_H

#include <stdbool.h>

#include "base/isa.h"
#include "model/sphere.h"

struct integrate_work {
    int n; /* owned spheres come first */
    struct sphere_row *motion, *spin, *force;
    double *dissipated_friction, *dissipated_damping; /* [J], added to when the ledger is on */
    double (*inverse_allowance)[2];                   /* [1/m] */
    double dt;                                        /* [s] */
    double gravity[3];                                /* [m/s2] */
    double snap[3]; /* (d + snap) - snap rounds a motion where space is periodic; else 0 [m] */
    double damping; /* mass-proportional [1/s]; 0: none */
    bool ledger, periodic;
    /* out */
    double spent[2]; /* largest share of each allowance that this step's motion used [-] */
    bool bad;        /* some place or velocity is NaN or infinite */
};

/* Moves n spheres by one step and clears their force rows: apply(work).  Local. */
struct integrate_kernel {
    void (*apply)(struct integrate_work *work);
};

/* The kernel for an instruction set, which must run; all give the same bits. */
struct integrate_kernel integrate_choose(enum isa isa);

#endif
