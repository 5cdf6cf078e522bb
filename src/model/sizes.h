/*
 * Distributions of radii: one radius, a list, or a density between two radii (THEORY.md).
 *
 * Whatever is asked for, by number or by mass, becomes one cumulative distribution by number
 * that a random number is looked up in; so the k-th radius is a function of the seed, the
 * stream and k.  Local, all of it.
 */
#ifndef TREMIE_MODEL_SIZES_H
#define TREMIE_MODEL_SIZES_H

#include <stdbool.h>
#include <stdint.h>

struct job_sizes;

/* Radii between two: their density by number goes in a straight line. */
struct sizes_cell {
    double radius, width; /* from `radius` to radius + width [m]; 0: this radius alone */
    double low, high;     /* density at either end, to any scale */
    double below;         /* share of all radii below this cell's end */
};

struct sizes {
    double min, max;    /* no radius drawn is less or greater [m] */
    double mean_volume; /* of a sphere; times the density the mean mass [m3] */
    int n;
    struct sizes_cell *cells;
};

/* `asked` without `given` is the one radius [m] alone. */
void sizes_build(struct sizes *sizes, const struct job_sizes *asked, double radius);
void sizes_clear(struct sizes *sizes);
/* The k-th radius [m]. */
double sizes_draw(const struct sizes *sizes, uint64_t seed, uint64_t stream, int64_t k);
/* The share, by number, of radii up to this one: what draws are tested against. */
double sizes_share_below(const struct sizes *sizes, double radius);

#endif
