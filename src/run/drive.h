/* A run from its folder's opening to its end. */
#ifndef TREMIE_RUN_DRIVE_H
#define TREMIE_RUN_DRIVE_H

struct comm;
struct job;
struct options;

/* Runs the job as used (job_text its complete text), and frees the meshes that are kept with
 * it.  Returns a REPORT_ status.  Collective. */
int drive_run(const struct comm *comm, const struct options *options, struct job *job,
              const char *job_text);

#endif
