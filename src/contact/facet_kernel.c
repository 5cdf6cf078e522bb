/* Chooses among the kernels of facet_kernel_blocks.c. */
#include "contact/facet_kernel.h"

#include "contact/facet_kernel_blocks.h"

struct facet_kernel facet_kernel_choose(enum isa isa, bool full, bool ledger)
{
    const struct facet_kernel_blocks blocks = ISA_PICK(isa_choose(isa), facet_kernel_blocks);
    return blocks.choice[full][ledger];
}
