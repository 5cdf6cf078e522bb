/*
 * What elements a body asks for.
 */
#ifndef TREMIE_SOLID_SOLID_PLAN_H
#define TREMIE_SOLID_SOLID_PLAN_H

#include <stdbool.h>

#include "physics/solid_element.h"

struct job_body;
struct solid_mesh;

enum solid_element_shape solid_plan_shape(const struct solid_mesh *mesh, int element);

/* What holds modes of hourglasses: springs or dashpots of hexahedra, springs of sheets. */
struct solid_plan_hourglass {
    double stiffness, viscosity; /* as in struct solid_material */
};
struct solid_plan_hourglass solid_plan_hourglass(const struct job_body *body, bool is_sheet);

#endif
