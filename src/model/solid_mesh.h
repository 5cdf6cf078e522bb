/*
 * The mesh of a deformable solid at time 0: nodes, elements, and named sets of them.
 *
 * An element has eight nodes, a hexahedron, or four and then -1, a tetrahedron; or it is one
 * of a shell or membrane, a sheet: a quad of four nodes or a triangle of three and -1, and
 * then SOLID_MESH_SHEET.  Of a hexahedron nodes 0 to 3 go round its bottom counter-clockwise
 * as seen from its top, nodes 4 to 7 lie above them; of a tetrahedron nodes 0, 1, 2 go round
 * counter-clockwise as seen from node 3.  So both have positive volumes.  (Abaqus, LS-DYNA and
 * Gmsh number them so too.)
 *
 * A hexahedron's sides are its bottom, its top, and those above the edges 0-1, 1-2, 2-3, 3-0
 * of the bottom; a tetrahedron's that of the nodes 0, 1, 2 and those above its edges 0-1, 1-2,
 * 2-0.  Pressures (solid/solid_side.h) count them so too: there is one table of them,
 * solid_mesh_side_corners().  A sheet has one, itself as seen from the side to which its nodes
 * go round counter-clockwise.
 *
 * Elements of a file keep its order, nodes come by number; whatever comes from here depends on
 * the job alone.  Local, all of it.
 */
#ifndef TREMIE_MODEL_SOLID_MESH_H
#define TREMIE_MODEL_SOLID_MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/vec3.h"

struct job;
struct job_body;

enum { SOLID_MESH_SIDES = 6 };  /* that an element has room for */
enum { SOLID_MESH_SHEET = -2 }; /* fifth of an element of a shell or membrane */

struct solid_mesh_side {
    int element, side;
};

/* Each list ascends and has everything once. */
struct solid_mesh_set {
    char *name;
    int n_nodes, n_sides, n_elements;
    int *nodes;
    struct solid_mesh_side *sides; /* on the surface */
    int *elements;
    int n_strays;     /* facets of the file that are no such side */
    int (*strays)[4]; /* their nodes; of three the fourth is -1 */
};

/* What an element of a shell or membrane is besides its nodes. */
struct solid_mesh_sheet {
    double thickness; /* [m]; 0 of all other elements */
    bool membrane;
    int material; /* among the job's, of all elements */
};

struct solid_mesh {
    int n_nodes, n_elements, n_sets;
    struct vec3 *nodes; /* [m] */
    int (*elements)[8];
    int64_t *node_numbers, *element_numbers; /* what the file calls them; else from 1 */
    struct solid_mesh_set *sets;
    struct solid_mesh_sheet *sheets; /* of each element; NULL: there is no sheet */
};

/* The body's mesh, placed, with all of its sets: those that come with a shape or a file, and
 * those of the job.  It may have faults: see model/solid_quality.h. */
void solid_mesh_build(struct solid_mesh *mesh, const struct job_body *body);
void solid_mesh_clear(struct solid_mesh *mesh);

/* The body's mesh, built once and kept with it until solid_mesh_release(): building takes as
 * long as some hundred steps do, and several rooms look at it before a run. */
const struct solid_mesh *solid_mesh_keep(struct job_body *body);
/* The one that is kept, or else one built in *own, which is to be cleared in any case. */
const struct solid_mesh *solid_mesh_borrow(const struct job_body *body, struct solid_mesh *own);
/* Frees those that are kept. */
void solid_mesh_release(struct job *job);

/* NULL where there is none of this name. */
const struct solid_mesh_set *solid_mesh_find(const struct solid_mesh *mesh, const char *name);

static inline bool solid_mesh_is_sheet(const int element[8])
{
    return element[4] == SOLID_MESH_SHEET;
}
static inline int solid_mesh_n_corners(const int element[8])
{
    return element[4] >= 0 ? 8 : element[3] >= 0 ? 4 : 3;
}
/* What an element is made of, where all without sheets are of `standard`. */
static inline int solid_mesh_material(const struct solid_mesh *mesh, int element, int standard)
{
    return mesh->sheets != NULL ? mesh->sheets[element].material : standard;
}
static inline int solid_mesh_n_sides(const int element[8])
{
    return element[4] >= 0 ? 6 : solid_mesh_is_sheet(element) ? 1 : 4;
}
/* Which corners of an element with so many make a side, counter-clockwise seen from outside:
 * 0321, 4567, 0154, 1265, 2376, 3047 of a hexahedron, 021, 013, 123, 203 of a tetrahedron.
 * Returns how many; 0 where there is no such side. */
int solid_mesh_side_corners(int n_corners, int side, int corners[4]);
/* The nodes of a side likewise.  The fourth of three is -1. */
int solid_mesh_side_nodes(const int element[8], int side, int nodes[4]);

/* Of each element that is a sheet the side that has its nodes, counted as below, on the surface
 * or between two elements; else -1.  The caller frees it. */
int *solid_mesh_covered(const struct solid_mesh *mesh);

/* What lies behind side s of element e, at SOLID_MESH_SIDES * e + s: the number, counted so, of
 * the side that it shares its nodes with; or one of these.  The caller frees it. */
enum {
    SOLID_MESH_OUTSIDE = -1, /* nothing: it is on the surface */
    SOLID_MESH_SEVERAL = -2, /* sides of several elements: a fault */
    SOLID_MESH_NO_SIDE = -3  /* a tetrahedron has but four, a sheet one */
};
int *solid_mesh_partners(const struct solid_mesh *mesh);
/* The sides on the surface, ascending; returns how many.  The caller frees them. */
int solid_mesh_surface(const struct solid_mesh *mesh, struct solid_mesh_side **sides);

/* Adds a set, which must not be there: for what builds meshes.  `sides` are counted as above;
 * lists need neither ascend nor have everything once. */
struct solid_mesh_list {
    int n, capacity;
    int *items;
};
void solid_mesh_list_add(struct solid_mesh_list *list, int item);
void solid_mesh_add_set(struct solid_mesh *mesh, const char *name,
                        const struct solid_mesh_list *nodes,
                        const struct solid_mesh_list *sides,
                        const struct solid_mesh_list *elements);

#endif
