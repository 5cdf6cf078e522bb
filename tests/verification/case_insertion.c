/*
 * What comes in: places, sizes, materials and velocities as asked for, also where the region is
 * full; the rate; the ledger of energy with spheres that come and go (THEORY.md, section 8.1).
 *
 * Distributions are compared by Kolmogorov's statistic, the largest distance between shares
 * counted and expected, times the square root of the number: with the right distribution it
 * exceeds 1.95 once in a thousand seeds (A. Kolmogorov, Giorn. Ist. Ital. Attuari 4, 1933).
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/array.h"
#include "job/job.h"
#include "run/simulation.h"
#include "verify.h"

static const double KOLMOGOROV = 1.95;
static const char CHANCE[] = "one seed in a thousand goes beyond";

static const char MATERIALS[] =
    "materials:\n  stone: {density: 2500, young: 5.0e+7, poisson: 0.25}\n"
    "  gravel: {density: 1500, young: 5.0e+7, poisson: 0.25}\n"
    "contact:\n  pairs:\n"
    "    - {between: [stone, stone], friction: 0.4, restitution: 0.6}\n"
    "    - {between: [stone, gravel], friction: 0.4, restitution: 0.6}\n"
    "    - {between: [gravel, gravel], friction: 0.4, restitution: 0.6}\n";

/* Kolmogorov's statistic times the square root of n, of shares that are to be even. */
static double statistic(int n, double *shares)
{
    double most = 0.0;
    qsort(shares, (size_t)n, sizeof *shares, array_compare_doubles);
    for (int k = 0; k < n; k++) {
        const double above = (k + 1.0) / n - shares[k], below = shares[k] - (double)k / n;
        most = above > most ? above : most;
        most = below > most ? below : most;
    }
    return most * sqrt(n);
}

static void expect_even(const char *what, int n, double *shares)
{
    verify_row(what, "", KOLMOGOROV, statistic(n, shares), 0.0, VERIFY_AT_MOST, CHANCE);
}

/* So thin that hardly an attempt fails, at rest, so that all are where they came in. */
static void thin(void)
{
    struct simulation *sim = verify_scene(
        1e-4,
        "gravity: [0, 0, 0]\ndomain: {leavers: ignore}\n%sinsert:\n"
        "  - name: dust\n    mix: [{material: stone, share: 1}, {material: gravel, share: 3}]\n"
        "    sizes: {kind: uniform, min: 1.0e-4, max: 3.0e-4}\n"
        "    region: {kind: box, min: [-1, 2, 0], max: [0, 2.5, 0.3]}\n"
        "    velocity_spread: [1.0e-6, 2.0e-6, 0]\n    rate: {number: 1.0e+5}\n"
        "    until: {count: 4000}\n",
        MATERIALS);
    enum { N = 4000 };
    static double shares[6][N];
    int n_gravel = 0;
    verify_steps(sim, 500);
    const struct spheres *spheres = &sim->spheres;
    verify_row("spheres that came in", "", N, spheres->n_owned, 0.0, VERIFY_ABSOLUTE,
               "the rate and the number allow");
    for (int i = 0; i < spheres->n_owned && i < N; i++) {
        const double *x = sphere_position(spheres, i), *v = sphere_velocity(spheres, i);
        const double radius = sphere_radius(spheres, i);
        shares[0][i] = (x[0] + 1.0 - radius) / (1.0 - 2.0 * radius);
        shares[1][i] = (x[1] - 2.0 - radius) / (0.5 - 2.0 * radius);
        shares[2][i] = (x[2] - radius) / (0.3 - 2.0 * radius);
        shares[3][i] = (radius - 1e-4) / 2e-4;
        shares[4][i] = 0.5 * (v[0] / 1e-6 + 1.0);
        shares[5][i] = 0.5 * (v[1] / 2e-6 + 1.0);
        n_gravel += spheres->material[i] == 0; /* materials are sorted by name */
    }
    static const char *const names[6] = {"places along x",     "places along y",
                                         "places along z",     "radii",
                                         "velocities along x", "velocities along y"};
    for (int k = 0; k < 6; k++)
        expect_even(names[k], N, shares[k]);
    verify_row("share of the second material of a mix", "", 0.75, (double)n_gravel / N,
               3.3 * sqrt(0.75 * 0.25 / N), VERIFY_ABSOLUTE, CHANCE);
    verify_scene_free(sim);
}

