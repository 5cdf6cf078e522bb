/*
 * The folder a run owns: RUN/job.yaml, checkpoints/, series/, snapshots/, log, status, history,
 * lock, stop (while somebody wants that) and what was moved out of the way, set_aside_N/.
 * Nothing is written anywhere else, and a folder with other things in it is not touched.  All
 * functions act on one process (rank 0) and return a REPORT_ status with the reason said; the
 * caller broadcasts it.
 */
#ifndef TREMIE_STORE_RUN_FOLDER_H
#define TREMIE_STORE_RUN_FOLDER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "store/run_lock.h"

struct run_folder {
    char *path;
    struct run_lock *lock;    /* NULL when it is not held */
    char tag[RUN_LOCK_TOKEN]; /* of files that are not whole yet; the same on all ranks */
};

enum { RUN_FOLDER_FRESH = 1, RUN_FOLDER_TAKE_OVER = 2 };

/*
 * Makes or opens the folder for a job whose used text is job_text (job_write), taking the lock.
 * - New or empty folder: created with its subfolders, job.yaml written.
 * - Folder of the same job (job_difference finds nothing): job.yaml rewritten, *resumes true.
 * - RUN_FOLDER_FRESH in `how`: what is there is moved into RUN/set_aside_N/ (said), then as
 *   new.
 * - Another job's folder, a folder with other things in it, a read-only place, a live lock
 *   (unless RUN_FOLDER_TAKE_OVER is in `how`): refused (REPORT_BAD_INPUT or REPORT_STORAGE)
 *   with the difference and the remedy, nothing changed.
 */
int run_folder_open(struct run_folder *folder, const char *path, const char *job_text, int how,
                    bool *resumes);
void run_folder_close(struct run_folder *folder);

/* Has another process taken the folder?  Then that was said, the log is closed, and nothing may
 * be written any more.  To be asked before anything gets its final name; NULL is nobody's. */
bool run_folder_is_lost(const struct run_folder *folder);
/* What keeps temporary names of different owners apart. */
const char *run_folder_tag(const struct run_folder *folder);

/* RUN/checkpoints/step_000000050000.h5 and RUN/series/step_000000050000.h5; the caller
 * frees. */
char *run_folder_checkpoint_path(const struct run_folder *folder, int64_t step);
char *run_folder_series_path(const struct run_folder *folder, int64_t step);
/* Steps of the checkpoints there are, newest first; caller frees *steps.  -1, the reason said,
 * where that cannot be known. */
int run_folder_checkpoints(const struct run_folder *folder, int64_t **steps);
/* Keeps the newest `keep` checkpoints; series segments stay. */
void run_folder_prune(const struct run_folder *folder, int keep);
/* On resume from `step`: later checkpoints, segments and snapshots are moved into
 * RUN/set_aside_N/ (said). */
int run_folder_rewind(const struct run_folder *folder, int64_t step);
/* Replaces a file of the folder by these bytes, forced to the disk.  False: not; *why is the
 * machine's reason (the caller frees it) or, when the folder is another's now, which was
 * said, NULL.  An owner that is stopped here and awakes when it is robbed replaces nothing:
 * the new one has cleared away what was to get the name. */
bool run_folder_replace(const struct run_folder *folder, const char *path, const void *bytes,
                        size_t n, char **why);
/* Replaces RUN/status with this text (temporary name, rename). */
void run_folder_status(const struct run_folder *folder, const char *text);

/* Writes a whole small file: temporary name, fsync, rename, folder fsync. */
int run_folder_write_file(const char *path, const char *text);

#endif
