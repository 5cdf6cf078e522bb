/* What snapshots hold of bodies that deform. */
#ifndef TREMIE_RUN_DEFORM_CAPTURE_H
#define TREMIE_RUN_DEFORM_CAPTURE_H

struct simulation;
struct snapshot;

/* Adds all of them to a snapshot, between deform_plan() and deform_move().  Collective. */
void deform_capture(struct simulation *sim, struct snapshot *snapshot);

#endif
