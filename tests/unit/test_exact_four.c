/* Four sums side by side hold what four ordinary ones hold. */
#include "base/exact_four.h"
#include "check.h"

#include <math.h>

TEST(four_sums_take_and_hold_what_single_ones_do)
{
    struct exact_four four = {{{{0, 0}, {0, 0}}, {{0, 0}, {0, 0}}, {{0, 0}, {0, 0}}}, 0};
    struct exact_sum single[4] = {{{0, 0, 0}, 0, 0}}, merged[4] = {{{0, 0, 0}, 0, 0}};
    uint64_t state = 1;
    for (int n = 0; n < 100000; n++) {
        double terms[4], taken[4];
        for (int k = 0; k < 4; k++) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            const double share = (double)(int64_t)state * 0x1p-63;
            terms[k] = ldexp(share, (int)(state >> 7 & 127) - 69);
        }
        exact_four_add(&four, terms, taken);
        for (int k = 0; k < 4; k++)
            EXPECT(exact_sum_add(&single[k], terms[k]) == taken[k]);
    }
    for (int k = 0; k < 4; k++) {
        exact_four_merge(&four, k, &merged[k]);
        exact_sum_normalise(&merged[k]);
        exact_sum_normalise(&single[k]);
        EXPECT(memcmp(&merged[k], &single[k], sizeof merged[k]) == 0);
    }
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
