/*
 * Random numbers that are a function of (seed, stream, counter) alone: no state, so any rank, a
 * restart or a test draws the same number for the same purpose, in any order.
 *
 * A stream belongs to one purpose and one item (random_stream()); the counter numbers its
 * draws. Draws of different streams or counters are independent.  Local, all of it.
 */
#ifndef TREMIE_BASE_RANDOM_H
#define TREMIE_BASE_RANDOM_H

#include <stdint.h>

/* What numbers are drawn for: each purpose has streams of its own. */
enum random_purpose {
    RANDOM_PACKING_SIZES = 1,    /* radii of a group at the start */
    RANDOM_PACKING_PLACES,       /* their places */
    RANDOM_PACKING_MATERIALS,    /* what each is made of */
    RANDOM_INSERTION_SIZES,      /* the same of an insertion */
    RANDOM_INSERTION_PLACES,     /* places that it tries */
    RANDOM_INSERTION_MATERIALS,  /* what each is made of */
    RANDOM_INSERTION_VELOCITIES, /* by how much its velocity differs */
    RANDOM_PACKING_VACANCIES     /* places of the first group again, once space is scarce */
};

/* The stream of one item (the 3rd group, the 1st insertion) for a purpose. */
static inline uint64_t random_stream(enum random_purpose purpose, int item)
{
    return (uint64_t)purpose << 32 | (uint32_t)item;
}

/* 64 random bits. */
uint64_t random_bits(uint64_t seed, uint64_t stream, uint64_t counter);
/* Evenly from 0 up to, but not including, 1: a multiple of 2^-53. */
double random_unit(uint64_t seed, uint64_t stream, uint64_t counter);
/* Standard normal, by Box and Muller's method: of magnitude 8.6 at most. */
double random_normal(uint64_t seed, uint64_t stream, uint64_t counter);

#endif
