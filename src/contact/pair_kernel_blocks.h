/* What each compilation of pair_kernel_blocks.c offers to pair_kernel.c, for it alone. */
#ifndef TREMIE_CONTACT_PAIR_KERNEL_BLOCKS_H
#define TREMIE_CONTACT_PAIR_KERNEL_BLOCKS_H

#include "base/isa.h"

struct pair_kernel_work;

struct pair_kernel_blocks {
    void (*apply[2][2][2])(struct pair_kernel_work *work); /* [uniform][full][ledger] */
};

ISA_DECLARE(struct pair_kernel_blocks, pair_kernel_blocks);

#endif
