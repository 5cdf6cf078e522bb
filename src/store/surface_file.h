/*
 * Bodies whose surface, or mesh of a solid, is in a file: read on one rank, sent to the others.
 */
#ifndef TREMIE_STORE_SURFACE_FILE_H
#define TREMIE_STORE_SURFACE_FILE_H

#include <stdbool.h>

struct comm;
struct job;
struct job_body;

/* Does the body's surface or mesh come from a file? */
bool surface_file_has(const struct job_body *body);
/* Reads the file of a body: its checksum is set, and its vertices and facets, or
 * solid.volume.  Returns NULL, or what is wrong (caller frees): "path:line:column: what; what
 * is expected" or "path: what; ...".  Local. */
char *surface_file_read(struct job_body *body);
/* Gives the surfaces and meshes that rank 0 has read to all.  Collective. */
void surface_file_share(struct job *job, const struct comm *comm);

#endif
