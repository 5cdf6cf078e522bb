/* See intake.h. */
#include "run/intake.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "job/job.h"
#include "model/solid_mesh.h"
#include "run/check.h"
#include "run/options.h"
#include "store/checkpoint.h"
#include "store/file.h"
#include "store/run_folder.h"
#include "store/surface_file.h"

char *intake_folder(const struct options *options)
{
    if (options->out != NULL)
        return array_string(options->out);
    char *name = job_name(options->job), *folder = array_format("runs/%s", name);
    free(name);
    return folder;
}

/* The job as used of the run that is to go on: its text in the folder, or in the checkpoint
 * that is asked for; *has_state tells whether there is any to go on from.  NULL: none. */
static char *text_as_used(const struct options *options, bool *has_state)
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
        folder.path = intake_folder(options);
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
    char *text = text_as_used(options, &has_state);
    mistakes_init(&mistakes);
    if (text != NULL && job_read_text(&used, options->job, text, &mistakes)) {
        check_recall(job, &used, has_state);
        job_clear(&used);
    }
    mistakes_clear(&mistakes);
    free(text);
}

bool intake_read(struct job *job, const struct options *options, int n_ranks,
                 struct mistakes *mistakes)
{
    if (!job_read_variant(job, options->job, options->n_overrides, options->overrides,
                          options->variant, mistakes))
        return false;
    recall(job, options);
    return check_complete(job, n_ranks, mistakes);
}

int intake_share(const struct comm *comm, const struct options *options, struct job *job,
                 char **text)
{
    struct mistakes mistakes;
    mistakes_init(&mistakes);
    int64_t size = 0;
    if (comm->rank == 0) {
        const bool fine = intake_read(job, options, comm->n_ranks, &mistakes);
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
    for (int b = 0; size > 0 && b < job->n_bodies; b++)
        if (job_deforms(&job->bodies[b]))
            (void)solid_mesh_keep(&job->bodies[b]);
    mistakes_clear(&mistakes);
    return size > 0 ? REPORT_FINISHED : REPORT_BAD_INPUT;
}

void intake_clear(struct job *job)
{
    solid_mesh_release(job);
    job_clear(job);
}
