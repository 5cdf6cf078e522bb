/* What each compilation of integrate_rows.c offers to integrate.c, for it alone. */
#ifndef TREMIE_PHYSICS_INTEGRATE_ROWS_H
#define TREMIE_PHYSICS_INTEGRATE_ROWS_H

#include "base/isa.h"
#include "physics/integrate.h"

ISA_DECLARE(struct integrate_kernel, integrate_rows);

#endif
