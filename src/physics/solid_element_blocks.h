/* What each compilation of solid_element_blocks.c offers to solid_element.c, for it alone. */
#ifndef TREMIE_PHYSICS_SOLID_ELEMENT_BLOCKS_H
#define TREMIE_PHYSICS_SOLID_ELEMENT_BLOCKS_H

#include "base/isa.h"
#include "physics/solid_element.h"

ISA_DECLARE(struct solid_element_kernel, solid_element_blocks);

#endif
