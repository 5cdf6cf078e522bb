/*
 * What a run reports over time: the rows of the "series" table, and the running totals behind
 * them.
 *
 * A sample belongs to the instant step * dt: it is taken when the forces of that instant are
 * known and before spheres move on, so velocities are brought from the half step to the step
 * with them.  All totals over ranks are exact sums, so rows do not depend on who owned what.
 * Totals that run over steps are state: "monitors" in checkpoints.
 */
#ifndef TREMIE_RUN_OBSERVE_H
#define TREMIE_RUN_OBSERVE_H

#include <stdint.h>

#include "base/exact_sum.h"
#include "store/series.h"

struct simulation;

/* Totals beside those of bodies and sections.  Shares of this rank. */
enum observe_total {
    OBSERVE_ENERGY_START,     /* all energy at step 0 [J] */
    OBSERVE_REMOVED_ENERGY,   /* carried away by spheres that left [J] */
    OBSERVE_REMOVED_FRICTION, /* dissipated by them before they left [J] */
    OBSERVE_REMOVED_DAMPING,
    OBSERVE_WOUND,           /* work that springs between spheres took up [J] */
    OBSERVE_LAST_STEP,       /* step of the last sample, plus one; on rank 0 */
    OBSERVE_TURNED,          /* largest energy turned over so far [J]; on rank 0 */
    OBSERVE_OVERLAP,         /* largest overlap/radius since then, times 2^40; on rank 0 */
    OBSERVE_INSERTED_ENERGY, /* carried in by spheres that came in [J] */
    OBSERVE_CROSSED_X,       /* mass times periods crossed [kg m] */
    OBSERVE_CROSSED_Y,
    OBSERVE_CROSSED_Z,
    OBSERVE_GRAVITY_WORK,   /* of gravity that changes, on the spheres [J] */
    OBSERVE_TOUCH_FRICTION, /* dissipated between bodies [J] */
    OBSERVE_TOUCH_DAMPING,
    OBSERVE_N_TOTALS,
};

struct observe {
    struct exact_sum totals[OBSERVE_N_TOTALS];
    struct series table;           /* on rank 0 */
    struct exact_sum *work_before; /* of each body before this step's forces, where looked at */
    double energy_error;           /* of the last balance over the energy turned over [-] */
};

void observe_init(struct observe *observe, const struct simulation *sim);
void observe_clear(struct observe *observe);
/* Notes what the step's forces will add to, before them.  Local. */
void observe_before(struct simulation *sim);
/* Takes a sample: forces are known, spheres have not moved.  Collective. */
void observe_sample(struct simulation *sim);
/* Makes the energy balance alone, at the same instant of a step.  Collective. */
void observe_energy(struct simulation *sim);
/* Notes this step's largest overlap, the same on all ranks. */
void observe_overlap(struct simulation *sim, double overlap);
/* Books who lies beyond a periodic boundary, before places are brought into the domain.
 * Local. */
void observe_crossings(struct simulation *sim);
/* Books what contacts with bodies that are no more held, before the step's forces.  Local. */
void observe_gone(struct simulation *sim);
/* Books the work of gravity that has changed since the step before.  Collective. */
void observe_gravity(struct simulation *sim);
/* Velocity v and spin w of sphere i brought to the step, when its forces are known.  Local. */
void observe_motion(const struct simulation *sim, int i, double v[3], double w[3]);
/* Books what springs hold at the start of a run that takes contacts over: it was wound before.
 * Local. */
void observe_taken_over(struct simulation *sim);
/* Books sphere i as leaving the run. */
void observe_removed(struct simulation *sim, int i);

/* Books sphere i as coming into the run. */
void observe_inserted(struct simulation *sim, int i);

/* All running totals under their names, for checkpoints: n names and the sums' places. */
struct observe_monitor {
    char name[64];
    struct exact_sum *sum;
};
/* Lists them; the caller frees *monitors. */
int observe_monitors(struct simulation *sim, struct observe_monitor **monitors);

#endif
