/*
 * `tremie run` and `tremie check` of a job, or of all that its sweep makes of it.
 */
#ifndef TREMIE_RUN_STUDY_H
#define TREMIE_RUN_STUDY_H

struct comm;
struct options;

/*
 * Without a sweep: runs or checks the job.  With one: the variant that is asked for, in a
 * folder of its own inside the study's; else all of them, one after the other: one that has
 * ended does nothing, one that fails does not keep the next ones from running, one that is
 * asked to stop ends the study; `check` lists and checks them.  All are checked before the
 * first one runs.  Returns a REPORT_ status.  Collective.
 */
int study_run_or_check(const struct comm *comm, const struct options *options);

#endif
