/*
 * The pair kernel, in blocks of as many pairs as a vector has lanes.
 *
 * Compiled once for each instruction set (base/isa.h).  A sphere's data are rows of one cache
 * line, so a block loads whole rows, subtracts or adds the two of each pair, transposes them so
 * that each component of all pairs lies in one vector, applies the law, transposes the forces
 * back and adds whole rows.  That is twice as fast as gathering components, and leaves no
 * scalar remainder: lists are padded with dummies.
 *
 * Rows of second members jump about in memory; they are fetched some blocks ahead, which more
 * than doubles the speed once the spheres outgrow the cache.  They are fetched to the second
 * level of it only: the first can wait for far fewer lines at once, and is filled too soon.
 *
 * Row after row is added in the order of the list, so a sphere's sum does not depend on the
 * number of lanes.  That serializes pairs of one sphere through memory; the law of the next
 * block hides it.
 */
#include "contact/pair_kernel_blocks.h"

#include "contact/pair_kernel.h"
#include "physics/contact_law.h"
#include "physics/lanes_exact.h"
#include "physics/lanes_rows.h"

enum {
    WIDTH = LANES_WIDTH,
    PARTS = LANES_PARTS,
    AHEAD = 96,       /* pairs; two thirds as many are as good */
    SECOND_LEVEL = 2, /* of the cache, as __builtin_prefetch() counts */
};
_Static_assert(AHEAD + WIDTH <= PAIR_KERNEL_AHEAD, "rows are fetched from within the list");

/* Rows are found by their distance from the first [bytes]: worked out once a pair, it serves
 * three arrays. */
LANES_INLINE size_t row_at(int index)
{
    return sizeof(struct sphere_row) * (unsigned)index;
}

LANES_INLINE lanes row_part(const struct sphere_row *rows, size_t at, int part)
{
    return lanes_load((const double *)(const void *)((const char *)rows + at) + WIDTH * part);
}

/* Both spheres' rows, combined. */
struct block {
    size_t first[WIDTH], second[WIDTH]; /* where the rows are */
    lanes motion[8]; /* {x y z of second - first, R_i + R_j | v of second - first, R_j - R_i} */
    lanes spin[8];   /* sums {R w (3) 1/R | w (3) 1/m} */
    lanes turning[8]; /* of a full law: {second - first of w (3) and 1/m} last */
};

/* The halves of the spin rows that hold w: where a row is several vectors, only those. */
enum { TURNING = PARTS > 1 ? PARTS / 2 : 0 };

LANES_INLINE void block_load(struct block *block, const struct pair_kernel_work *work, int k,
                             bool full)
{
    static const double signs[8] = {1.0, 1.0, 1.0, -1.0, 1.0, 1.0, 1.0, 1.0};

#pragma GCC unroll 8
    for (int l = 0; l < WIDTH; l++) {
        const size_t i = row_at(work->first[k + l]), j = row_at(work->second[k + l]);
        block->first[l] = i;
        block->second[l] = j;
#pragma GCC unroll 4
        for (int part = 0; part < PARTS; part++) {
            const lanes sign = lanes_load(signs + WIDTH * part);
            const bool has_radius = part == 3 / WIDTH;
            const lanes of_first = row_part(work->motion, i, part);
            block->motion[WIDTH * part + l] =
                row_part(work->motion, j, part) - (has_radius ? of_first * sign : of_first);
            block->spin[WIDTH * part + l] =
                row_part(work->spin, j, part) + row_part(work->spin, i, part);
            if (full && part >= TURNING)
                block->turning[WIDTH * part + l] =
                    row_part(work->spin, j, part) - row_part(work->spin, i, part);
        }
    }
    lanes_transpose(block->motion);
    lanes_transpose(block->spin);
    if (full)
#pragma GCC unroll 4
        for (int part = TURNING; part < PARTS; part++)
            lanes_transpose_square(block->turning + WIDTH * part);
}

LANES_INLINE void fetch_ahead(const struct pair_kernel_work *work, int k)
{
#pragma GCC unroll 8
    for (int l = 0; l < WIDTH; l++) {
        const size_t j = row_at(work->second[k + AHEAD + l]);
        __builtin_prefetch((const char *)work->motion + j, 0, SECOND_LEVEL);
        __builtin_prefetch((const char *)work->spin + j, 0, SECOND_LEVEL);
        __builtin_prefetch((const char *)work->force + j, 0, SECOND_LEVEL);
    }
}

