/*
 * What can be known of a job before it runs: the scene, critical steps, cost, and what looks
 * wrong.
 */
#ifndef TREMIE_RUN_CHECK_H
#define TREMIE_RUN_CHECK_H

#include <stdbool.h>

struct comm;
struct job;
struct mistakes;

/* Fills in what only the scene tells (the domain, the automatic step) and lists mistakes that
 * only the scene shows.  Local, on the rank that read the job. */
bool check_complete(struct job *job, int n_ranks, struct mistakes *mistakes);

/* Fills in the same from the job as used, of the run that is to go on: once it has a state of
 * its own what it started from (`start`) may be gone; before, it starts from the same
 * checkpoint.  Call check_complete next.  Local. */
void check_recall(struct job *job, const struct job *used, bool has_state);

/* `tremie check`: prints the scene, critical steps, cost estimate and warnings, after a look at
 * the contacts of the start; with `advise` also which models its bodies need (run/advise.h).
 * Speaks on one rank.  Collective. */
void check_print(const struct job *job, const struct comm *comm, bool advise);

#endif
