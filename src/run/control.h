/*
 * Wishes from outside: signals that ask the run to stop with a checkpoint.
 *
 * SIGUSR1, SIGUSR2, SIGTERM and SIGINT only set a flag; the step's one reduction makes it
 * collective, so one rank that got the signal is enough.  (mpirun forwards USR1 and USR2 but
 * kills ranks soon after TERM and INT; under a scheduler's own launcher ranks get all of them.)
 */
#ifndef TREMIE_RUN_CONTROL_H
#define TREMIE_RUN_CONTROL_H

/* Catches the signals from now on.  Local. */
void control_install(void);
/* The signal that asked this process to stop, 0 when none has.  Local. */
int control_asked(void);

#endif
