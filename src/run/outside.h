/* What can be told of a run, and asked of it, from outside: through the files of its folder. */
#ifndef TREMIE_RUN_OUTSIDE_H
#define TREMIE_RUN_OUTSIDE_H

#include <stdbool.h>

/* Prints where a run stands and what became of its processes, for people or as JSON.  Returns a
 * REPORT_ status.  Local. */
int outside_status(const char *run, bool json);
/* Asks a run to stop, through the file RUN/stop. */
int outside_stop(const char *run);

#endif
