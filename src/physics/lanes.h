/*
 * Several doubles side by side: what the contact law is written in.
 *
 * The includer says how many with LANES_WIDTH (1, 2, 4 or 8), and the same text then compiles
 * to plain scalar code or to vectors of that width.  Where it says nothing, a file that is
 * compiled for each instruction set (base/isa.h) has as many as that set's vectors hold, any
 * other one. The lanes never mix, and + - * / sqrt are exact to the last bit in each, so every
 * width gives the same bits.
 *
 * A comparison gives a mask; where(mask, a, b) *chooses* between two values, and keep(mask, a)
 * chooses between a and +0.0.  Nothing is ever multiplied by a mask: 0 x -a is -0, and 0 x
 * infinity is NaN.
 *
 * GCC vector extensions (gcc >= 12, clang) say nearly everything.  Written natively for x86:
 * square roots, choices, the test for any lane set, all of which gcc 12 takes apart into scalar
 * code or longer sequences.  Vector types cannot be had without a typedef.
 */
#ifndef TREMIE_PHYSICS_LANES_H
#define TREMIE_PHYSICS_LANES_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#if defined __x86_64__
#include <immintrin.h>
#endif

#ifndef LANES_WIDTH
#if !defined KERNEL_ISA
#define LANES_WIDTH 1
#elif KERNEL_ISA == 4
#define LANES_WIDTH 8
#elif KERNEL_ISA == 3
#define LANES_WIDTH 4
#else
#define LANES_WIDTH 2
#endif
#endif

/* Everything here must vanish into its caller: the lanes live in registers. */
#define LANES_INLINE static inline __attribute__((always_inline))

#if LANES_WIDTH == 1

typedef double lanes;
typedef int lanes_mask;

LANES_INLINE lanes lanes_all(double x)
{
    return x;
}
LANES_INLINE lanes lanes_sqrt(lanes x)
{
    return sqrt(x);
}
LANES_INLINE lanes lanes_where(lanes_mask mask, lanes a, lanes b)
{
    return mask ? a : b;
}
LANES_INLINE lanes lanes_keep(lanes_mask mask, lanes a)
{
    return mask ? a : 0.0;
}
LANES_INLINE bool lanes_any(lanes_mask mask)
{
    return mask != 0;
}

#else

typedef double lanes __attribute__((vector_size(8 * LANES_WIDTH)));
typedef int64_t lanes_mask __attribute__((vector_size(8 * LANES_WIDTH)));
/* The same in memory, wherever doubles lie. */
typedef double lanes_in_memory
    __attribute__((vector_size(8 * LANES_WIDTH), aligned(8), may_alias));

LANES_INLINE lanes lanes_all(double x)
{
    return x - (lanes){0}; /* minus: x + 0 would turn -0 into +0 */
}

LANES_INLINE lanes lanes_load(const double *from)
{
    return *(const lanes_in_memory *)from;
}
LANES_INLINE void lanes_store(double *to, lanes x)
{
    *(lanes_in_memory *)to = x;
}

/* Which of as many indices as there are lanes are less. */
LANES_INLINE lanes_mask lanes_below(const int *indices, int limit)
{
    typedef int numbers __attribute__((vector_size(4 * LANES_WIDTH)));
    numbers own;
    memcpy(&own, indices, sizeof own);
    return __builtin_convertvector(own, lanes_mask) < (limit - (lanes_mask){0});
}

LANES_INLINE lanes lanes_sqrt(lanes x)
{
#if LANES_WIDTH == 8 && defined __AVX512F__
    return (lanes)_mm512_sqrt_pd((__m512d)x);
#elif LANES_WIDTH == 4 && defined __AVX__
    return (lanes)_mm256_sqrt_pd((__m256d)x);
#elif LANES_WIDTH == 2 && defined __SSE2__
    return (lanes)_mm_sqrt_pd((__m128d)x);
#else
    for (int l = 0; l < LANES_WIDTH; l++)
        x[l] = sqrt(x[l]);
    return x;
#endif
}

LANES_INLINE lanes lanes_where(lanes_mask mask, lanes a, lanes b)
{
#if LANES_WIDTH == 4 && defined __AVX__
    return (lanes)_mm256_blendv_pd((__m256d)b, (__m256d)a, (__m256d)mask);
#elif LANES_WIDTH == 2 && defined __SSE4_1__
    return (lanes)_mm_blendv_pd((__m128d)b, (__m128d)a, (__m128d)mask);
#else
    return (lanes)((mask & (lanes_mask)a) | (~mask & (lanes_mask)b));
#endif
}

LANES_INLINE lanes lanes_keep(lanes_mask mask, lanes a)
{
    return (lanes)(mask & (lanes_mask)a);
}

LANES_INLINE bool lanes_any(lanes_mask mask)
{
#if LANES_WIDTH == 8 && defined __AVX512F__
    return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0;
#elif LANES_WIDTH == 4 && defined __AVX__
    return _mm256_movemask_pd((__m256d)mask) != 0;
#elif LANES_WIDTH == 2 && defined __SSE2__
    return _mm_movemask_pd((__m128d)mask) != 0;
#else
    int64_t any = 0;
    for (int l = 0; l < LANES_WIDTH; l++)
        any |= mask[l];
    return any != 0;
#endif
}

/* Lane l as bit l. */
LANES_INLINE unsigned lanes_bits(lanes_mask mask)
{
#if LANES_WIDTH == 8 && defined __AVX512F__
    return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask);
#elif LANES_WIDTH == 4 && defined __AVX__
    return (unsigned)_mm256_movemask_pd((__m256d)mask);
#elif LANES_WIDTH == 2 && defined __SSE2__
    return (unsigned)_mm_movemask_pd((__m128d)mask);
#else
    unsigned bits = 0;
    for (int l = 0; l < LANES_WIDTH; l++)
        bits |= (unsigned)(mask[l] != 0) << l;
    return bits;
#endif
}

#endif

#endif
