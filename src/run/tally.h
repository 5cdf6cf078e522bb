/*
 * Tallies: number and mass of spheres, in all and, where asked, of each material and each size
 * class.
 *
 * Shares of ranks are exact sums, so totals do not depend on who owned what.  Part 0 is the
 * total; parts of materials follow in the order of the job, then parts of size classes from the
 * smallest.  In tables part 0 of `outlet` has columns like outlet.count, the others
 * outlet.material_ore.count and outlet.class_1.count.
 */
#ifndef TREMIE_RUN_TALLY_H
#define TREMIE_RUN_TALLY_H

#include "base/exact_sum.h"

struct comm;
struct job;
struct series;
struct spheres;

/* What is told apart. */
struct tally_split {
    int n_materials;      /* 0: not by material */
    int n_classes;        /* 0: not by size; else one more than bounds */
    const double *bounds; /* radii, ascending [m] */
};

struct tally {
    struct tally_split split;
    int n_parts;
    struct exact_sum *number, *mass; /* [-], [kg]; one a part */
};

/* Splits as the job says: `by` is a set of enum job_split. */
struct tally_split tally_split(const struct job *job, int by, int n_bounds,
                               const double *bounds);
void tally_init(struct tally *tally, const struct tally_split *split);
void tally_clear(struct tally *tally);
/* Counts sphere i.  Local. */
void tally_add(struct tally *tally, const struct spheres *spheres, int i);
/* Counts a sphere that is known by these.  Local. */
void tally_add_one(struct tally *tally, int material, double radius, double mass);

/* Words for a part: "material_ore", "class_1"; "" for part 0. */
enum { TALLY_PART_SIZE = 64 };
const char *tally_part(const struct tally_split *split, const struct job *job, int part,
                       char text[TALLY_PART_SIZE]);
/* Adds the columns OWNER.PART.count_SUFFIX and OWNER.PART.mass_SUFFIX; `what` ends their
 * descriptions, like "that passed along the normal". */
void tally_add_columns(const struct tally_split *split, const struct job *job,
                       struct series *table, const char *owner, const char *suffix,
                       const char *what);
/* Puts the totals over all ranks into row[n..] in the order of the columns; returns the new n.
 * Collective. */
int tally_totals(const struct tally *tally, const struct comm *comm, double *row, int n);

#endif
