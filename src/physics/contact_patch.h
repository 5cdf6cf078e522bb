/*
 * What a ball covers of a triangle, and how much of the ball lies behind it.
 *
 * A sphere that touches a surface which deforms meets many faces at once, whose angles change.
 * What it feels there follows from one number, the volume V that the ball has in common with
 * the body: it changes smoothly however nodes move and wherever seams and edges run (THEORY.md
 * 2.1).  Faces share it without gap or overlap: each has what lies behind it within the ball,
 * as seen from the centre; one seen from behind has it less.  Its derivatives are areas: V
 * grows by the area that the ball covers times how far that moves outwards.
 *
 * The centre must be outside of the body.
 */
#ifndef TREMIE_PHYSICS_CONTACT_PATCH_H
#define TREMIE_PHYSICS_CONTACT_PATCH_H

#include <stdbool.h>

#include "base/vec3.h"
#include "model/mesh.h"

struct contact_patch {
    bool is_circle;     /* all of that in which the ball meets the plane, from before */
    double area;        /* of the face within the ball [m2] */
    double volume;      /* of the ball behind that, in the cone from the centre; negative where
                           the face is seen from behind [m3] */
    struct vec3 middle; /* of that area [m] */
    double weights[3];  /* what each vertex has of the area: its shape function over it [m2] */
};

/* Of a face with three vertices; false where it covers nothing of it. */
bool contact_patch_cut(const struct mesh *mesh, int face, struct vec3 centre, double radius,
                       struct contact_patch *patch);

/* How deep a ball is in a half-space that takes this volume of it: at most its radius [m]. */
double contact_patch_depth(double volume, double radius);

#endif
