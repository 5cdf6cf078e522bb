/*
 * The folder of a study: STUDY/study.yaml lists its variants, and each has its run in a folder
 * of its own beside that file.
 *
 * The file is written anew by every process that runs a variant, with the same bytes as long as
 * the job's sweep is the same; nobody owns it.  Values may be added to a sweep later.  All
 * functions are local.
 */
#ifndef TREMIE_STORE_STUDY_FILE_H
#define TREMIE_STORE_STUDY_FILE_H

#include <stdbool.h>

#include "job/sweep.h"

/* Makes the folder and its list.  A folder that holds a run, or, unless `fresh`, a study of
 * another job or of other keys, is refused.  Returns a REPORT_ status, the reason said. */
int study_file_write(const char *folder, const char *job, const struct sweep *sweep,
                     bool fresh);

/* Is this the folder of a study? */
bool study_file_is_there(const char *folder);
/* Reads the list into a sweep without places.  Returns a REPORT_ status, the reason said; then
 * there is nothing to clear. */
int study_file_read(const char *folder, struct sweep *sweep);

#endif
