/* What each compilation of shell_element_blocks.c offers to shell_element.c, for it alone. */
#ifndef TREMIE_PHYSICS_SHELL_ELEMENT_BLOCKS_H
#define TREMIE_PHYSICS_SHELL_ELEMENT_BLOCKS_H

#include "base/isa.h"
#include "physics/solid_element.h"

ISA_DECLARE(struct solid_element_kernel, shell_element_blocks);

#endif
