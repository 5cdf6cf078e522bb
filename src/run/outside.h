/* What can be told of a run or a study, and asked of it, from outside: through the files of its
 * folder. */
#ifndef TREMIE_RUN_OUTSIDE_H
#define TREMIE_RUN_OUTSIDE_H

#include <stdbool.h>

/* Prints where a run stands and what became of its processes, or where the variants of a study
 * stand, for people or as JSON.  Returns a REPORT_ status.  Local. */
int outside_status(const char *run, bool json);
/* Asks a run, or every one that runs of a study, to stop, through the file RUN/stop. */
int outside_stop(const char *run);

#endif