/* A region that holds no more: large spheres wait, and keep their share of what comes in. */
static void full(void)
{
    struct simulation *sim = verify_scene(
        1e-4,
        "gravity: [0, 0, 0]\ndomain: {leavers: ignore}\n%sinsert:\n"
        "  - name: jam\n    material: stone\n"
        "    sizes: {kind: uniform, min: 0.01, max: 0.03}\n"
        "    region: {kind: cylinder, from: [0, 0, 0], to: [0, 0, 0.3], radius: 0.15}\n"
        "    velocity: [0, 0, 2]\n    rate: {number: 1.0e+5}\n    every: 64\n",
        MATERIALS);
    verify_steps(sim, 12000);
    const struct spheres *spheres = &sim->spheres;
    const int n = spheres->n_owned;
    double *shares = array_allocate((size_t)n, sizeof *shares);
    for (int i = 0; i < n; i++)
        shares[i] = (sphere_radius(spheres, i) - 0.01) / 0.02;
    verify_row("full region: share of what is asked for", "", 0.1,
               n / insertion_due(sim->insertions.list[0].asked, 1.2), 0.0, VERIFY_AT_MOST,
               "a test of a full region needs one");
    expect_even("full region: radii", n, shares);
    free(shares);
    verify_scene_free(sim);
}

/* What has come in at an instant: all that is due, and no more. */
static void rates(void)
{
    struct simulation *sim = verify_scene(
        1e-4,
        "gravity: [0, 0, 0]\ndomain: {leavers: ignore}\n%soutput: {series: {every: 6.4e-3}}\n"
        "insert:\n"
        "  - {name: number, material: stone, radius: 0.001, region: {kind: box, min: [0, 0, 0], "
        "max: [1, 1, 1]}, rate: {number: 1234.5}, start: 0.01}\n"
        "  - {name: mass, material: stone, sizes: {kind: uniform, min: 0.001, max: 0.003}, "
        "region: {kind: box, min: [2, 0, 0], max: [3, 1, 1]}, rate: {mass: 0.05}}\n"
        "  - {name: little, material: stone, radius: 0.001, region: {kind: box, min: [4, 0, 0], "
        "max: [5, 1, 1]}, rate: {mass: 0.05}, until: {mass: 1.0e-3}}\n",
        MATERIALS);
    verify_steps(sim, 64 * 50 + 1);
    const double largest = 2500.0 * 4.0 / 3.0 * 3.14159265358979 * 2.7e-8;
    verify_row("1234.5 1/s for 0.31 s", "", 382.0, verify_series(sim, "number.count_inserted"),
               0.0, VERIFY_ABSOLUTE, "what is due, rounded down");
    verify_row("0.05 kg/s for 0.32 s", "kg", 0.016 - 0.5 * largest,
               verify_series(sim, "mass.mass_inserted"), 0.5 * largest, VERIFY_ABSOLUTE,
               "less than the next sphere lacks");
    verify_row("until 0.001 kg", "kg", 95.0 * 2500.0 * 4.0 / 3.0 * 3.14159265358979 * 1e-9,
               verify_series(sim, "little.mass_inserted"), 1e-9, VERIFY_RELATIVE,
               "95 spheres of 10.5 mg fit");
    verify_scene_free(sim);
}

