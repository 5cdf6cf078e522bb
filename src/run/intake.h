/*
 * A job on its way in: the file of the command line, or one variant of its sweep, read, laid
 * beside what a run that goes on has used, completed from the scene, and given to all ranks.
 */
#ifndef TREMIE_RUN_INTAKE_H
#define TREMIE_RUN_INTAKE_H

#include <stdbool.h>

struct comm;
struct job;
struct mistakes;
struct options;

/* Reads the job; false with all mistakes listed.  `options` name the variant and the run's own
 * folder.  Local, on one rank. */
bool intake_read(struct job *job, const struct options *options, int n_ranks,
                 struct mistakes *mistakes);
/* The same for all ranks: mistakes are printed, and everybody gets the job and its complete
 * text, which the caller frees.  Returns a REPORT_ status.  Collective. */
int intake_share(const struct comm *comm, const struct options *options, struct job *job,
                 char **text);
/* Frees the job and the meshes that were built of it. */
void intake_clear(struct job *job);
/* The folder of a run or study, as the options or the job's name have it.  The caller frees
 * it. */
char *intake_folder(const struct options *options);

#endif
