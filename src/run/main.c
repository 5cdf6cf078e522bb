/*
 * The program: `tremie run JOB` and what goes with it.
 *
 * One rank reads the job and holds the run folder; what it decides is broadcast.  The same
 * command again resumes from the newest good checkpoint.  Exit statuses are those of
 * base/report.h.
 */
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/comm.h"
#include "base/process.h"
#include "base/report.h"
#include "job/job.h"
#include "run/control.h"
#include "run/options.h"
#include "run/outside.h"
#include "run/study.h"

static const char USAGE[] =
    "usage: tremie COMMAND ...\n"
    "  run JOB.yaml [options]    run the job; the same command again resumes it; of a job with a\n"
    "                            sweep, all of its variants one after the other\n"
    "  check JOB.yaml [options]  validate it; print scene, critical steps, cost, warnings\n"
    "  status RUN [--json]       where a run or study stands, from its folder, while it runs\n"
    "  stop RUN                  ask a run, or all of a study, to stop with a checkpoint\n"
    "  reference                 print the reference page of job files\n"
    "  version                   print the version\n"
    "options:\n"
    "  --set KEY=VALUE           override a key of the job, for instance time.end=0.5\n"
    "  --variant N               only this variant of the job's sweep, from 1\n"
    "  --out DIR                 the run's or study's folder (default: runs/ and the job's name)\n"
    "  --fresh                   start over; what is there is set aside\n"
    "  --take-over               take the folder from another process that uses it\n"
    "  --advise                  of check: which model each body needs, and what each would cost\n"
    "  --restart FILE            start from this checkpoint\n"
    "  --wall TIME               stop with a checkpoint before this wall time is over\n"
    "  --isa NAME                pair kernel: auto, generic, v2, v3 or v4\n"
    "exit status: 0 finished; 2 bad input; 3 unstable; 4 disk or file; 75 stopped with a "
    "checkpoint;\n"
    "other: a bug in tremie\n";

static int command(const struct comm *comm, const struct options *options)
{
    switch (options->command) {
    case OPTIONS_RUN:
    case OPTIONS_CHECK:
        return study_run_or_check(comm, options);
    case OPTIONS_STATUS:
        return comm->rank == 0 ? outside_status(options->run, options->json) : REPORT_FINISHED;
    case OPTIONS_STOP:
        return comm->rank == 0 ? outside_stop(options->run) : REPORT_FINISHED;
    case OPTIONS_REFERENCE:
        if (comm->rank == 0) {
            char *page = job_reference_page();
            fputs(page, stdout);
            free(page);
        }
        return REPORT_FINISHED;
    case OPTIONS_VERSION:
        report_say("tremie %s", TREMIE_VERSION);
        return REPORT_FINISHED;
    case OPTIONS_HELP:
    default:
        if (comm->rank == 0)
            fputs(USAGE, stdout);
        return REPORT_FINISHED;
    }
}

/* The bits rest on gradual underflow and rounding to nearest; a library or a launcher could
 * have switched either off. */
static void check_arithmetic(void)
{
    const volatile double small = 0x1p-1020, one = 1.0, half_unit = 0x1p-53;
    CHECK(small * 0x1p-10 > 0.0, "the processor flushes small numbers to zero");
    CHECK(one + half_unit == 1.0 && one - 0.75 * half_unit < 1.0, "rounding is not to nearest");
}

int main(int argc, char **argv)
{
    process_return_memory();
    COMM_CHECK(MPI_Init(&argc, &argv));
    const struct comm comm = comm_world();
    report_init(comm.rank == 0);
    control_install();
    check_arithmetic();
    struct options options;
    int status = REPORT_BAD_INPUT;
    if (options_read(&options, argc, argv))
        status = command(&comm, &options);
    options_clear(&options);
    status = comm_agree(&comm, status);
    report_log_close();
    COMM_CHECK(MPI_Finalize());
    return status;
}
