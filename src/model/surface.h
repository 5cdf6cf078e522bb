/*
 * What a file of facets holds, while it is read.
 */
#ifndef TREMIE_MODEL_SURFACE_H
#define TREMIE_MODEL_SURFACE_H

#include "base/vec3.h"

struct surface {
    int n_vertices, vertex_capacity;
    struct vec3 *vertices; /* [unit of the file] */
    int n_facets, facet_capacity;
    int (*facets)[4]; /* vertex indices; a triangle has -1 last */
};

/* Facets of more than these are refused. */
enum { SURFACE_FACETS_MOST = 20000000 };

/* Returns the new vertex. */
int surface_add_vertex(struct surface *surface, struct vec3 place);
void surface_add_facet(struct surface *surface, int a, int b, int c, int d);
void surface_clear(struct surface *surface);

#endif
