/*
 * Philox 4x32 with ten rounds: J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, "Parallel
 * random numbers: as easy as 1, 2, 3", SC'11, https://doi.org/10.1145/2063384.2063405.  Its key
 * is the seed, its counter (counter, stream), both with the low half first.  Each call gives
 * 128 bits, of which a number takes 64 and a normal deviate all.  Some 20 ns a call.
 */
#include "base/random.h"

#include <math.h>

#include "base/elementary.h"

struct block {
    uint32_t words[4];
};

static struct block philox(uint64_t seed, uint64_t stream, uint64_t counter)
{
    struct block x = {{(uint32_t)counter, (uint32_t)(counter >> 32), (uint32_t)stream,
                       (uint32_t)(stream >> 32)}};
    uint32_t key[2] = {(uint32_t)seed, (uint32_t)(seed >> 32)};
    for (int round = 0; round < 10; round++) {
        const uint64_t a = (uint64_t)x.words[0] * 0xd2511f53u;
        const uint64_t b = (uint64_t)x.words[2] * 0xcd9e8d57u;
        x = (struct block){{(uint32_t)(b >> 32) ^ x.words[1] ^ key[0], (uint32_t)b,
                            (uint32_t)(a >> 32) ^ x.words[3] ^ key[1], (uint32_t)a}};
        key[0] += 0x9e3779b9u;
        key[1] += 0xbb67ae85u;
    }
    return x;
}

static uint64_t joined(uint32_t low, uint32_t high)
{
    return (uint64_t)high << 32 | low;
}

/* The upper 53 bits as a number below 1: exact. */
static double scaled(uint64_t bits)
{
    return (double)(bits >> 11) * 0x1p-53;
}

uint64_t random_bits(uint64_t seed, uint64_t stream, uint64_t counter)
{
    const struct block x = philox(seed, stream, counter);
    return joined(x.words[0], x.words[1]);
}

double random_unit(uint64_t seed, uint64_t stream, uint64_t counter)
{
    return scaled(random_bits(seed, stream, counter));
}

double random_normal(uint64_t seed, uint64_t stream, uint64_t counter)
{
    const struct block x = philox(seed, stream, counter);
    const double u = 1.0 - scaled(joined(x.words[0], x.words[1])); /* never 0 */
    const double turn = scaled(joined(x.words[2], x.words[3]));
    return sqrt(-2.0 * elementary_log(u)) * elementary_cos(0x1.921fb54442d18p+2 * turn);
}
