/*
 * The program: `tremie run JOB` and what goes with it.
 *
 * One rank reads the job and holds the run folder; what it decides is broadcast.  The same
 * command again resumes from the newest good checkpoint.  Exit statuses are those of
 * base/report.h.
 */
#include <limits.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "base/timer.h"
#include "job/job.h"
#include "run/check.h"
#include "run/control.h"
#include "run/drive.h"
#include "run/options.h"
#include "run/outside.h"
#include "store/checkpoint.h"
#include "store/file.h"
#include "store/run_folder.h"
#include "store/surface_file.h"

static const char USAGE[] =
    "usage: tremie COMMAND ...\n"
    "  run JOB.yaml [options]    run the job; the same command again resumes it\n"
    "  check JOB.yaml [options]  validate it; print scene, critical steps, cost, warnings\n"
    "  status RUN [--json]       where a run stands, from its folder, while it runs\n"
    "  stop RUN                  ask a run to stop with a checkpoint\n"
    "  reference                 print the reference page of job files\n"
    "  version                   print the version\n"
    "options:\n"
    "  --set KEY=VALUE           override a key of the job, for instance time.end=0.5\n"
    "  --out DIR                 the run folder (default: runs/ and the job's name)\n"
    "  --fresh                   start over; what is there is set aside\n"
    "  --take-over               take the folder from another process that uses it\n"
    "  --restart FILE            start from this checkpoint\n"
    "  --wall TIME               stop with a checkpoint before this wall time is over\n"
    "  --isa NAME                pair kernel: auto, generic, v2, v3 or v4\n"
    "exit status: 0 finished; 2 bad input; 3 unstable; 4 disk or file; 75 stopped with a "
    "checkpoint;\n"
    "other: a bug in tremie\n";

/* The job as used of the run that is to go on: its text in the folder, or in the checkpoint
 * that is asked for; *has_state tells whether there is any to go on from.  NULL: none. */
static char *text_as_used(const struct job *job, const struct options *options, bool *has_state)
{
    struct run_folder folder = {.path = NULL};
    struct checkpoint header;
    int64_t *steps = NULL;
    char *text = NULL, *why = NULL;
    *has_state = options->restart != NULL;
    if (options->restart != NULL) {
        if (checkpoint_read_header(options->restart, &header, &why)) {
            text = array_string(header.job_text);
            checkpoint_clear(&header);
        }
    } else if (!options->fresh) {
        folder.path = options->out != NULL ? array_string(options->out)
                                           : array_format("runs/%s", job->name);
        char *path = array_format("%s/job.yaml", folder.path);
        *has_state = run_folder_checkpoints(&folder, &steps) != 0;
        why = file_read(path, INT_MAX, &text);
        free(path);
    }
    free(why); /* what cannot be read is met again, and said then */
    free(steps);
    free(folder.path);
    return text;
}

/* A run that goes on knows what it started from (run/check, check_recall). */
static void recall(struct job *job, const struct options *options)
{
    struct mistakes mistakes;
    struct job used;
    bool has_state;
    if (!job->start.given || options->command != OPTIONS_RUN)
        return;
    char *text = text_as_used(job, options, &has_state);
    mistakes_init(&mistakes);
    if (text != NULL && job_read_text(&used, options->job, text, &mistakes)) {
        check_recall(job, &used, has_state);
        job_clear(&used);
    }
    mistakes_clear(&mistakes);
    free(text);
}

/* Reads the job on rank 0; everybody gets its complete text.  Returns a REPORT_ status.
 * Collective. */
static int read_job(const struct comm *comm, const struct options *options, struct job *job,
                    char **text)
{
    struct mistakes mistakes;
    mistakes_init(&mistakes);
    int64_t size = 0;
    bool fine = true;
    if (comm->rank == 0) {
        fine = job_read(job, options->job, options->n_overrides, options->overrides, &mistakes);
        if (fine) {
            recall(job, options);
            fine = check_complete(job, comm->n_ranks, &mistakes);
        }
        mistakes_print(&mistakes);
        *text = fine ? job_write(job) : NULL;
        size = fine ? (int64_t)strlen(*text) + 1 : 0;
    }
    comm_broadcast(comm, &size, sizeof size);
    if (size > 0 && comm->rank != 0) {
        *text = array_allocate((size_t)size, 1);
        comm_broadcast(comm, *text, (size_t)size);
        CHECK(job_read_text(job, options->job, *text, &mistakes),
              "the job as used cannot be read back: %s",
              mistakes.n > 0 ? mistakes.list[0].text : "");
    } else if (size > 0) {
        comm_broadcast(comm, *text, (size_t)size);
    }
    if (size > 0)
        surface_file_share(job, comm);
    mistakes_clear(&mistakes);
    return size > 0 ? REPORT_FINISHED : REPORT_BAD_INPUT;
}

static int run_or_check(const struct comm *comm, const struct options *options)
{
    struct job job = {0};
    char *text = NULL;
    int status = read_job(comm, options, &job, &text);
    if (status == REPORT_FINISHED && options->command == OPTIONS_CHECK)
        check_print(&job, comm);
    else if (status == REPORT_FINISHED)
        status = drive_run(comm, options, &job, text);
    job_clear(&job);
    free(text);
    return status;
}

static int command(const struct comm *comm, const struct options *options)
{
    switch (options->command) {
    case OPTIONS_RUN:
    case OPTIONS_CHECK:
        return run_or_check(comm, options);
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
