/*
 * A file that all ranks write: laid out by one of them, filled in by all, there whole or not at
 * all.
 *
 * Space is reserved and agreed on, the file is written under a temporary name, forced to the
 * disk, renamed, its folder forced to the disk.
 */
#ifndef TREMIE_STORE_SHARED_FILE_H
#define TREMIE_STORE_SHARED_FILE_H

#include <stdbool.h>
#include <stdint.h>

struct comm;
struct h5;
struct run_folder;
struct table;

struct shared_file {
    const struct run_folder *folder; /* the run's, NULL: nobody's */
    const char *path;
    const char *what;   /* "checkpoint": for messages */
    const char *remedy; /* what follows the reason in them */
    /* Puts everything into the new file, of tables only what table_declare() does. */
    void (*lay_out)(struct h5 *h5, const void *content);
    const void *content; /* given to it */
    int64_t size;        /* of it, without tables, at most [bytes] */
    int n_tables;
    struct table *tables; /* arranged, or streamed */
};

/* Returns REPORT_FINISHED, or REPORT_STORAGE with the reason said, the same on all ranks; then
 * no file of that name was touched.  A folder that was taken over is not written to.  lay_out
 * is called on rank 0.  Collective. */
int shared_file_write(const struct comm *comm, const struct shared_file *file);

/* Did all go well on all ranks?  If not, rank 0 gets the first rank's reason, *why.
 * Collective. */
bool shared_file_all_well(const struct comm *comm, char **why);

#endif
