/* Gravity as a function of time: constant, turning or tabulated (THEORY.md, 5.1).  Local. */
#ifndef TREMIE_MODEL_GRAVITY_H
#define TREMIE_MODEL_GRAVITY_H

#include <stdbool.h>

#include "base/vec3.h"

struct job;

/* Does it ever change? */
bool gravity_varies(const struct job *job);
struct vec3 gravity_at(const struct job *job, double time); /* [m/s2] */
/* Of all times. */
double gravity_most(const struct job *job); /* [m/s2] */

#endif
