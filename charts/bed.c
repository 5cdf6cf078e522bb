/*
 * See bed.h.  One bed of 2048 spheres settles in a box under strong damping; every variant
 * starts from its places at rest and without memory, and relaxes before it is measured.  All
 * are held at once and step in turns, some hundred steps each, so that what else the machine
 * does meets all of them alike; ratios are those of neighbours in time, their median stands.
 */
#include "bed.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "../tests/verification/verify.h"
#include "base/array.h"
#include "base/report.h"
#include "run/runtime.h"
#include "run/simulation.h"
#include "run/step.h"

enum { N_SPHERES = 2048, SETTLING = 20000, RELAXING = 3000, STEPS = 200, ROUNDS = 21 };
static const double DT = 2.5e-5; /* [s], a fifth of the Rayleigh step */

static const char scene_text[] =
    "gravity: [0, 0, -9.81]\n"
    "damping: %g\n"
    "materials:\n  grain: {density: 2500, young: 1.0e+8, poisson: 0.2%s}\n"
    "contact:\n  pairs:\n    - {between: [grain, grain], %s}\n%s"
    "spheres:\n  - {name: grain, material: grain, radius: 0.005, packing: {%s}}\n"
    "bodies:\n  - {name: box, material: grain, geometry: {kind: box, open: top, "
    "min: [-0.07, -0.07, 0], max: [0.07, 0.07, 0.25]}}\n"
    "domain: {leavers: ignore}\nwatch: {step: 1000}\noutput: {series: {every: 1.0e+9}}\n";

static struct simulation *scene_of(const struct bed_variant *variant, double damping,
                                   const char *packing)
{
    return verify_scene(DT, scene_text, damping, variant->material, variant->pair,
                        variant->contact, packing);
}

static FILE *open_spheres(const char *work, const char *name, char **packing)
{
    char *path = array_format("%s/%s.csv", work, name);
    FILE *file = fopen(path, "w");
    CHECK(file != NULL, "cannot write %s", path);
    fprintf(file, "x_m,y_m,z_m\n");
    *packing = array_format("kind: csv, file: %s", path);
    free(path);
    return file;
}

/* A lattice whose places are off by up to .35 mm, or its columns would stand for ever. */
static char *loose_packing(const char *work)
{
    char *packing;
    FILE *file = open_spheres(work, "loose", &packing);
    uint32_t state = 1;
    for (int k = 0; k < N_SPHERES; k++) {
        const int place[3] = {k % 12, k / 12 % 12, k / 144};
        for (int c = 0; c < 3; c++) {
            state = state * 1664525u + 1013904223u;
            const double noise = (double)(state >> 8) / (double)(1 << 24) - 0.5;
            fprintf(file, "%s%.9f", c > 0 ? "," : "",
                    (place[c] + 0.5) * 0.0108 + 0.0007 * noise - (c < 2 ? 0.0648 : 0.0));
        }
        fprintf(file, "\n");
    }
    CHECK(fclose(file) == 0, "cannot write %s", packing);
    return packing;
}

/* The bed's places as a packing; the caller frees the YAML that names it. */
static char *settle(const struct bed_variant *variant, const char *work)
{
    char *loose = loose_packing(work), *packing;
    struct simulation *sim = scene_of(variant, 20.0, loose);
    verify_steps(sim, SETTLING);
    FILE *file = open_spheres(work, "bed", &packing);
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        const double *x = sphere_position(&sim->spheres, i);
        fprintf(file, "%.17g,%.17g,%.17g\n", x[0], x[1], x[2]);
    }
    CHECK(fclose(file) == 0, "cannot write %s", packing);
    verify_scene_free(sim);
    free(loose);
    return packing;
}

static double cpu_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double values[ROUNDS])
{
    qsort(values, ROUNDS, sizeof *values, compare_numbers);
    return values[ROUNDS / 2];
}

/* Times of a round, and the laws of pairs within them [s]. */
struct times {
    double whole[ROUNDS], pairs[ROUNDS];
};

static void measure(int n, struct simulation *const *sims, struct times *times)
{
    for (int round = 0; round < ROUNDS; round++)
        for (int v = 0; v < n; v++) {
            const double pairs = sims[v]->runtime.phase[RUNTIME_PAIRS];
            runtime_begin(&sims[v]->runtime);
            const double began = cpu_time();
            verify_steps(sims[v], STEPS);
            times[v].whole[round] = cpu_time() - began;
            times[v].pairs[round] = sims[v]->runtime.phase[RUNTIME_PAIRS] - pairs;
        }
}

static int count_contacts(struct simulation *sim)
{
    sim->sample_every = 1;
    step_forces(sim);
    return (int)(verify_series(sim, "n_contacts") + verify_series(sim, "n_facet_contacts"));
}

void bed_measure(int n, const struct bed_variant *variants, const char *work,
                 struct bed_cost *costs)
{
    struct simulation *sims[BED_VARIANTS_MAX];
    static struct times times[BED_VARIANTS_MAX];
    CHECK(n <= BED_VARIANTS_MAX, "%d variants", n);
    char *packing = settle(&variants[0], work);
    for (int v = 0; v < n; v++) {
        sims[v] = scene_of(&variants[v], 0.0, packing);
        verify_steps(sims[v], RELAXING);
    }
    measure(n, sims, times);
    const struct times first = times[0];
    for (int v = 0; v < n; v++) {
        double ratio[ROUNDS], ratio_pairs[ROUNDS];
        const int n_contacts = count_contacts(sims[v]);
        for (int round = 0; round < ROUNDS; round++) {
            ratio[round] = times[v].whole[round] / first.whole[round];
            ratio_pairs[round] = times[v].pairs[round] / first.pairs[round];
        }
        costs[v] = (struct bed_cost){.n_contacts = n_contacts,
                                     .step = 1e9 * median(times[v].whole) / STEPS / n_contacts,
                                     .ratio = median(ratio),
                                     .ratio_pairs = median(ratio_pairs)};
        verify_scene_free(sims[v]);
    }
    free(packing);
}