/* How the spheres meet.  Lever arms reach to the middle of the overlap. */
LANES_INLINE struct contact_law_meeting block_meeting(const struct block *block, bool full)
{
    const lanes *x = block->motion, *v = block->motion + 4, *s = block->spin,
                *w = block->spin + 4;
    const lanes distance = lanes_sqrt(contact_law_dot(x, x)),
                inverse = 1.0 / distance;  /* [m] */
    const lanes overlap = x[3] - distance; /* [m] */
    struct contact_law_meeting meeting = {
        .normal = {x[0] * inverse, x[1] * inverse, x[2] * inverse},
        .overlap = lanes_keep(overlap > lanes_all(0.0), overlap),
        .inverse_radius = s[3],
        .width = lanes_all(1.0),
        .inverse_mass = w[3],
    };
    const lanes *n = meeting.normal, half = 0.5 * meeting.overlap;
    const lanes r[3] = {s[0] - half * w[0], s[1] - half * w[1], s[2] - half * w[2]}; /* [m/s] */

    meeting.velocity[0] = v[0] - (r[1] * n[2] - r[2] * n[1]);
    meeting.velocity[1] = v[1] - (r[2] * n[0] - r[0] * n[2]);
    meeting.velocity[2] = v[2] - (r[0] * n[1] - r[1] * n[0]);
    if (full)
#pragma GCC unroll 3
        for (int k = 0; k < 3; k++)
            meeting.spin[k] = block->turning[4 + k];
    return meeting;
}

/* In a row of several vectors, force and torque lie apart.  Then the first's force, which is
 * the second's turned round, needs no transposing of its own. */
enum { FORCE_APART = PARTS > 1 };

/* The rows to add to the force rows of the first and the second; of the first's only the
 * torque's part where the force's lies apart. */
LANES_INLINE void block_rows(const struct block *block,
                             const struct contact_law_meeting *meeting,
                             const struct contact_law_result *result,
                             struct contact_law_choice choice, lanes first[8], lanes second[8])
{
    const lanes *n = meeting->normal, *f = result->tangential;
    const lanes sum = block->motion[3], difference = block->motion[7],
                half = 0.5 * meeting->overlap;
    const lanes arm_first = 0.5 * (sum - difference) - half;  /* [m] */
    const lanes arm_second = 0.5 * (sum + difference) - half; /* [m] */
    const lanes turn[3] = {n[2] * f[1] - n[1] * f[2], n[0] * f[2] - n[2] * f[0],
                           n[1] * f[0] - n[0] * f[1]}; /* [N] */

#pragma GCC unroll 3
    for (int x = 0; x < 3; x++) {
        second[x] = f[x] + result->normal * n[x];
        if (!FORCE_APART)
            first[x] = -second[x];
        first[4 + x] = arm_first * turn[x];
        second[4 + x] = arm_second * turn[x];
        if (choice.full) {
            first[4 + x] -= result->torque[x];
            second[4 + x] += result->torque[x];
        }
    }
    first[3] = second[3] = choice.ledger ? 0.5 * result->lost_friction : lanes_all(0.0);
    first[7] = second[7] = choice.ledger ? 0.5 * result->lost_damping : lanes_all(0.0);
    lanes_transpose(second);
#pragma GCC unroll 4
    for (int part = FORCE_APART ? PARTS / 2 : 0; part < PARTS; part++)
        lanes_transpose_square(first + WIDTH * part);
}

/* A part of the second's force turned round; the energy in lane 3 is the same for both. */
LANES_INLINE lanes turned_round(lanes force, int part)
{
    static const int64_t signs[8]
        __attribute__((aligned(64))) = {INT64_MIN, INT64_MIN, INT64_MIN, 0};
    return (lanes)((lanes_mask)force ^
                   (lanes_mask)lanes_load((const double *)(const void *)signs + WIDTH * part));
}

/* Row after row in the order of the list: where pairs share a sphere, sums depend on it. */
LANES_INLINE void block_add(const struct pair_kernel_work *work, const struct block *block,
                            const lanes first[8], const lanes second[8])
{
#pragma GCC unroll 8
    for (int l = 0; l < WIDTH; l++) {
        double *f = (double *)(void *)((char *)work->force + block->first[l]);
        double *g = (double *)(void *)((char *)work->force + block->second[l]);
#pragma GCC unroll 4
        for (int part = 0; part < PARTS; part++) {
            const int at = WIDTH * part;
            const bool is_force = FORCE_APART && part < PARTS / 2;
            const lanes of_first =
                is_force ? turned_round(second[at + l], part) : first[at + l];
            lanes_store(f + at, lanes_load(f + at) + of_first);
            lanes_store(g + at, lanes_load(g + at) + second[at + l]);
        }
    }
}

LANES_INLINE const struct material_pair *pair_of(const struct pair_kernel_work *work, int k)
{
    const int a = work->material[work->first[k]], b = work->material[work->second[k]];

    return &work->pairs[a * work->n_materials + b];
}