/* Spheres come in above, fall with drag, bounce, and are taken out at the side. */
static void ledger(void)
{
    struct simulation *sim = verify_scene(
        1e-5,
        "damping: 2\noutput: {series: {every: 1.0e-3}}\n"
        "domain: {min: [-1, -1, -1], max: [1, 1, 1], leavers: remove}\n%s"
        "spheres:\n  - {name: first, material: stone, radius: 0.01, packing: {kind: lattice, "
        "count: 9, spacing: 0.03, corner: [0, 0, 0.1], size: [0.1, 0.1]}}\n"
        "insert:\n"
        "  - {name: rain, material: gravel, sizes: {kind: uniform, min: 0.005, max: 0.01}, "
        "region: {kind: box, min: [-0.2, -0.2, 0.3], max: [0.2, 0.2, 0.5]}, "
        "velocity: [1, 0, -1], velocity_spread: [0.5, 0.5, 0.5], spin: [20, 0, 0], "
        "rate: {number: 2000}}\n"
        "remove:\n  - {name: out, region: {kind: box, min: [0.3, -1, -1], max: [1, 1, 1]}}\n"
        "bodies:\n  - {name: floor, material: stone, geometry: {kind: plane, "
        "point: [0, 0, 0], normal: [-0.1, 0, 1], extent: 0.9}}\n",
        MATERIALS);
    double worst = 0.0;
    for (int k = 0; k < 40; k++) {
        verify_steps(sim, 1000);
        const double off = fabs(verify_series(sim, "balance"));
        worst = off > worst ? off : worst;
    }
    const double turned = verify_series(sim, "dissipated_friction") +
                          verify_series(sim, "dissipated_damping") +
                          verify_series(sim, "dissipated_tangential");
    verify_row("spheres come and go: largest balance over the energy turned to heat", "", 0.0,
               worst / turned, 1e-3, VERIFY_AT_MOST,
               "of contacts: second order in the step; what comes and goes adds nothing");
    verify_row("spheres that were there or came in, less those that left", "",
               9.0 + verify_series(sim, "rain.count_inserted") -
                   verify_series(sim, "out.count_removed") -
                   verify_series(sim, "domain.count_left"),
               verify_series(sim, "n_spheres"), 0.0, VERIFY_ABSOLUTE, "none is lost");
    verify_row("spheres that were taken out", "", -10.0,
               -verify_series(sim, "out.count_removed"), 0.0, VERIFY_AT_MOST,
               "a test of removal needs some");
    verify_scene_free(sim);
}

/* A cloud in free fall: the mean velocity of what is in a region that holds all of it. */
static void content(void)
{
    struct simulation *sim = verify_scene(
        1e-4,
        "domain: {leavers: ignore}\noutput: {series: {every: 1.0e-2}}\n%s"
        "spheres:\n  - {name: cloud, material: stone, radius: 0.01, velocity: [0.5, -2, 1], "
        "packing: {kind: lattice, count: 60, spacing: 0.03, corner: [0, 0, 0], size: [0.1, 0.1]}}\n"
        "contents:\n  - {name: all, by: material, region: {kind: sphere, centre: [0, 0, 0], "
        "radius: 5}}\n",
        MATERIALS);
    verify_steps(sim, 2001);
    /* Given half a step before the start, velocities have fallen half a step longer. */
    verify_row("mean velocity of a cloud in free fall", "m/s", 1.0 - 9.81 * (0.2 + 0.5e-4),
               verify_series(sim, "all.velocity_z"), 1e-12, VERIFY_RELATIVE, "rounding");
    verify_row("the same of one material", "m/s", -2.0,
               verify_series(sim, "all.material_stone.velocity_y"), 1e-12, VERIFY_RELATIVE,
               "rounding");
    verify_row("number in the region", "", 60.0, verify_series(sim, "all.material_stone.count"),
               0.0, VERIFY_ABSOLUTE, "all");
    verify_row("mass in the region", "kg", 60.0 * 2500.0 * 4.0 / 3.0 * 3.141592653589793 * 1e-6,
               verify_series(sim, "all.mass"), 1e-12, VERIFY_RELATIVE, "rounding");
    verify_scene_free(sim);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "What comes in, and contents of regions", "(8.1), (7.1)");
    thin();
    full();
    rates();
    ledger();
    content();
    return verify_end();
}
