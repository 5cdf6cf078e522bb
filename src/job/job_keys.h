/* The table of every key of a job file. */
#ifndef TREMIE_JOB_JOB_KEYS_H
#define TREMIE_JOB_JOB_KEYS_H

#include "job/schema.h"

enum { JOB_KEYS_MAX_PAIRS = 5000 };

extern const struct schema_key job_keys[];
/* Those of an entry of `sweep`, of a struct sweep_item (job/sweep). */
extern const struct schema_key job_keys_sweep[];

#endif
