/*
 * Bodies whose surface is in a file: read on one rank, sent to the others.
 */
#ifndef TREMIE_STORE_SURFACE_FILE_H
#define TREMIE_STORE_SURFACE_FILE_H

#include <stdbool.h>

struct comm;
struct job;
struct job_body;

/* Does the body's surface come from a file? */
bool surface_file_has(const struct job_body *body);
/* Reads the file of a body: its vertices, facets and checksum are set.  Returns NULL, or what
 * is wrong (caller frees): "path:line:column: what; what is expected" or "path: what; ...".
 * Local. */
char *surface_file_read(struct job_body *body);
/* Gives the surfaces that rank 0 has read to all.  Collective. */
void surface_file_share(struct job *job, const struct comm *comm);

#endif
