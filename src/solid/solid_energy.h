/*
 * Energies of a solid at a step, between solid_forces() and solid_move().
 *
 * Kinetic energy is that of which leapfrog's balance closes to rounding, m v(n-1/2) v(n+1/2)/2:
 *
 *     kinetic + internal - loads - contact - gravity - supports + background = as at step 0
 *
 * and what elements took up is there, up to what the midpoint rule is off:
 *
 *     internal = elastic + plastic + hourglass + hourglass damped + damped   (12.17)
 */
#ifndef TREMIE_SOLID_SOLID_ENERGY_H
#define TREMIE_SOLID_SOLID_ENERGY_H

#include <stdint.h>

#include "base/exact_sum.h"

struct solid;

enum solid_energy {
    SOLID_ENERGY_KINETIC,
    SOLID_ENERGY_INTERNAL, /* work on elements; this and the next five as enum solid_work */
    SOLID_ENERGY_LOADS,
    SOLID_ENERGY_CONTACT,
    SOLID_ENERGY_GRAVITY,
    SOLID_ENERGY_SUPPORTS,
    SOLID_ENERGY_BACKGROUND, /* taken by mass-proportional damping */
    SOLID_ENERGY_ELASTIC,    /* what stress holds; of sheets also what modes would hold of it if
                             they were integrated in full: the share hourglass_stiffness */
    SOLID_ENERGY_PLASTIC,
    SOLID_ENERGY_HOURGLASS,
    SOLID_ENERGY_HOURGLASS_DAMPED,
    SOLID_ENERGY_DAMPED,
    SOLID_N_ENERGIES
};

struct solid_energies {
    struct exact_sum sums[SOLID_N_ENERGIES]; /* [J] */
};

/* Adds what this rank counts; exact_sum_reduce() makes totals of it.  Local. */
void solid_energies_add(struct solid *solid, int64_t step, double dt,
                        struct solid_energies *energies);
/* [J] */
double solid_energy_value(const struct solid_energies *energies, enum solid_energy energy);
/* Kinetic and internal energy less all that came from outside [J]. */
double solid_energy_balance(const struct solid_energies *energies);

#endif
