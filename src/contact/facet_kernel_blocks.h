/* What each compilation of facet_kernel_blocks.c offers to facet_kernel.c, for it alone. */
#ifndef TREMIE_CONTACT_FACET_KERNEL_BLOCKS_H
#define TREMIE_CONTACT_FACET_KERNEL_BLOCKS_H

#include "base/isa.h"
#include "contact/facet_kernel.h"

struct facet_kernel_blocks {
    struct facet_kernel choice[2][2]; /* [full][ledger] */
};

ISA_DECLARE(struct facet_kernel_blocks, facet_kernel_blocks);

#endif
