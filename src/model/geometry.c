/*
 * Plane, box, hopper and mesh as facets: see geometry.h.
 *
 * Facets of a box and a hopper face outwards.  Corners that facets share have the same
 * coordinates to the last bit, so the mesh joins them.
 */
#include "model/geometry.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"

static void reserve(struct geometry *geometry, int n_vertices, int n_facets)
{
    geometry->vertices = array_allocate((size_t)n_vertices, sizeof *geometry->vertices);
    geometry->facets = array_allocate((size_t)n_facets, sizeof *geometry->facets);
}

static void add_quad(struct geometry *geometry, int a, int b, int c, int d)
{
    int *facet = geometry->facets[geometry->n_facets++];
    facet[0] = a;
    facet[1] = b;
    facet[2] = c;
    facet[3] = d;
}

static double magnitude(double x)
{
    return x < 0.0 ? -x : x;
}

/* A square about the point, its sides along the axes as far as the normal lets them. */
static void build_plane(struct geometry *geometry, const struct job_body *body)
{
    const struct vec3 n = vec3_scale(1.0 / vec3_norm(body->normal), body->normal);
    const struct vec3 along =
        magnitude(n.x) <= magnitude(n.y) || magnitude(n.x) <= magnitude(n.z)
            ? (struct vec3){1.0, 0.0, 0.0}
            : (struct vec3){0.0, 1.0, 0.0};
    const struct vec3 across = vec3_cross(n, along);
    const struct vec3 v = vec3_scale(0.5 * body->extent / vec3_norm(across), across);
    const struct vec3 u = vec3_cross(v, n);
    reserve(geometry, 4, 1);
    geometry->n_vertices = 4;
    geometry->vertices[0] = vec3_sub(vec3_sub(body->point, u), v);
    geometry->vertices[1] = vec3_sub(vec3_add(body->point, u), v);
    geometry->vertices[2] = vec3_add(vec3_add(body->point, u), v);
    geometry->vertices[3] = vec3_add(vec3_sub(body->point, u), v);
    add_quad(geometry, 0, 1, 2, 3);
}

/* Corner k of a box: bit 0 chooses x, bit 1 y, bit 2 z. */
static void build_box(struct geometry *geometry, const struct job_body *body)
{
    static const struct {
        enum job_side side;
        int corners[4];
    } walls[6] = {
        {JOB_SIDE_X_MIN, {0, 4, 6, 2}},  {JOB_SIDE_X_MAX, {1, 3, 7, 5}},
        {JOB_SIDE_Y_MIN, {0, 1, 5, 4}},  {JOB_SIDE_Y_MAX, {2, 6, 7, 3}},
        {JOB_SIDE_BOTTOM, {0, 2, 3, 1}}, {JOB_SIDE_TOP, {4, 5, 7, 6}},
    };
    reserve(geometry, 8, 6);
    geometry->n_vertices = 8;
    for (int k = 0; k < 8; k++)
        geometry->vertices[k] = (struct vec3){(k & 1) ? body->max.x : body->min.x,
                                              (k & 2) ? body->max.y : body->min.y,
                                              (k & 4) ? body->max.z : body->min.z};
    for (int w = 0; w < 6; w++) {
        const int *c = walls[w].corners;
        if (!(body->open & (int)walls[w].side))
            add_quad(geometry, c[0], c[1], c[2], c[3]);
    }
}

/* Four sloping quads from the outlet (vertices 0..3) to the top (4..7). */
static void build_hopper(struct geometry *geometry, const struct job_body *body)
{
    reserve(geometry, 8, 4);
    geometry->n_vertices = 8;
    for (int k = 0; k < 8; k++) {
        const double *width = k < 4 ? body->outlet : body->top;
        const double x = 0.5 * width[0], y = 0.5 * width[1];
        geometry->vertices[k] = (struct vec3){
            body->centre[0] + (k % 4 == 1 || k % 4 == 2 ? x : -x),
            body->centre[1] + (k % 4 >= 2 ? y : -y),
            k < 4 ? body->z[0] : body->z[1],
        };
    }
    for (int k = 0; k < 4; k++)
        add_quad(geometry, k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k);
}

static void build_mesh(struct geometry *geometry, const struct job_body *body)
{
    reserve(geometry, body->n_vertices, body->n_facets);
    geometry->n_vertices = body->n_vertices;
    geometry->n_facets = body->n_facets;
    for (int v = 0; v < body->n_vertices; v++)
        geometry->vertices[v] = body->vertices[v];
    for (int f = 0; f < body->n_facets; f++)
        memcpy(geometry->facets[f], body->facets[f], sizeof geometry->facets[f]);
}

void geometry_build(struct geometry *geometry, const struct job_body *body)
{
    *geometry = (struct geometry){0, NULL, 0, NULL};
    switch (body->geometry) {
    case JOB_GEOMETRY_PLANE:
        build_plane(geometry, body);
        return;
    case JOB_GEOMETRY_BOX:
        build_box(geometry, body);
        return;
    case JOB_GEOMETRY_HOPPER:
        build_hopper(geometry, body);
        return;
    case JOB_GEOMETRY_MESH:
        build_mesh(geometry, body);
        return;
    }
    CHECK(false, "unknown geometry %d", (int)body->geometry);
}

void geometry_clear(struct geometry *geometry)
{
    free(geometry->vertices);
    free(geometry->facets);
    *geometry = (struct geometry){0, NULL, 0, NULL};
}
