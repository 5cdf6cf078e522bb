/* Random numbers from a seed, and clouds of spheres made with them, the same on every rank. */
#ifndef TREMIE_TESTS_RANDOM_CLOUD_H
#define TREMIE_TESTS_RANDOM_CLOUD_H

#include <stdbool.h>
#include <stdint.h>

#include "model/sphere.h"

struct cloud_random {
    uint64_t state;
};

/* Evenly from 0 up to, but not including, 1. */
static inline double cloud_unit(struct cloud_random *random)
{
    random->state = random->state * 6364136223846793005u + 1442695040888963407u;
    return (double)(random->state >> 11) * 0x1p-53;
}

static inline double cloud_between(struct cloud_random *random, double least, double most)
{
    return least + (most - least) * cloud_unit(random);
}

/* Does a sphere {x y z R} press into one of the n before it by more than a fiftieth of the
 * lesser radius? */
static inline bool cloud_is_crowded(double (*placed)[4], int n, const double *s)
{
    for (int j = 0; j < n; j++) {
        const double d[3] = {placed[j][0] - s[0], placed[j][1] - s[1], placed[j][2] - s[2]};
        const double reach =
            placed[j][3] + s[3] - 0.02 * (s[3] < placed[j][3] ? s[3] : placed[j][3]);
        if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach * reach)
            return true;
    }
    return false;
}

/* Finds a place for sphere i of a cube [-half_width, half_width]^3, with a radius between the
 * two; smaller and smaller where there is no room. */
static inline void cloud_place(struct cloud_random *random, double (*placed)[4], int i,
                               double half_width, double radius_min, double radius_max)
{
    double *s = placed[i];
    s[3] = cloud_between(random, radius_min, radius_max);
    for (int attempt = 1;; attempt++) {
        for (int k = 0; k < 3; k++)
            s[k] = cloud_between(random, s[3] - half_width, half_width - s[3]);
        if (!cloud_is_crowded(placed, i, s))
            return;
        if (attempt % 50 == 0)
            s[3] *= 0.9;
    }
}

/* Appends an owned sphere with this place; the rest is zero, or what `id` says. */
static inline int cloud_add(struct spheres *spheres, int64_t id, const double *x, double radius)
{
    const int i = spheres->n_owned++;
    spheres->n_all = spheres->n_owned;
    spheres_reserve(spheres, spheres->n_owned);
    spheres->motion[i] = (struct sphere_row){{x[0], x[1], x[2], radius, 0.0, 0.0, 0.0, radius}};
    spheres->spin[i] = (struct sphere_row){{0.0}};
    spheres->force[i] = (struct sphere_row){{0.0}};
    spheres->id[i] = id;
    spheres->order_cell[i] = id * 7919 % 23;
    spheres->material[i] = 0;
    spheres->group[i] = (int32_t)(id % 3);
    spheres->sides[i] = id % 5;
    spheres->dissipated_friction[i] = 0.5 * (double)id;
    spheres->dissipated_damping[i] = 0.25 * (double)id;
    spheres->allowance[i] = 0.0;
    return i;
}

#endif
