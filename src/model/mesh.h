/*
 * The surface of one body as features: faces (flat convex polygons of 3 or 4 vertices), edges
 * and vertices. One contact belongs to one feature; the topology says which feature's contact
 * another one already holds. Reference coordinates are those at time 0; `place` below are the
 * present ones.
 *
 * Feature numbers of a body: faces first (0 .. n_faces-1), then edges, then vertices. They are
 * part of the canonical order and of checkpoints, so they depend on the job alone.
 */
#ifndef TREMIE_MODEL_MESH_H
#define TREMIE_MODEL_MESH_H

#include "base/vec3.h"

struct mesh_face {
    int n;           /* vertices: 3 or 4 */
    int vertices[4]; /* counter-clockwise seen from the normal's side */
    int edges[4];    /* edge k joins vertices k and k+1 */
};

/* Side k of a face: from vertex k along the edge, its own cache line. */
struct mesh_border {
    struct vec3 from;      /* [m] */
    struct vec3 inward;    /* in the face's plane, as long as the side [m] */
    double length_squared; /* [m2] */
} __attribute__((aligned(64)));

/* An edge with more than two faces, as where walls meet in a T, keeps the first two. */
struct mesh_edge {
    int vertices[2];
    int faces[2]; /* adjoining faces; -1 where there is none (a free edge) */
};

struct mesh {
    int n_vertices, n_edges, n_faces;
    /* Vertices from n_corners on are mean points of warped quads; mean_of[v - n_corners] are
     * the four corners of which vertex v is the mean. */
    int n_corners;
    int (*mean_of)[4];
    struct vec3 *reference; /* vertices at time 0 [m] */
    struct vec3 *place;     /* vertices now [m] */
    struct mesh_edge *edges;
    struct mesh_face *faces;
    /* Derived from `place` by mesh_update(): */
    struct vec3 *face_normal; /* unit normals */
    struct mesh_border (*face_borders)[4];
    /* Edges at a vertex: edge_list[edge_begin[v] .. edge_begin[v+1]-1] */
    int *edge_begin, *edge_list;
};

/*
 * Builds the topology from vertices and facets (vertex indices; a triangle has -1 last).
 * Vertices with exactly equal coordinates are joined. A quad that is not flat (a vertex off the
 * plane by more than 1e-9 of its size) or not convex becomes four triangles about its mean
 * point.
 */
void mesh_build(struct mesh *mesh, int n_vertices, const struct vec3 *vertices, int n_facets,
                const int (*facets)[4]);
void mesh_clear(struct mesh *mesh);
/* Recomputes what is derived from `place`. */
void mesh_update(struct mesh *mesh);
static inline int mesh_n_features(const struct mesh *mesh)
{
    return mesh->n_faces + mesh->n_edges + mesh->n_vertices;
}

#endif
