/* Solids by themselves, without the rest of the program: what their cases share. */
#ifndef TREMIE_TESTS_VERIFICATION_SPECIMEN_H
#define TREMIE_TESTS_VERIFICATION_SPECIMEN_H

#include <stdint.h>

#include "solid/solid.h"
#include "solid/solid_energy.h"

struct specimen {
    struct solid solid;
    int64_t step;
    double dt; /* [s] */
};

/* Before a step is moved: contacts push here. */
typedef void specimen_push(struct specimen *specimen, void *what);

/* At step 0 with this share of the step that the solid allows. */
void specimen_make(struct specimen *specimen, const struct solid_parts *mesh,
                   const struct solid_material *material, double share);
void specimen_free(struct specimen *specimen);

/* n steps; an element that fails ends the case. */
void specimen_steps(struct specimen *specimen, int64_t n);
void specimen_pushed_steps(struct specimen *specimen, int64_t n, specimen_push *push,
                           void *what);
/* Brings it to rest under its loads, from rest: what it does undamped until a node turns back
 * in a direction tells a period, then mass-proportional damping that is critical for that,
 * until two more of them change nothing.  Returns how far the node has moved [m]. */
double specimen_settle(struct specimen *specimen, int node, int direction);
/* Energies at the present step; what is done to bring forces to it is not done again by the
 * next of the steps above. */
struct solid_energies specimen_energies(struct specimen *specimen);

/* Nodes whose reference lies at a coordinate (0 to 2); returns how many, the caller frees. */
int specimen_plane(const struct specimen *specimen, int axis, double coordinate, int **nodes);
/* Holds all of them in a direction. */
void specimen_fix(struct specimen *specimen, int axis, double coordinate, int direction);
/* Holds their turning about an axis. */
void specimen_fix_turn(struct specimen *specimen, int axis, double coordinate, int direction);

/* The largest |stress component| of all elements [Pa]. */
double specimen_stress_most(const struct specimen *specimen);
/* The largest |force| of hourglass modes [N]. */
double specimen_hourglass_most(const struct specimen *specimen);

#endif
