/*
 * Triangles and quads of a Gmsh .msh file, format 2.2 or 4.1, in ASCII or little-endian binary.
 */
#ifndef TREMIE_MODEL_GMSH_H
#define TREMIE_MODEL_GMSH_H

#include <stdbool.h>
#include <stddef.h>

#include "model/surface.h"

/* Reads the n bytes of a file, which a zero follows: the surface elements of the physical group
 * of this name (or number), or all of them (NULL).  Points, lines and solids are left aside;
 * elements of second order are refused.  Returns false with the reason in *why (caller frees):
 * "path:line:column: what; what is expected", in bytes "path: byte 7: what; ...".  Local. */
bool gmsh_read(struct surface *surface, const char *path, const char *bytes, size_t n,
               const char *group, char **why);

#endif
