/* A run from its folder's opening to its end, and what can be told of one from outside. */
#ifndef TREMIE_RUN_DRIVE_H
#define TREMIE_RUN_DRIVE_H

struct comm;
struct job;
struct options;

/* Runs the job as used (job_text its complete text).  Returns a REPORT_ status.  Collective. */
int drive_run(const struct comm *comm, const struct options *options, const struct job *job,
              const char *job_text);
/* Prints RUN/status. */
int drive_status(const char *run);
/* Asks a run to stop through the file RUN/stop. */
int drive_stop(const char *run);

#endif
