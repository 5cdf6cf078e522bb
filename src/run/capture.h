/*
 * Snapshots of a run (store/snapshot.h): when they are due and what they hold.
 *
 * A snapshot belongs to the instant step * dt, as a sample of the series does: it is taken when
 * the forces of that instant are known and before spheres move on, with velocities brought from
 * the half step to the step.  It is written after the step.  Taking one changes nothing that
 * the next step needs.
 */
#ifndef TREMIE_RUN_CAPTURE_H
#define TREMIE_RUN_CAPTURE_H

#include <stdbool.h>
#include <stdint.h>

#include "store/snapshot.h"
#include "store/xdmf.h"

struct run_folder;
struct simulation;

struct capture {
    int64_t every; /* steps between snapshots; 0: none */
    bool waits;    /* one was taken and is not written yet */
    struct snapshot snapshot;
    struct xdmf index; /* of the run's folder, on rank 0 */
};

void capture_init(struct capture *capture, const struct simulation *sim);
void capture_clear(struct capture *capture);
/* Reads what snapshots there are up to the present step, so that the index describes these
 * alone from now on.  Returns a REPORT_ status.  Local, on rank 0. */
int capture_open(struct simulation *sim, const struct run_folder *folder);
/* Takes a snapshot where one is due.  Collective. */
void capture_take(struct simulation *sim);
/* Writes it, if one was taken.  Returns a REPORT_ status.  Collective. */
int capture_write(struct simulation *sim, const struct run_folder *folder);

#endif
