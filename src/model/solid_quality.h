/*
 * What is wrong with the mesh of a body that deforms, and how good it is.
 */
#ifndef TREMIE_MODEL_SOLID_QUALITY_H
#define TREMIE_MODEL_SOLID_QUALITY_H

#include "base/vec3.h"

struct job_place;
struct mistakes;
struct solid_mesh;

struct solid_quality {
    int n_hexahedra, n_tetrahedra, n_quads, n_triangles;
    int n_sides;           /* on the surface */
    int n_parts;           /* that have no node in common */
    double volume, area;   /* [m3], [m2] */
    struct vec3 low, high; /* corners of the box around it [m] */
    double aspect;         /* largest of longest over shortest edge [-] */
    /* Scaled Jacobian: of the three edges at a corner, their volume over that of the most
     * regular corner with edges so long: 1 for a cube and a regular tetrahedron, 0 for what is
     * flat; of a sheet likewise the area of two, 1 for a rectangle and a regular triangle.  Of
     * an element that of its worst corner. */
    double jacobian_least, jacobian_mean; /* [-] */
    int aspect_worst, jacobian_worst;     /* such elements */
    double warp;                          /* of quads: most that a corner is off the plane of
                                             the others, over the root of the area [-] */
    int warp_worst;
    double thickness_least, thickness_most; /* of sheets [m] */
    double thick;                           /* most thickness over the root of the area [-] */
    int thick_worst;
};

struct solid_quality solid_quality_of(const struct solid_mesh *mesh);

double solid_quality_volume(const struct solid_mesh *mesh, int element);
struct vec3 solid_quality_centre(const struct solid_mesh *mesh, int element);

/* The numbers that people know: those of the file, or from 1. */
long long solid_quality_node_number(const struct solid_mesh *mesh, int node);
long long solid_quality_element_number(const struct solid_mesh *mesh, int element);

/* Lists what no element code can bear: loose nodes, nodes twice in an element, elements without
 * volume, with a negative one or there twice, sides of more than two elements, hexahedra that
 * meet two tetrahedra in a side, edges where the surface meets itself.  Of each kind the first
 * few are listed.  `file` and `place` say where, `name` is the body's. */
void solid_quality_check(const struct solid_mesh *mesh, const char *name, const char *file,
                         struct job_place place, struct mistakes *mistakes);

#endif
