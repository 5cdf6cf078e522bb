/*
 * What contacts see of finite elements: facets of vertices that nodes carry.
 *
 * Of solids these are the sides on the surface, their vertices are nodes.  Shells and membranes
 * are as thick as they are: facets lie half the thickness above and below the elements, along
 * mean normals of the elements around a node, and at rims facets join them.  So a sphere meets
 * one side or the other, and an edge as thick as the sheet, and where it is says which.
 *
 * Sheets whose normals differ by more than SKIN_SMOOTH, or that meet three at an edge, are
 * apart from each other, each with its own rim; so a node may carry several pairs of vertices.
 * In the inside of such an edge that changes nothing; on its outside it leaves a groove of
 * half the thickness.
 *
 * A sheet on the surface of a solid makes it higher by half the thickness: it has no side
 * below, and its rims come down to the solid's nodes.  One between solids is not seen.  Sheets
 * that leave the solid are apart from those on it.
 */
#ifndef TREMIE_MODEL_SKIN_H
#define TREMIE_MODEL_SKIN_H

#include <stdbool.h>
#include <stddef.h>

#include "base/vec3.h"

struct solid_mesh;

/* Cosine of 40 degrees: faces whose normals differ by more meet in an edge. */
#define SKIN_SMOOTH 0.766044443118978

/* Sheets around a node that go on smoothly into each other. */
struct skin_ring {
    int node;
    int begin, end; /* among `around` */
    double half;    /* half of the thickness [m] */
};

/* A sheet's element as its ring sees it: a quad, or a triangle with -1 last. */
struct skin_sheet {
    int corners[4]; /* nodes, counter-clockwise seen from above */
};

struct skin {
    int n_vertices, n_plain;    /* from n_plain on those of rings, one after the other */
    int *nodes;                 /* of each vertex */
    int n_facets, (*facets)[4]; /* vertices; a triangle has -1 last */
    int n_rings, n_both;        /* from n_both on those on solids, with one vertex: above */
    int ring_capacity, n_sheets;
    struct skin_ring *rings;
    struct skin_sheet *sheets;
    int *around; /* sheets of rings */
};

/* A ring's vertex above; the one below, where there is one, follows. */
static inline int skin_above(const struct skin *skin, int ring)
{
    return skin->n_plain + (ring < skin->n_both ? 2 * ring : skin->n_both + ring);
}
/* The ring of a vertex, -1 of a plain one; is it below? */
static inline int skin_ring_of(const struct skin *skin, int vertex, bool *below)
{
    const int k = vertex - skin->n_plain;
    *below = k >= 0 && k < 2 * skin->n_both && k % 2 != 0;
    return k < 0 ? -1 : k < 2 * skin->n_both ? k / 2 : k - skin->n_both;
}

void skin_build(struct skin *skin, const struct solid_mesh *mesh);
void skin_clear(struct skin *skin);

/* Normal of a sheet, of length 1, with node i at places[i * stride] and the two behind it [m].
 * */
struct vec3 skin_normal(const struct skin_sheet *sheet, const double *places, size_t stride);
/* From a ring's node to its vertex above, with normals of all sheets around [m]. */
struct vec3 skin_arm(const struct skin *skin, int ring, const struct vec3 *normals);
/* Places of all vertices, with all nodes. */
void skin_place(const struct skin *skin, const struct vec3 *nodes, struct vec3 *vertices);

#endif
