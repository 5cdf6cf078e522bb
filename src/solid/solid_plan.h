/*
 * What elements a body asks for, and what their nodes bear besides.
 */
#ifndef TREMIE_SOLID_SOLID_PLAN_H
#define TREMIE_SOLID_SOLID_PLAN_H

#include <stdbool.h>

#include "physics/solid_element.h"

struct job_body;
struct solid_mesh;
struct solid_mesh_set;

enum solid_element_shape solid_plan_shape(const struct solid_mesh *mesh, int element);

/* What holds modes of hourglasses: springs or dashpots of hexahedra, springs of sheets. */
struct solid_plan_hourglass {
    double stiffness, viscosity; /* as in struct solid_material */
};
struct solid_plan_hourglass solid_plan_hourglass(const struct job_body *body, bool is_sheet);

/* What each node of a set bears by item k of the body's masses. */
struct solid_plan_mass {
    const struct solid_mesh_set *set; /* of the mesh */
    double mass, inertia;             /* [kg], [kg m2] */
};
struct solid_plan_mass solid_plan_mass(const struct job_body *body,
                                       const struct solid_mesh *mesh, int k);

#endif
