/* Chooses among the kernels of pair_kernel_blocks.c. */
#include "contact/pair_kernel.h"

#include "contact/pair_kernel_blocks.h"
#include "physics/contact_law.h"

_Static_assert((int)CONTACT_LANES == (int)CONTACT_LAW_LANES &&
                   (int)CONTACT_DRAG_LANE == (int)CONTACT_LAW_DRAG &&
                   (int)CONTACT_RADIUS_LANE == (int)CONTACT_LAW_RADIUS &&
                   (int)CONTACT_ROLLING_LANE == (int)CONTACT_LAW_ROLLING &&
                   (int)CONTACT_TWISTING_LANE == (int)CONTACT_LAW_TWISTING,
               "contact sets keep what the law remembers");

struct pair_kernel pair_kernel_choose(enum isa isa, bool uniform, bool full, bool ledger)
{
    const enum isa chosen = isa_choose(isa);
    const struct pair_kernel_blocks blocks = ISA_PICK(chosen, pair_kernel_blocks);
    return (struct pair_kernel){chosen, blocks.apply[uniform][full][ledger]};
}
