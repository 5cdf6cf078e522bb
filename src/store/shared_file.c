/*
 * See shared_file.h.
 *
 * Writing has three parts.  One rank lays the whole file out and gives it its space on the
 * disk, so that a full disk, a quota or a file-size limit shows itself where it is an error of
 * one process, not in the midst of a collective call, where MPI's files may hang.  Then all
 * ranks fill in their slices through parallel HDF5; each rank writes its own contiguous run of
 * each data set, so there is nothing for collective buffering to gather, and a rank whose disk
 * fails keeps nobody waiting.  Closing writes metadata, as they are already, and if one rank
 * cannot do that the others wait for ever: so the file has been let go of before.  Last the
 * file is forced to the disk and renamed. Because one rank alone decides the layout, bytes
 * cannot depend on the number of ranks.
 *
 * Packed tables are the exception: how long they are is known only when they are packed.  Each
 * rank packs its own rows and the one that lays out the file gets the result, so it needs as
 * much memory.
 */
#include "store/shared_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "store/file.h"
#include "store/h5.h"
#include "store/run_folder.h"
#include "store/table.h"

bool shared_file_all_well(const struct comm *comm, char **why)
{
    enum { TEXT = 512 };
    if (comm_agree(comm, *why != NULL) == 0)
        return true;
    char own[TEXT] = "";
    if (*why != NULL)
        snprintf(own, sizeof own, "%s", *why);
    char(*all)[TEXT] = array_allocate((size_t)comm->n_ranks, sizeof *all);
    comm_gather_all(comm, own, all, sizeof own);
    int q = 0;
    while (q < comm->n_ranks - 1 && all[q][0] == '\0')
        q++;
    free(*why);
    *why = array_string(all[q]);
    free(all);
    return false;
}

/* On rank 0.  Who has lost the folder misses files that the new owner cleared away. */
static void say_why(const struct shared_file *file, const char *why)
{
    if (!run_folder_is_lost(file->folder))
        report_error("cannot write the %s %s: %s; %s", file->what, file->path, why,
                     file->remedy);
}

/* A new file in memory, for which there is room.  Local. */
static void begin(struct h5 *h5, const char *path, const struct shared_file *file)
{
    enum { METADATA = 1 << 17 };
    int64_t size = METADATA + file->size;
    for (int t = 0; t < file->n_tables; t++)
        size += file->tables[t].packed ? 0 : table_file_size(&file->tables[t]);
    unlink(path);
    /* HDF5 gives this space back when it creates the file; but it has been there. */
    char *why = file_reserve(path, size);
    if (why != NULL) {
        *h5 = (struct h5){.file = -1, .memory = -1, .why = why};
        return;
    }
    h5_create(h5, path);
    file->lay_out(h5, file->content);
}

/* The whole file except rows, with space for these; packed rows too.  Returns NULL or the
 * reason.  Collective. */
static char *lay_out(const struct comm *comm, const char *path, const struct shared_file *file)
{
    struct h5 h5 = {.file = -1, .memory = -1};
    if (comm->rank == 0)
        begin(&h5, path, file);
    for (int t = 0; t < file->n_tables; t++)
        if (file->tables[t].packed)
            table_pack(&file->tables[t], comm, &h5);
    if (comm->rank == 0 && h5.file >= 0)
        h5_save(&h5, path);
    return h5.why;
}

/* Ends the program.  Parallel HDF5 can neither close nor forget a file when a part of it
 * failed on some rank; that disk has failed after it had promised the space. */
static _Noreturn void abandon(const struct comm *comm, const struct shared_file *file,
                              const char *temporary, const char *why)
{
    if (comm->rank == 0) {
        unlink(temporary);
        say_why(file, why);
    } else {
        sleep(1); /* rank 0 speaks first, if it can */
    }
    fflush(NULL);
    MPI_Abort(comm->mpi, REPORT_STORAGE);
    _exit(REPORT_STORAGE);
}

/* Every rank's rows, forced to the disk.  Returns NULL or this rank's reason.  Collective. */
static char *fill_in(const struct comm *comm, const struct shared_file *file,
                     const char *temporary)
{
    struct h5 h5;
    h5_open_shared(&h5, temporary, comm);
    if (comm_agree(comm, h5.file >= 0) == 0)
        return h5.why;
    for (int t = 0; t < file->n_tables; t++)
        if (file->tables[t].collect != NULL)
            table_stream(&file->tables[t], comm, &h5);
        else
            table_write(&file->tables[t], &h5);
    h5_let_go(&h5, temporary);
    if (!shared_file_all_well(comm, &h5.why))
        abandon(comm, file, temporary, h5.why);
    h5_close(&h5);
    if (h5.why != NULL)
        abandon(comm, file, temporary, h5.why);
    return file_sync(temporary);
}

/* Has the folder another owner now?  Collective. */
static bool is_lost(const struct comm *comm, const struct shared_file *file)
{
    return comm_agree(comm, comm->rank == 0 && run_folder_is_lost(file->folder)) != 0;
}

/* *lost: the folder has another owner, and nothing of this name was written. */
static char *write_file(const struct comm *comm, const struct shared_file *file, bool *lost)
{
    char *temporary = file_temporary(file->path, run_folder_tag(file->folder));
    char *why = lay_out(comm, temporary, file);
    bool well = shared_file_all_well(comm, &why);
    if (well) {
        why = fill_in(comm, file, temporary);
        well = shared_file_all_well(comm, &why);
    }
    *lost = well && is_lost(comm, file);
    well = well && !*lost;
    if (well) {
        why = comm->rank == 0 ? file_publish(temporary, file->path) : NULL;
        well = shared_file_all_well(comm, &why);
    }
    if (!well && comm->rank == 0)
        unlink(temporary);
    free(temporary);
    return why;
}

int shared_file_write(const struct comm *comm, const struct shared_file *file)
{
    file_survive_size_limit();
    bool lost = is_lost(comm, file);
    char *why = lost ? NULL : write_file(comm, file, &lost);
    if (why != NULL && comm->rank == 0)
        say_why(file, why);
    const int status = why != NULL || lost ? REPORT_STORAGE : REPORT_FINISHED;
    free(why);
    return status;
}
