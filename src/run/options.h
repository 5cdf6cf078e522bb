/* The command line. */
#ifndef TREMIE_RUN_OPTIONS_H
#define TREMIE_RUN_OPTIONS_H

#include <stdbool.h>

#include "contact/pair_kernel.h"
#include "job/job.h"

#define TREMIE_VERSION "0.1.0"

enum options_command {
    OPTIONS_HELP,
    OPTIONS_RUN,
    OPTIONS_CHECK,
    OPTIONS_STATUS,
    OPTIONS_STOP,
    OPTIONS_REFERENCE,
    OPTIONS_VERSION,
};

struct options {
    enum options_command command;
    const char *job;     /* run, check */
    const char *run;     /* status, stop */
    const char *out;     /* NULL: runs/NAME */
    int variant;         /* of the job's sweep, from 1; 0: all, or there is none */
    const char *restart; /* NULL: the newest good checkpoint */
    double wall;         /* this process's wall time [s]; 0: not limited here */
    bool fresh, take_over, json, advise;
    enum isa isa;
    int n_overrides;
    struct job_override *overrides;
};

/* Returns false, having said why, when the words make no sense.  Local, the same on all
 * ranks. */
bool options_read(struct options *options, int argc, char **argv);
void options_clear(struct options *options);

#endif
