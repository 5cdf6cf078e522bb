/* Chooses among the compilations of integrate_rows.c. */
#include "physics/integrate.h"

#include "physics/integrate_rows.h"

struct integrate_kernel integrate_choose(enum isa isa)
{
    return ISA_PICK(isa_choose(isa), integrate_rows);
}
