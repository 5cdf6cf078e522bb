/*
 * Triangles and quads, or hexahedra and tetrahedra, of a Gmsh .msh file, format 2.2 or 4.1, in
 * ASCII or little-endian binary.
 */
#ifndef TREMIE_MODEL_GMSH_H
#define TREMIE_MODEL_GMSH_H

#include <stdbool.h>
#include <stddef.h>

#include "model/surface.h"

struct job_volume;

/* Elements of more than these are refused. */
enum { GMSH_ELEMENTS_MOST = 20000000 };

/* Reads the n bytes of a file, which a zero follows: the surface elements of the physical group
 * of this name (or number), or all of them (NULL).  Points, lines and solids are left aside;
 * elements of second order are refused.  Returns false with the reason in *why (caller frees):
 * "path:line:column: what; what is expected", in bytes "path: byte 7: what; ...".  Local. */
bool gmsh_read(struct surface *surface, const char *path, const char *bytes, size_t n,
               const char *group, char **why);

/* The same for a solid: hexahedra with 8 and tetrahedra with 4 nodes, and all physical groups.
 * Nodes come in the order of their numbers, elements in that of the file.  Local. */
bool gmsh_read_solid(struct job_volume *volume, const char *path, const char *bytes, size_t n,
                     char **why);

#endif
