/*
 * What is no number is noticed in the step in which it appears, on all ranks, whoever owns the
 * sphere and whichever of its numbers it is.  ranks: 1 2 3
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/comm.h"
#include "base/report.h"
#include "check.h"
#include "job/job.h"
#include "run/simulation.h"
#include "run/step.h"

static const char scene[] =
    "time: {end: 1, step: 1.0e-5}\n"
    "gravity: [0, 0, -9.81]\n"
    "materials:\n"
    "  ore: {density: 2500, young: 1.0e8, poisson: 0.2}\n"
    "contact:\n"
    "  pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.8}]\n"
    "domain: {leavers: ignore}\n"
    "spheres:\n"
    "  - {name: grid, material: ore, radius: 0.01, packing: {kind: lattice, count: 64,\n"
    "     spacing: 0.02, corner: [0, 0, 0], size: [0.08, 0.08]}}\n"
    "bodies:\n"
    "  - {name: floor, material: ore, geometry: {kind: plane, point: [0, 0, 0.0001],\n"
    "     normal: [0, 0, 1], extent: 1}}\n";

static const int64_t victims[] = {0, 21, 63};

struct plant {
    int row;     /* motion, spin or force */
    int lane;    /* of the row */
    double what; /* NaN or infinity */
};

enum { MOTION, SPIN, FORCE };

static double *place_of(struct simulation *sim, int i, const struct plant *plant)
{
    struct sphere_row *rows[] = {sim->spheres.motion, sim->spheres.spin, sim->spheres.force};
    return &rows[plant->row][i].lane[plant->lane];
}

/* Some steps, a plant in one sphere of its owner, one step. */
static enum watch_failure failure_after(const struct job *job, const struct plant *plant,
                                        int64_t victim)
{
    const struct comm comm = comm_world();
    struct simulation sim;
    simulation_create(&sim, &comm, job, ISA_AUTO);
    for (int k = 0; k < 3; k++)
        step(&sim);
    EXPECT(sim.watch.failure == WATCH_FINE);
    for (int i = 0; plant != NULL && i < sim.spheres.n_owned; i++) {
        if (sim.spheres.id[i] == victim)
            *place_of(&sim, i, plant) = plant->what;
    }
    step(&sim);
    const enum watch_failure failure = sim.watch.failure;
    simulation_destroy(&sim);
    return failure;
}

static void expect_noticed(const struct plant *plant)
{
    struct job job;
    struct mistakes mistakes;
    mistakes_init(&mistakes);
    (void)job_read_text(&job, "scene.yaml", scene, &mistakes);
    if (mistakes.n > 0)
        CHECK_FAIL("%d:%d: %s", mistakes.list[0].line, mistakes.list[0].column,
                   mistakes.list[0].text);
    EXPECT(failure_after(&job, NULL, 0) == WATCH_FINE);
    for (size_t k = 0; k < sizeof victims / sizeof *victims; k++)
        EXPECT(failure_after(&job, plant, victims[k]) == WATCH_NOT_A_NUMBER);
    mistakes_clear(&mistakes);
    job_clear(&job);
}

TEST(a_velocity_that_is_no_number)
{
    expect_noticed(&(struct plant){MOTION, 5, NAN});
}

TEST(a_place_that_is_no_number)
{
    expect_noticed(&(struct plant){MOTION, 2, NAN});
}

TEST(a_spin_that_is_no_number)
{
    expect_noticed(&(struct plant){SPIN, 4, NAN});
}

TEST(a_force_without_end)
{
    expect_noticed(&(struct plant){FORCE, 0, INFINITY});
}

TEST(a_torque_that_is_no_number)
{
    expect_noticed(&(struct plant){FORCE, 6, -NAN});
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    const int status = check_run(argc, argv);
    MPI_Finalize();
    return status;
}
