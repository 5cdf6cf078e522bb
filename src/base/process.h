/* Processes of this machine, as /proc shows them.  Local. */
#ifndef TREMIE_BASE_PROCESS_H
#define TREMIE_BASE_PROCESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Does a process of this number live?  Then *started, in clock ticks since the machine started,
 * tells it from another one that had or gets the same number.  One that was killed and waits
 * to be buried does not live, one that is stopped does. */
bool process_lives(int64_t id, int64_t *started);

/* Seconds since a process started; negative where that cannot be known. */
double process_age(int64_t id);

/* Memory that processes of this machine can have, or this one is allowed to [bytes]. */
double process_memory(void);

/* From now on large pieces of memory go back to the machine as soon as they are freed.  Else
 * the C library, once some were freed, takes later ones from a heap in which holes stay. */
void process_return_memory(void);

/* What a scheduler calls the job that this process belongs to, like "slurm 4711"; "" without
 * one. */
void process_job(char *text, size_t size);

#endif
