/*
 * Bodies that forces move, in the step: the force of the spheres on each is summed exactly over
 * all ranks, which then move the body alike (model/rigid).  One small reduction a step, in jobs
 * that have such bodies.
 */
#ifndef TREMIE_RUN_FORCED_H
#define TREMIE_RUN_FORCED_H

#include "base/exact_sum.h"

struct simulation;

struct forced {
    struct exact_sum (*before)[6]; /* loads of such bodies before this step's forces */
};

void forced_init(struct forced *forced, const struct simulation *sim);
void forced_clear(struct forced *forced);
/* Before the forces of a step.  Local. */
void forced_begin(struct simulation *sim);
/* After them: finds where the bodies will be and what energies they have.  Collective. */
void forced_plan(struct simulation *sim);
/* With the integration: they go there.  Local. */
void forced_move(struct simulation *sim);

#endif