LANES_INLINE struct contact_law_constants constants_of_each(const struct pair_kernel_work *work,
                                                            int k, bool full)
{
    const struct material_pair *pairs[WIDTH];

#pragma GCC unroll 8
    for (int l = 0; l < WIDTH; l++)
        pairs[l] = pair_of(work, k + l);
    return contact_law_constants_of_each(pairs, full);
}

/* Work that springs took up so far in this step. */
struct wound {
    struct lanes_exact sum;
    int64_t n_terms; /* a lane, in the sum */
    int64_t n_overflow;
};

/* Brings what is summed in lanes to the total, before it fills up. */
static void wound_merge(struct wound *wound, struct exact_sum *total)
{
    lanes_exact_merge(&wound->sum, wound->n_terms, total);
    total->overflow += wound->n_overflow;
    wound->n_terms = wound->n_overflow = 0;
}

/* Counts what pairs took up; a pair that a cut divides is counted by the owner of its first. */
LANES_INLINE void block_wind(const struct pair_kernel_work *work, int k, lanes taken,
                             struct wound *wound)
{
    const lanes own = lanes_keep(lanes_below(work->first + k, work->n_owned), taken);
    const lanes_mask fits = lanes_exact_fits(own);
    lanes_mask limbs[3];

    if (lanes_any(~fits)) /* something has run away: take note of it */
        for (int l = 0; l < WIDTH; l++)
            wound->n_overflow += fits[l] == 0;
    lanes_exact_round(lanes_keep(fits, own), limbs);
    lanes_exact_add(&wound->sum, limbs);
    if (++wound->n_terms == LANES_EXACT_TERMS)
        wound_merge(wound, work->wound);
}

/* Compiled for each choice, so that what is not asked for costs nothing.  Works on a copy,
 * which the compiler knows that no row overlaps. */
LANES_INLINE void apply(struct pair_kernel_work *given, bool uniform,
                        struct contact_law_choice choice)
{
    const struct pair_kernel_work own = *given, *work = &own;
    const lanes dt = lanes_all(work->dt);
    struct contact_law_constants constants;
    struct wound wound = {.n_terms = 0};
    lanes deepest = lanes_all(0.0);

    given->overlap_max = 0.0;
    if (work->n_padded == 0)
        return;
    if (uniform)
        constants = contact_law_constants_of_one(pair_of(work, 0));
    for (int k = 0; k < work->n_padded; k += WIDTH) {
        struct block block;
        struct contact_law_result result;
        lanes history[CONTACT_LANES], first[8], second[8];

        fetch_ahead(work, k);
        block_load(&block, work, k, choice.full);
        if (!uniform)
            constants = constants_of_each(work, k, choice.full);
#pragma GCC unroll 13
        for (int h = 0; h < CONTACT_LANES; h++)
            if (contact_lane_used(h, choice.full, choice.ledger))
                history[h] = lanes_load(work->history[h] + k);
        const struct contact_law_meeting meeting = block_meeting(&block, choice.full);
        contact_law(&meeting, &constants, dt, choice, history, &result);
#pragma GCC unroll 13
        for (int h = 0; h < CONTACT_LANES; h++)
            if (contact_lane_used(h, choice.full, choice.ledger))
                lanes_store(work->history[h] + k, history[h]);
        block_rows(&block, &meeting, &result, choice, first, second);
        block_add(work, &block, first, second);
        if (choice.ledger)
            block_wind(work, k, result.wound, &wound);
        const lanes relative = meeting.overlap * meeting.inverse_radius;
        deepest = lanes_where(relative > deepest, relative, deepest);
    }
    if (choice.ledger)
        wound_merge(&wound, work->wound);
    for (int l = 0; l < WIDTH; l++)
        given->overlap_max =
            0.5 * deepest[l] > given->overlap_max ? 0.5 * deepest[l] : given->overlap_max;
}

#define APPLY(name, uniform, ...)                                                              \
    static void name(struct pair_kernel_work *work)                                            \
    {                                                                                          \
        apply(work, uniform, (struct contact_law_choice){__VA_ARGS__});                        \
    }
APPLY(apply_mixed, false, .ledger = false)
APPLY(apply_mixed_ledger, false, .ledger = true)
APPLY(apply_mixed_full, false, .full = true)
APPLY(apply_mixed_full_ledger, false, .full = true, .ledger = true)
APPLY(apply_uniform, true, .ledger = false)
APPLY(apply_uniform_ledger, true, .ledger = true)
APPLY(apply_uniform_full, true, .full = true)
APPLY(apply_uniform_full_ledger, true, .full = true, .ledger = true)

struct pair_kernel_blocks ISA_OFFER(pair_kernel_blocks)(void)
{
    return (struct pair_kernel_blocks){
        {{{apply_mixed, apply_mixed_ledger}, {apply_mixed_full, apply_mixed_full_ledger}},
         {{apply_uniform, apply_uniform_ledger},
          {apply_uniform_full, apply_uniform_full_ledger}}}};
}
