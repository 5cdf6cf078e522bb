/*
 * How much wall time a scheduler leaves a run, as far as it says so in the environment.
 *
 * Slurm:  SLURM_JOB_END_TIME, when the job will be ended [s since 1970].
 * TORQUE: PBS_WALLTIME, what the job may take [s]; it began when the shell of its script did,
 *         which leads the session.
 * PBS Pro and OpenPBS name no time in the environment: scripts say --wall.
 * LSF names none either, but sends SIGUSR2 at the job's limit and waits ten minutes.
 *
 * All are local.
 */
#ifndef TREMIE_RUN_WALL_LIMIT_H
#define TREMIE_RUN_WALL_LIMIT_H

#include <stdbool.h>

/* Reads "90", "30 min", "12 h" or "12:00:00" into seconds above 0. */
bool wall_limit_read(const char *text, double *seconds);

/* Seconds that are left, infinite where nothing limits them; `asked` is what the command line
 * gives this process as a whole [s], 0: nothing.  *whose tells where the limit comes from. */
double wall_limit_left(double asked, const char **whose);

#endif
