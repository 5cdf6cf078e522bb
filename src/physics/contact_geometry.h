/*
 * Where a sphere meets a feature (face, edge, vertex; band, ring) of a surface.
 *
 * A sphere touches a surface where the distance to its centre is least *locally*: a minimum
 * inside a face, on an edge, at a vertex. Each place belongs to one feature. A face holds what
 * projects into it; an edge what projects onto it and lies before none of its adjoining faces;
 * a vertex what lies beyond it on all of its edges. So a convex edge gives one contact, a
 * concave corner one a wall.
 *
 * Neighbours decide by the same products of the same numbers, and every region reaches a hair
 * (1e-7 of the radius) beyond its borders. So rounding leaves no gap at a seam, where a sphere
 * would fall through for a step; at the price that two features may hold the same place, where
 * who asks must drop one (contact/facet_contact.c).
 *
 * A round surface is the same thing in the half-plane through its axis and the sphere's centre:
 * bands hold what projects into them, rings what lies beyond the ends of their bands. Where the
 * centre is on the axis and the wall around it, the nearest point is a whole circle; there the
 * normal is along the axis.
 *
 * Surfaces have two sides: the normal points to whichever side the centre is on.
 */
#ifndef TREMIE_PHYSICS_CONTACT_GEOMETRY_H
#define TREMIE_PHYSICS_CONTACT_GEOMETRY_H

#include <stdbool.h>

#include "base/vec3.h"
#include "model/mesh.h"

/* How far regions reach beyond their borders, in radii. */
#define CONTACT_GEOMETRY_SEAM 1e-7

struct contact_geometry {
    struct vec3 point;  /* of the feature, closest to the centre [m] */
    struct vec3 normal; /* unit vector from there to the centre */
    double distance;    /* [m] */
};

/* Is the sphere in touch with the feature, in its own region?  `at` is set when it is. */
bool contact_geometry_touches(const struct mesh *mesh, int feature, struct vec3 centre,
                              double radius, struct contact_geometry *at);

/* The same whatever the region and the distance; of a face, the foot on its plane. */
struct contact_geometry contact_geometry_closest(const struct mesh *mesh, int feature,
                                                 struct vec3 centre);

/* May any point of the feature lie within reach of the centre?  Never wrong when it says no. */
bool contact_geometry_reaches(const struct mesh *mesh, int feature, struct vec3 centre,
                              double reach);

/* The same for a side of a face, its edge and its vertices; quick where the centre is well
 * inside. */
bool contact_geometry_reaches_side(const struct mesh *mesh, int face, int side,
                                   struct vec3 centre, double reach);

#endif
