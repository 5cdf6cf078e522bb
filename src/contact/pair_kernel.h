/*
 * The contact law for all listed pairs of spheres: the hot loop.
 *
 * The kernel exists several times, compiled for vectors of 2, 4 and 8 lanes; one is chosen when
 * the program starts.  All give the same bits: lanes never mix, each pair's arithmetic is one
 * text (physics/contact_law.h), and contributions reach a sphere's row one by one in the order
 * of the list.
 */
#ifndef TREMIE_CONTACT_PAIR_KERNEL_H
#define TREMIE_CONTACT_PAIR_KERNEL_H

#include <stdbool.h>
#include <stdint.h>

#include "base/exact_sum.h"
#include "base/isa.h"
#include "contact/contact_set.h"
#include "model/material.h"
#include "model/sphere.h"

/* Entries of first and second that must be there and hold valid indices behind n_padded: rows
 * are fetched that far ahead. */
enum { PAIR_KERNEL_AHEAD = 128 };

/*
 * What a kernel works on.  Pairs k = 0 .. n_padded - 1, n_padded a multiple of CONTACT_PAD;
 * padding pairs the two dummies, which lie apart.  Indices reach over owned spheres, ghosts and
 * dummies, first != second, and so do all arrays that they index.
 *
 * Read: motion, spin, material, pairs.  Added to: the force rows of both spheres (force,
 * torque, and with the ledger on half of what friction and damping dissipate in spare lanes 3
 * and 7); with the ledger on the work that springs took up, of pairs whose first is owned.
 * Brought to the present: history.  Force rows must not hold -0: a pair that does not touch
 * adds zeros of either sign. A pair that touched in the last step must still be listed in this
 * one, or the ledger misses the end of the contact.
 */
struct pair_kernel_work {
    int n_padded;
    const int *first, *second;      /* in canonical order */
    double *history[CONTACT_LANES]; /* those lanes that the kernel needs */
    const struct sphere_row *motion, *spin;
    struct sphere_row *force;
    const int32_t *material; /* of each sphere */
    int n_materials;
    const struct material_pair *pairs; /* n_materials x n_materials */
    int n_owned;                       /* spheres below this */
    struct exact_sum *wound;           /* [J]; without the ledger unused */
    double dt;                         /* [s] */
    double overlap_max;                /* out: largest overlap (1/R_i + 1/R_j) / 2 [-] */
};

struct pair_kernel {
    enum isa isa;
    void (*apply)(struct pair_kernel_work *work);
};

/* The kernel for spheres all of one material (uniform) or of several; with rolling, twisting
 * and static friction (full) or without; with or without the energy ledger.  The instruction
 * set must run. */
struct pair_kernel pair_kernel_choose(enum isa isa, bool uniform, bool full, bool ledger);

#endif
