/*
 * What elements a mesh has.
 */
#ifndef TREMIE_SOLID_SOLID_PLAN_H
#define TREMIE_SOLID_SOLID_PLAN_H

#include "physics/solid_element.h"

struct solid_mesh;

enum solid_element_shape solid_plan_shape(const struct solid_mesh *mesh, int element);

#endif
