/*
 * Elements in eight lanes, compiled here for the processor that the tests are built for: so its
 * blocks and shuffles are tested where there are no vectors of eight.
 */
#define solid_element_blocks_v4 wide_blocks /* beside the library's own */
#define KERNEL_ISA              4
/* Everything is inlined; nothing passes such vectors. */
#pragma GCC diagnostic ignored "-Wpsabi"
#include "physics/solid_element_blocks.c"

#include "check.h"
#include "solid_block.h"

TEST(eight_lanes_give_the_same_bits)
{
    static const struct solid_yield_point curve[2] = {{0.0, 1e6}, {0.01, 2e6}};
    const struct solid_material material = {1000.0, 1e9, 0.3, 1e-6, 0.1, 0.05, 2, curve, 1e7};
    for (int choice = 0; choice < 2; choice++) {
        uint64_t seed = 3;
        struct solid_block block;
        struct solid ours, wide;
        solid_block_build(&block, 3, 3, 3, (const double[3]){1.0, 1.0, 1.0}, choice == 1);
        solid_block_distort(&block, 0.08, &seed);
        solid_create(&ours, &block.mesh, 1, &material, ISA_AUTO);
        solid_create(&wide, &block.mesh, 1, &material, ISA_AUTO);
        wide.kernel = wide_blocks();
        for (int i = 0; i < ours.n_nodes; i++)
            for (int d = 0; d < 3; d++)
                solid_velocity(&ours, i)[d] = solid_velocity(&wide, i)[d] =
                    20.0 * solid_block_random(&seed);
        for (int step = 0; step < 30; step++) {
            EXPECT(solid_forces(&ours, step, 4e-5) == solid_forces(&wide, step, 4e-5));
            solid_move(&ours, step, 4e-5);
            solid_move(&wide, step, 4e-5);
            EXPECT(memcmp(ours.node, wide.node, (size_t)ours.n_nodes * sizeof *ours.node) == 0);
            EXPECT(memcmp(ours.state, wide.state,
                          (size_t)ours.n_elements * sizeof *ours.state) == 0);
        }
        EXPECT(ours.state[0].plastic_strain > 0.0);
        solid_destroy(&ours);
        solid_destroy(&wide);
        solid_block_free(&block);
    }
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
