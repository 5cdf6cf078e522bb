/*
 * How much of a body has to be modelled: what each model, rigid, membrane, shell or solid,
 * would neglect of how it yields to spheres, and what it would cost (THEORY.md 10.5).
 * Estimates, for people.
 */
#ifndef TREMIE_RUN_ADVISE_H
#define TREMIE_RUN_ADVISE_H

#include "base/vec3.h"

struct bodies;
struct job;
struct limits_spheres;
struct materials;

/* All spheres of the start and those that come in. */
struct advise_cloud {
    struct vec3 low, high; /* corners of the box around these places [m] */
    double seconds;        /* a step of theirs, on one rank [s] */
};

/* `tremie check --advise`: a few lines for each body, and what looks like a thickness in other
 * units.  Local. */
void advise_print(const struct job *job, const struct bodies *bodies,
                  const struct materials *materials, const struct limits_spheres *spheres,
                  const struct advise_cloud *cloud);

#endif
