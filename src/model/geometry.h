/*
 * The shapes a job can ask for, as vertices and facets, or as the curved surface itself; what a
 * file holds has been read before (store/surface_file.h). Any of them is then scaled about the
 * origin, rotated and moved, in this order.
 */
#ifndef TREMIE_MODEL_GEOMETRY_H
#define TREMIE_MODEL_GEOMETRY_H

#include "base/vec3.h"

struct job_body;
struct mesh;

enum { GEOMETRY_PROFILE = 4 }; /* points and bands at most */

struct geometry {
    int n_vertices;
    struct vec3 *vertices; /* [m] */
    int n_facets;
    int (*facets)[4]; /* vertex indices; a triangle has -1 last */
    /* A round shape; the facets stand for it. None where n_bands is 0. */
    int n_points, n_bands;
    double points[GEOMETRY_PROFILE][2]; /* distance from the axis, height along it [m] */
    int bands[GEOMETRY_PROFILE][2];
    struct vec3 origin, direction; /* of the axis */
};

/* Local. */
/* Scales, rotates and moves points as the body asks. */
void geometry_place(const struct job_body *body, int n, struct vec3 *points);
/* The shape itself, not placed yet; of what has no facets round the axis those that stand for
 * it. */
void geometry_build_shape(struct geometry *geometry, const struct job_body *body);
/* Of a body that deforms: what contacts see of it (model/skin.h). */
void geometry_build(struct geometry *geometry, const struct job_body *body);
void geometry_clear(struct geometry *geometry);
/* The body's surface, with its features. Local. */
void geometry_build_mesh(struct mesh *mesh, const struct job_body *body);

#endif
