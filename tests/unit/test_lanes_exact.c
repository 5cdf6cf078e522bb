/* Exact sums in lanes hold what ordinary ones hold. */
#define LANES_WIDTH 2
#include "physics/lanes_exact.h"

#include "check.h"

#include <math.h>

TEST(columns_take_and_hold_what_ordinary_sums_do)
{
    struct lanes_exact sum = {{{0}}};
    struct exact_sum single = {{0, 0, 0}, 0, 0}, merged = {{0, 0, 0}, 0, 0};
    uint64_t state = 1;
    for (int n = 0; n < 100000; n++) {
        lanes term;
        lanes_mask limbs[3];
        for (int l = 0; l < LANES_WIDTH; l++) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            const double share = (double)(int64_t)state * 0x1p-63;
            term[l] = ldexp(share, (int)(state >> 7 & 127) - 69);
        }
        const lanes taken = lanes_exact_round(term, limbs);
        lanes_exact_add(&sum, limbs);
        for (int l = 0; l < LANES_WIDTH; l++)
            EXPECT(exact_sum_add(&single, term[l]) == taken[l]);
    }
    lanes_exact_merge(&sum, 100000, &merged);
    exact_sum_normalise(&merged);
    exact_sum_normalise(&single);
    EXPECT(memcmp(&merged, &single, sizeof merged) == 0);
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < LANES_EXACT_COLUMNS; c++)
            EXPECT(sum.limb[k][c] == 0);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
