/*
 * The pair kernel of eight lanes, compiled here for the processor that the tests are built for:
 * so its blocks and shuffles are tested where there are no vectors of eight.
 */
#define pair_kernel_blocks_v4 wide_blocks /* beside the library's own */
#define KERNEL_ISA            4
/* Everything is inlined; nothing passes such vectors. */
#pragma GCC diagnostic ignored "-Wpsabi"
#include "contact/pair_kernel_blocks.c"

#include "check.h"

#include "pair_scene.h"

TEST(eight_lanes_give_the_same_bits)
{
    static struct scene expected, got;

    for (int choice = 0; choice < 8; choice++) {
        const bool uniform = choice & 1, full = choice & 2, ledger = choice & 4;
        const struct pair_kernel kernel = pair_kernel_choose(ISA_AUTO, uniform, full, ledger);
        scene_fill(&expected, 29);
        if (uniform)
            memset(expected.material, 0, sizeof expected.material);
        memcpy(&got, &expected, sizeof got);
        for (int step = 0; step < 40; step++) {
            scene_apply(&expected, kernel.apply);
            scene_apply(&got, wide_blocks().apply[uniform][full][ledger]);
            if (scene_difference(&expected, &got) != NULL)
                CHECK_FAIL("step %d: %s differs", step, scene_difference(&expected, &got));
            scene_move(&expected);
            scene_move(&got);
        }
    }
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
