/*
 * Tabulated paths of bodies from CSV files: read once, with the job, into the list of points
 * that the job could also have held itself; so a run needs the file no more.
 */
#ifndef TREMIE_JOB_PATH_FILE_H
#define TREMIE_JOB_PATH_FILE_H

struct job;
struct mistakes;

/* Replaces every motion's path.file by its points; what is wrong in a file is listed with its
 * place there.  Local. */
void path_file_read_all(struct job *job, struct mistakes *mistakes);

#endif
