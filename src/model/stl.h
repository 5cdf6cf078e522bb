/*
 * Triangles of an STL file, ASCII or binary: see stl.c for how the two are told apart.
 */
#ifndef TREMIE_MODEL_STL_H
#define TREMIE_MODEL_STL_H

#include <stdbool.h>
#include <stddef.h>

#include "model/surface.h"

/* Reads the n bytes of a file, which a zero follows.  Every triangle has vertices of its own;
 * normals and attributes are left aside.  Returns false with the reason in *why (caller frees):
 * "path:line:column: what; what is expected" or "path: what; ...".  Local. */
bool stl_read(struct surface *surface, const char *path, const char *bytes, size_t n,
              char **why);

#endif
