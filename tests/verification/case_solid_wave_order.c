/*
 * Waves in an elastic bar on finer and finer cells, against d'Alembert.  A smooth pulse of
 * velocity, at rest otherwise, goes both ways and comes back from the free ends: elements, time
 * step and lumped masses are of second order.  A front that jumps is not smooth: what is made
 * of it is the integral of Airy's function of (x - c t)/(h^2 c t)^(1/3), which swings on behind
 * the front and decays as a power of -3/4 of that distance, so its square integrates to the
 * order 2/3, the norm to 1/3, and the mean of its absolute value over the bar to 1/2.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../unit/solid_block.h"
#include "specimen.h"
#include "verify.h"

static const double WIDTH = 0.4; /* of the pulse, in lengths of the bar */
static const struct solid_material unit = {1.0, 1.0, 0.0, 0.0, 0.1, 0.0, 0, NULL, 0.0};

/* cos^4: three derivatives are continuous. */
static double pulse(double x)
{
    const double c = fabs(x) < 0.5 * WIDTH ? cos(M_PI * x / WIDTH) : 0.0;
    return c * c * c * c;
}

/* From the middle of a bar from 0 to 1, of c = 1, and from its images behind the ends. */
static double pulse_at(double x, double t)
{
    double sum = 0.0;
    for (int image = -1; image <= 1; image++)
        sum += 0.5 * (pulse(x - 0.5 - image - t) + pulse(x - 0.5 - image + t));
    return sum;
}

/* The end at 0 stops what comes at speed 1. */
static double front_at(double x, double t)
{
    return x < t ? 0.0 : -1.0;
}

struct error {
    double mean, norm; /* of |v - exact|, and the root of the mean of its square */
};

static struct error error_of(int cells, double until, double (*exact)(double, double),
                             bool is_held)
{
    const double h = 1.0 / cells;
    struct solid_block block;
    struct specimen specimen;
    struct error error = {0.0, 0.0};
    solid_block_build(&block, cells, 1, 1, (const double[3]){1.0, h, h}, false);
    specimen_make(&specimen, &block.mesh, &unit, 0.7);
    struct solid *solid = &specimen.solid;
    if (is_held)
        specimen_fix(&specimen, 0, 0.0, 0);
    /* Half a step before 0 it is as half a step after. */
    for (int i = 0; i < solid->n_nodes; i++)
        solid_velocity(solid, i)[0] = 1e-6 * exact(solid->reference[i][0], 0.0);
    specimen_steps(&specimen, (int64_t)(until / specimen.dt + 0.5));
    const double t = ((double)specimen.step - 0.5) * specimen.dt;
    for (int i = 0; i < solid->n_nodes; i++) {
        const double off = 1e6 * solid_velocity(solid, i)[0] - exact(solid->reference[i][0], t);
        error.mean += fabs(off) / solid->n_nodes;
        error.norm += off * off / solid->n_nodes;
    }
    error.norm = sqrt(error.norm);
    specimen_free(&specimen);
    solid_block_free(&block);
    return error;
}

static void pulse_rows(void)
{
    double before = 0.0;
    char text[128];
    for (int cells = 50; cells <= 400; cells *= 2) {
        const double now = error_of(cells, 0.8, pulse_at, false).mean;
        if (cells > 50) {
            snprintf(text, sizeof text, "a smooth pulse, %d cells: order of the error", cells);
            verify_row(text, "", 2.0, log2(before / now), 0.05, VERIFY_ABSOLUTE,
                       "the next order, of the fourth power of the cells");
        }
        before = now;
    }
    verify_row("a smooth pulse, 400 cells: mean error over its height", "", 0.0, before, 2e-4,
               VERIFY_ABSOLUTE, "(1 - .7^2) t k^3 h^2/24 of half its height, k = 2 pi/.4");
}

/* From 100 to 800 cells: what falls between nodes makes single orders scatter. */
static void front_rows(void)
{
    const struct error coarse = error_of(100, 0.5, front_at, true),
                       fine = error_of(800, 0.5, front_at, true);
    verify_source("Airy's function behind a front");
    verify_row("a front that jumps, 100 to 800 cells: order of the mean error", "", 0.5,
               log2(coarse.mean / fine.mean) / 3.0, 0.1, VERIFY_ABSOLUTE,
               "its swings fill the bar only in the limit");
    verify_row("the same: order of the root of the mean square", "", 1.0 / 3.0,
               log2(coarse.norm / fine.norm) / 3.0, 0.05, VERIFY_ABSOLUTE,
               "where the jump is between nodes");
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Solids: order of waves in a bar", "d'Alembert; second order");
    pulse_rows();
    front_rows();
    return verify_end();
}
