/*
 * Shells and membranes in eight lanes, compiled here for the processor that the tests are built
 * for: so blocks and shuffles are tested where there are no vectors of eight.
 */
#define shell_element_blocks_v4 wide_blocks /* beside the library's own */
#define KERNEL_ISA              4
/* Everything is inlined; nothing passes such vectors. */
#pragma GCC diagnostic ignored "-Wpsabi"
#include "physics/shell_element_blocks.c"

#include "check.h"
#include "shell_sheet.h"

TEST(eight_lanes_give_the_same_bits)
{
    static const struct solid_yield_point curve[2] = {{0.0, 1e6}, {0.01, 2e6}};
    const struct solid_material material = {1000.0, 1e9, 0.3, 1e-6, 0.5, 0.0, 2, curve, 1e7};
    static const enum solid_element_shape shapes[4] = {
        SOLID_ELEMENT_SHELL_QUAD, SOLID_ELEMENT_SHELL_TRIANGLE, SOLID_ELEMENT_MEMBRANE_QUAD,
        SOLID_ELEMENT_MEMBRANE_TRIANGLE};
    for (int choice = 0; choice < 4; choice++) {
        uint64_t seed = 3;
        struct shell_sheet sheet;
        struct solid ours, wide;
        shell_sheet_build(&sheet, 4, 3, (const double[2]){4.0, 3.0}, shapes[choice], 0.1, 5);
        shell_sheet_distort(&sheet, 0.2, &seed);
        solid_create(&ours, &sheet.mesh, 1, &material, ISA_AUTO);
        solid_create(&wide, &sheet.mesh, 1, &material, ISA_AUTO);
        wide.kernel = wide_blocks();
        for (int i = 0; i < ours.n_nodes; i++)
            for (int d = 0; d < 3; d++)
                solid_velocity(&ours, i)[d] = solid_velocity(&wide, i)[d] =
                    20.0 * solid_block_random(&seed);
        for (int step = 0; step < 30; step++) {
            EXPECT(solid_forces(&ours, step, 2e-5) == solid_forces(&wide, step, 2e-5));
            solid_move(&ours, step, 2e-5);
            solid_move(&wide, step, 2e-5);
        }
        EXPECT(memcmp(ours.node, wide.node, (size_t)ours.n_nodes * sizeof *ours.node) == 0);
        EXPECT(memcmp(ours.state, wide.state, (size_t)ours.n_elements * sizeof *ours.state) ==
               0);
        EXPECT(memcmp(ours.shell, wide.shell, (size_t)ours.n_elements * sizeof *ours.shell) ==
               0);
        EXPECT(ours.state[0].plastic_strain > 0.0);
        solid_destroy(&ours);
        solid_destroy(&wide);
        shell_sheet_free(&sheet);
    }
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
