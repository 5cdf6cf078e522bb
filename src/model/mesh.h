/*
 * The surface of one body as features. Either it is cut into faces (flat convex polygons of 3
 * or 4 vertices) with their edges and vertices, or it is a surface of revolution met exactly:
 * bands (between two circles about the axis: of a cylinder, a cone, a disc) and rings (the
 * circles where bands begin and end). One contact belongs to one feature; the topology says
 * which feature's contact another one already holds. Reference coordinates are those at time 0;
 * `place` below are the present ones.
 *
 * Feature numbers of a body: faces first (0 .. n_faces-1), then edges, vertices, bands, rings.
 * They are part of the canonical order and of checkpoints, so they depend on the job alone.
 *
 * A round surface has vertices too: two on its axis, which carry its place, and those of its
 * skin, facets that stand for it in pictures and sums over vertices. Nothing touches these.
 */
#ifndef TREMIE_MODEL_MESH_H
#define TREMIE_MODEL_MESH_H

#include <stdbool.h>

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
    int n_faces;  /* all of them */
};

/* A circle about the axis; one without a radius is a point of it. */
struct mesh_ring {
    double radius, height; /* from the axis, along it [m] */
    int bands[2];          /* adjoining bands; -1 where there is none (a rim) */
};

/* What a straight line from ring to ring makes about the axis. */
struct mesh_band {
    int rings[2];
    double along[2]; /* from the first to the second, a unit vector: outwards, along the axis */
    double length;   /* [m] */
};

/* A surface of revolution: its rings in the half-plane and the bands between them. */
struct mesh_profile {
    int n_points, n_bands;
    const double (*points)[2]; /* distance from the axis, height along it [m] */
    const int (*bands)[2];
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
    /* What the facets given held besides, and is left out. */
    int n_degenerate, n_duplicates; /* facets without area, facets that were there already */
    int first_degenerate, first_duplicate; /* the first such facet, -1: none */
    /* A round surface. Its axis goes from vertex `axis[0]` to vertex `axis[1]`. */
    int n_bands, n_rings, n_skin, axis[2];
    struct mesh_band *bands;
    struct mesh_ring *rings;
    int (*skin)[4]; /* facets that stand for it: vertices; a triangle has -1 last */
    struct vec3 origin, direction, aside; /* derived: on the axis; along it; across it */
};

/* What a surface is like as a whole, in its reference place. */
struct mesh_survey {
    double area, volume;   /* [m2], [m3]; the volume only where it is closed */
    struct vec3 low, high; /* corners of the box around it [m] */
    int n_open, n_shared;  /* edges of one face, and of more than two */
    int n_turned;          /* edges whose two faces look to opposite sides */
    int first_open, first_shared, first_turned; /* the first such edge, -1: none */
    bool closed;                                /* holds a volume: every edge has two faces */
};

/*
 * Builds the topology from vertices and facets (vertex indices; a triangle has -1 last).
 * Vertices with exactly equal coordinates are joined. A quad that is not flat (a vertex off the
 * plane by more than 1e-9 of its size) or not convex becomes four triangles about its mean
 * point. Facets without area and facets with the vertices of an earlier one are left out.
 */
void mesh_build(struct mesh *mesh, int n_vertices, const struct vec3 *vertices, int n_facets,
                const int (*facets)[4]);
/*
 * The same of a surface that will deform, all of whose vertices are used: its vertices keep
 * their numbers, and every quad becomes four triangles.
 */
void mesh_build_skin(struct mesh *mesh, int n_vertices, const struct vec3 *vertices,
                     int n_facets, const int (*facets)[4]);
/*
 * Builds a surface of revolution about the axis from `origin` along `direction` (length 1). The
 * skin's vertices and facets are taken as they are.
 */
void mesh_build_round(struct mesh *mesh, const struct mesh_profile *profile, struct vec3 origin,
                      struct vec3 direction, int n_vertices, const struct vec3 *vertices,
                      int n_skin, const int (*skin)[4]);
/* For every vertex the first one at exactly the same place.  The caller frees them. */
int *mesh_joined_vertices(int n, const struct vec3 *vertices);
void mesh_clear(struct mesh *mesh);
struct mesh_survey mesh_survey(const struct mesh *mesh);
/* Recomputes what is derived from `place`. */
void mesh_update(struct mesh *mesh);
/* The same of one face. */
void mesh_update_face(const struct mesh *mesh, int f);
static inline int mesh_n_features(const struct mesh *mesh)
{
    return mesh->n_faces + mesh->n_edges + mesh->n_vertices + mesh->n_bands + mesh->n_rings;
}

/* Facets that show the surface: its faces or its skin. */
static inline int mesh_n_shown(const struct mesh *mesh)
{
    return mesh->n_faces + mesh->n_skin;
}
/* The vertices of one of them; a triangle has 3. */
static inline int mesh_shown(const struct mesh *mesh, int k, const int **vertices)
{
    if (k < mesh->n_faces) {
        *vertices = mesh->faces[k].vertices;
        return mesh->faces[k].n;
    }
    *vertices = mesh->skin[k - mesh->n_faces];
    return (*vertices)[3] < 0 ? 3 : 4;
}

#endif
