/*
 * A job that starts from another one's state (`start: {from: ...}`): its spheres with their
 * places, velocities and ids, and what their contacts remember.
 *
 * Materials are matched by name; one that spheres have and the job lacks is a mistake.
 * Contacts between spheres stay.  Contacts with a body stay where the job has that body as it
 * was: same name, material and surface, at rest in both; others begin anew.  Time, sums and
 * counts begin at 0.  Once the run has a checkpoint the other one is not needed any more.
 */
#ifndef TREMIE_RUN_CHAIN_H
#define TREMIE_RUN_CHAIN_H

#include <stdbool.h>
#include <stdint.h>

#include "job/job.h"
#include "model/packing.h"

struct comm;
struct mistakes;
struct simulation;

struct chain {
    char *path; /* the checkpoint */
    int64_t step;
    double time;            /* of the other run [s] */
    struct job job;         /* the other job */
    struct packing packing; /* its spheres, as rows with the job's materials */
    int *material, *body;   /* the job's, for each of the other one; -1: none */
    bool same_space;        /* the same directions repeat */
};

/* Finds and reads the state that `job` starts from.  Returns false with the mistakes listed;
 * then there is nothing to close.  Local. */
bool chain_open(struct chain *chain, const struct job *job, struct mistakes *mistakes);
void chain_close(struct chain *chain);

/* Gives this rank's share of that state to a simulation that has begun and has no spheres yet.
 * Returns a REPORT_ status, the reason said.  Collective. */
int chain_begin(const struct chain *chain, struct simulation *sim);

#endif
