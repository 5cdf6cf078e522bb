/*
 * Two hundred spheres without friction or damping fly about in a box for 1e5 steps, and for
 * the same time with half and a quarter of the step.  Energy is then constant but for the
 * integrator: each impact returns a little more or less, as the phase of its first touch has
 * it, up to 1.5e-4 at 40 steps a contact.  These errors must not pile up to one side.
 */
#include <math.h>
#include <stdio.h>

#include "run/simulation.h"
#include "verify.h"

enum { N = 200, STEPS = 100000, BLOCKS = 20, SAMPLES = 1000 };

static const double STEP = 4e-6, SPEED = 0.5, RADIUS = 0.005, SIDE = 0.08;

static struct simulation *gas(double dt)
{
    struct simulation *sim = verify_scene(
        dt,
        "gravity: [0, 0, 0]\ndomain: {leavers: ignore}\noutput: {series: {every: %.17g}}\n"
        "materials:\n  stone: {density: 2500, young: 1.0e+8, poisson: 0.25}\n"
        "contact:\n  pairs:\n    - {between: [stone, stone], friction: 0, restitution: 1}\n"
        "spheres:\n  - {name: gas, material: stone, radius: %g, packing: {kind: lattice, "
        "count: %d, spacing: 0.013, corner: [0.001, 0.001, 0.001], size: [0.0781, 0.0781]}}\n"
        "bodies:\n  - {name: box, material: stone, geometry: {kind: box, "
        "min: [0, 0, 0], max: [%g, %g, %g]}}\n",
        STEP * STEPS / SAMPLES, RADIUS, N, SIDE, SIDE, SIDE);
    uint64_t random = 11;
    for (int id = 0; id < N; id++) {
        double *v = sphere_velocity(&sim->spheres, verify_index(sim, id));
        for (int k = 0; k < 3; k++)
            v[k] = SPEED * verify_random(&random);
    }
    return sim;
}

struct record {
    double error[SAMPLES + 1]; /* of the energy, over the first [-] */
    double largest;
};

/* The energy over the same time, in n times as many steps. */
static struct record follow(int n)
{
    struct simulation *sim = gas(STEP / n);
    struct record record = {.largest = 0.0};
    double first = 0.0;
    for (int k = 0; k <= SAMPLES; k++) {
        verify_steps(sim, k == 0 ? 1 : (int64_t)n * STEPS / SAMPLES);
        const double energy =
            verify_series(sim, "kinetic_translation") + verify_series(sim, "elastic");
        first = k == 0 ? energy : first;
        record.error[k] = energy / first - 1.0;
        const double size = fabs(record.error[k]);
        record.largest = size > record.largest ? size : record.largest;
    }
    verify_scene_free(sim);
    return record;
}

/* Mean growth from block to block over its standard error. */
static double drift(const struct record *record)
{
    double sum = 0.0, squares = 0.0;
    for (int b = 0; b < BLOCKS; b++) {
        const double grown =
            record->error[(b + 1) * SAMPLES / BLOCKS] - record->error[b * SAMPLES / BLOCKS];
        sum += grown;
        squares += grown * grown;
    }
    const double mean = sum / BLOCKS;
    const double variance = (squares - BLOCKS * mean * mean) / (BLOCKS - 1);
    return mean / sqrt(variance / BLOCKS);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Gas of 200 elastic spheres in a box", "energy is constant");
    struct record records[3];
    for (int r = 0; r < 3; r++) {
        char name[96];
        records[r] = follow(1 << r);
        snprintf(name, sizeof name, "steps of %g us: largest error of the energy over all",
                 1e6 * STEP / (1 << r));
        verify_row(name, "", 0.0, records[r].largest, 1.8e-5 / pow(4.0, r), VERIFY_AT_MOST,
                   "the largest error of one impact alone: 1.5e-4 at 40 steps a contact, here "
                   "115, 230, 460, at second order");
        snprintf(name, sizeof name,
                 "steps of %g us: growth of the energy over its standard error",
                 1e6 * STEP / (1 << r));
        verify_row(name, "", 0.0, drift(&records[r]), 2.86, VERIFY_ABSOLUTE,
                   "99 % of Student's distribution with 19 degrees of freedom");
    }
    verify_row("order of the largest error in the step", "", 2.5,
               0.5 * log2(records[0].largest / records[2].largest), 0.5, VERIFY_ABSOLUTE,
               "force as overlap^1.5, met within a step: 2.5; three chaotic runs, one each");
    return verify_end();
}
