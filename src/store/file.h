/*
 * Files that are there whole or not at all: written under a temporary name, forced to the disk,
 * renamed.
 *
 * Functions return NULL when all went well, else the machine's reason, which the caller
 * frees.  All are local.
 */
#ifndef TREMIE_STORE_FILE_H
#define TREMIE_STORE_FILE_H

#include <stddef.h>
#include <stdint.h>

/* A file larger than the limit of the shell or queue (ulimit -f) is to be an error like a
 * full disk, not a signal that kills. */
void file_survive_size_limit(void);

/* The name, a hidden one, under which `path` is written before it is whole; the tag, "" where
 * nobody else writes it, keeps writers apart.  The caller frees it. */
char *file_temporary(const char *path, const char *tag);
/* Removes such files from a folder, left by a run that was killed. */
void file_remove_temporaries(const char *folder);

/* Creates `path`, or keeps it, with disk space for n bytes. */
char *file_reserve(const char *path, int64_t n);
/* Makes `path` a copy of an open file, forced to the disk, with disk space for its holes
 * too. */
char *file_fill(const char *path, int source);
/* Forces a file's content to the disk. */
char *file_sync(const char *path);
/* Gives a file that was written and synced its final name, and forces the folder to the
 * disk. */
char *file_publish(const char *temporary, const char *path);

/* Writes these bytes under a temporary name, forced to the disk; after a failure there is
 * none. */
char *file_prepare(const char *temporary, const void *bytes, size_t n);
/* Replaces `path` by these bytes: temporary name, sync, rename. */
char *file_write(const char *path, const void *bytes, size_t n);
/* The same where others may do so at the same time: the tag keeps them apart. */
char *file_write_beside(const char *path, const char *tag, const void *bytes, size_t n);
/* All of a file of at most `limit` bytes as a string, *text; the caller frees it. */
char *file_read(const char *path, size_t limit, char **text);

/* Makes a folder and those above it, as far as they are missing. */
char *file_make_folders(const char *path);

/* FOLDER/step_000000050000.h5; the caller frees it. */
char *file_step_path(const char *folder, int64_t step);
/* The steps of the files of such names in a folder, ascending; the caller frees *steps.  A
 * folder that is not there has none; one that cannot be read has -1 (errno says why). */
int file_steps(const char *folder, int64_t **steps);

#endif
