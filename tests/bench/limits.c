/*
 * What one core can do at most: bytes moved to and from memory, additions and multiplications in
 * vectors.  For the table of limits in README.md:
 *
 *   gcc -O3 -march=native -ffp-contract=off tests/bench/limits.c -o build/limits && taskset -c 0 build/limits
 *
 * Each figure is the best of several tries, as other work on the machine only slows it down.
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { TRIES = 20, MANY = 1 << 24, CHAINS = 64, ROUNDS = 200000 };

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Bytes a second read and written where an array far larger than the caches is moved on. */
static double memory_rate(double *a)
{
    double best = 0.0;
    for (int try = 0; try < TRIES; try++) {
        const double began = now();
        for (int k = 0; k < MANY; k++)
            a[k] = a[k] * 0.999 + 1.0;
        const double rate = 2.0 * sizeof *a * MANY / (now() - began);
        best = rate > best ? rate : best;
    }
    return best;
}

/* Operations a second where as many additions as multiplications do not wait for each other. */
static double arithmetic_rate(double *a)
{
    double best = 0.0;
    for (int try = 0; try < TRIES; try++) {
        const double began = now();
        for (int round = 0; round < ROUNDS; round++)
            for (int k = 0; k < CHAINS; k++)
                a[k] = a[k] * 0.999 + 1.0;
        const double rate = 2.0 * CHAINS * ROUNDS / (now() - began);
        best = rate > best ? rate : best;
    }
    return best;
}

int main(void)
{
    double *a = aligned_alloc(64, MANY * sizeof *a);
    if (a == NULL)
        return 1;
    for (int k = 0; k < MANY; k++)
        a[k] = 1.0;
    printf("memory: %.1f GB/s read and written\n", memory_rate(a) * 1e-9);
    printf("arithmetic: %.1f GFLOP/s\n", arithmetic_rate(a) * 1e-9);
    free(a);
    return 0;
}
