/*
 * The shapes a job can ask for, as vertices and facets.
 */
#ifndef TREMIE_MODEL_GEOMETRY_H
#define TREMIE_MODEL_GEOMETRY_H

#include "base/vec3.h"

struct job_body;

struct geometry {
    int n_vertices;
    struct vec3 *vertices; /* [m] */
    int n_facets;
    int (*facets)[4]; /* vertex indices; a triangle has -1 last */
};

/* Local. */
void geometry_build(struct geometry *geometry, const struct job_body *body);
void geometry_clear(struct geometry *geometry);

#endif
