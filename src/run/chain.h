/*
 * A job that starts from another one's state (`start: {from: ...}`): its spheres with their
 * places, velocities and ids, and what their contacts remember.
 *
 * Materials are matched by name; one that spheres have and the job lacks is a mistake.  So are
 * groups; those that the job lacks are counted on from its own, under the names that they had.
 * Contacts between spheres stay.  Contacts with a body stay where the job has that body as it
 * was: same name, material and surface, at rest in both; others begin anew.  Time, sums and
 * counts begin at 0.  Once the run has a checkpoint the other one is not needed any more; until
 * then the job as used names the file and its checksum, so that a run that was killed before
 * starts from the same again whatever the other run has done since.
 */
#ifndef TREMIE_RUN_CHAIN_H
#define TREMIE_RUN_CHAIN_H

#include <stdbool.h>
#include <stdint.h>

#include "job/job.h"
#include "model/packing.h"

struct checkpoint;
struct comm;
struct contact_record;
struct mistakes;
struct simulation;

struct chain {
    char *path; /* the checkpoint */
    int64_t step;
    double time;            /* of the other run [s] */
    struct job job;         /* the other job */
    struct packing packing; /* its spheres, as rows with the job's materials */
    int *material, *body;   /* the job's, for each of the other one; -1: none */
    int n_groups, *group;   /* the job's, for each group of the other one */
    int *group_of;          /* the job's, for each row */
    int n_names;            /* of groups that come with the spheres, in the order of numbers */
    const char **names;     /* they belong to the other job */
    bool same_space;        /* the same directions repeat */
};

/* The checkpoint that `job` starts from: the file itself, the one that it names in a run's
 * folder, or the newest there; NULL where there is none.  The caller frees it.  Local. */
char *chain_checkpoint(const struct job *job);

/* Finds and reads the state that `job` starts from.  Returns false with the mistakes listed;
 * then there is nothing to close.  Local. */
bool chain_open(struct chain *chain, const struct job *job, struct mistakes *mistakes);
void chain_close(struct chain *chain);

/* Gives this rank's share of that state to a simulation that has begun and has no spheres yet;
 * contacts between spheres are still to be read from `checkpoint`, which the caller clears.
 * Returns a REPORT_ status, the reason said.  Collective. */
int chain_begin(const struct chain *chain, struct simulation *sim,
                struct checkpoint *checkpoint);
/* Of records that were read so, how many come along, as the job has them. */
int chain_renew_contacts(const struct chain *chain, const struct simulation *sim, int n,
                         struct contact_record *records);

#endif
