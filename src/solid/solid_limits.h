/*
 * How far a solid's step may go, and how a solid fails.  Local: the smallest step and the
 * lowest numbered failure of all ranks are the run's.
 */
#ifndef TREMIE_SOLID_SOLID_LIMITS_H
#define TREMIE_SOLID_SOLID_LIMITS_H

#include <stdbool.h>

#include "base/vec3.h"

struct solid;

struct solid_limits {
    double step; /* stable up to this [s] */
    int element; /* that allows no more; -1: none here */
    int node;    /* its corner with the stiffest contacts; -1: none touches */
};

/* Of the elements computed here, as they are now.  Contacts on each node: sums of their
 * stiffness [N/m] and damping [kg/s]; NULL: none.  (12.11) to (12.13) */
struct solid_limits solid_limits_find(const struct solid *solid, const double *stiffness,
                                      const double *damping);
/* The same, if `touched` of those elements alone that have contacts; found in full only where
 * it is less than dt, else it is at least that. */
struct solid_limits solid_limits_within(const struct solid *solid, const double *stiffness,
                                        const double *damping, bool touched, double dt);

enum solid_limits_failure {
    SOLID_LIMITS_FINE,
    SOLID_LIMITS_INVERTED, /* volume not positive, at the step or half a step back; a shell or
                              membrane without area or thickness, or over itself */
    SOLID_LIMITS_NOT_A_NUMBER,
    SOLID_LIMITS_HOURGLASS, /* more energy in hourglass modes than should be */
};

struct solid_limits_fault {
    enum solid_limits_failure failure;
    int element;
    struct vec3 place; /* its middle [m] */
    double value;      /* volume [m3], or share of hourglass energy [-] */
};

/* What made solid_forces() return false: of the elements computed here the first that failed,
 * with the nodes as they still are. */
struct solid_limits_fault solid_limits_fault(const struct solid *solid, double dt);
/* With totals of all ranks: does hourglass energy, stored and dissipated, exceed a share of
 * internal energy [J]?  Names the element here that has the most. */
struct solid_limits_fault solid_limits_hourglass(const struct solid *solid, double hourglass,
                                                 double internal, double share);

#endif
