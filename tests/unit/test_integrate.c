/* Leapfrog: the formula to the last bit, free fall, damping, rotation, what is spent of the
 * allowances, and what is noticed when something runs away. */
#include "physics/integrate.h"

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "check.h"
#include "random_cloud.h"

enum { N = 37 };

static struct cloud_random dice = {9};

/* Spheres with everything random, and the work on them. */
struct scene {
    struct spheres spheres;
    struct integrate_work work;
};

static void fill_row(struct sphere_row *row, double size)
{
    for (int k = 0; k < 8; k++)
        row->lane[k] = cloud_between(&dice, -size, size);
}

static void scene_fill(struct scene *scene, double damping, bool ledger)
{
    struct spheres *spheres = &scene->spheres;
    spheres_init(spheres);
    for (int i = 0; i < N; i++) {
        const double x[3] = {cloud_between(&dice, -1.0, 1.0), cloud_between(&dice, -1.0, 1.0),
                             cloud_between(&dice, -1.0, 1.0)};
        const double radius = cloud_between(&dice, 0.01, 0.05);
        cloud_add(spheres, i, x, radius);
        double *spin = spheres->spin[i].lane;
        for (int k = 0; k < 3; k++) {
            sphere_velocity(spheres, i)[k] = cloud_between(&dice, -2.0, 2.0);
            spin[4 + k] = cloud_between(&dice, -50.0, 50.0);
            spin[k] = radius * spin[4 + k];
        }
        spin[3] = 1.0 / radius;
        spin[7] = 1.0 / (1e4 * radius * radius * radius);
        fill_row(&spheres->force[i], 10.0);
        for (int s = 0; s < 2; s++)
            spheres->inverse_allowance[i][s] = cloud_between(&dice, 10.0, 100.0);
    }
    scene->work = (struct integrate_work){
        .n = N,
        .motion = spheres->motion,
        .spin = spheres->spin,
        .force = spheres->force,
        .dissipated_friction = spheres->dissipated_friction,
        .dissipated_damping = spheres->dissipated_damping,
        .inverse_allowance = spheres->inverse_allowance,
        .dt = 1e-3,
        .gravity = {0.5, -1.5, -9.81},
        .damping = damping,
        .ledger = ledger,
    };
}

/* The scalar formula, in the order of operations that makes the bits. */
static void expect_formula(const struct scene *scene, const struct scene *before, int i)
{
    const struct integrate_work *work = &scene->work;
    const double dt = work->dt, half = 0.5 * work->damping * dt;
    const double push = 1.0 / (1.0 + half), keep = (1.0 - half) / (1.0 + half);
    const double *x = before->spheres.motion[i].lane, *s = before->spheres.spin[i].lane;
    const double *f = before->spheres.force[i].lane, radius = x[3];
    double motion[8], spin[8];
    for (int k = 0; k < 3; k++) {
        motion[4 + k] =
            x[4 + k] * keep + f[k] * (push * dt * s[7]) + push * dt * work->gravity[k];
        motion[k] = x[k] + motion[4 + k] * dt;
        spin[4 + k] = s[4 + k] * keep + f[4 + k] * (push * dt * 2.5 * s[7] * s[3] * s[3]);
        spin[k] = spin[4 + k] * radius;
    }
    motion[3] = motion[7] = radius;
    spin[3] = s[3];
    spin[7] = s[7];
    EXPECT(memcmp(motion, scene->spheres.motion[i].lane, sizeof motion) == 0);
    EXPECT(memcmp(spin, scene->spheres.spin[i].lane, sizeof spin) == 0);
}

static void step_and_compare(enum isa isa, double damping, bool ledger)
{
    struct scene scene, before;
    const uint64_t seed = dice.state;
    scene_fill(&before, damping, ledger);
    dice.state = seed;
    scene_fill(&scene, damping, ledger);
    integrate_choose(isa).apply(&scene.work);
    for (int i = 0; i < N; i++) {
        expect_formula(&scene, &before, i);
        const double *f = before.spheres.force[i].lane;
        const struct sphere_row nothing = {{0.0}};
        EXPECT(memcmp(&scene.spheres.force[i], &nothing, sizeof nothing) == 0);
        const double friction = before.spheres.dissipated_friction[i] + (ledger ? f[3] : 0.0);
        EXPECT(scene.spheres.dissipated_friction[i] == friction);
        if (damping == 0.0)
            EXPECT(scene.spheres.dissipated_damping[i] ==
                   before.spheres.dissipated_damping[i] + (ledger ? f[7] : 0.0));
    }
    EXPECT(!scene.work.bad);
    spheres_clear(&scene.spheres);
    spheres_clear(&before.spheres);
}

TEST(formula_to_the_last_bit)
{
    for (enum isa isa = ISA_GENERIC; isa < ISA_N; isa++)
        for (int choice = 0; choice < 4 && isa_runs(isa); choice++)
            step_and_compare(isa, choice & 1 ? 7.5 : 0.0, choice & 2);
}

/* One sphere, at rest half a step before the start, without forces. */
static void scene_single(struct scene *scene, double damping)
{
    scene_fill(scene, damping, true);
    scene->work.n = 1;
    memset(&scene->spheres.force[0], 0, sizeof scene->spheres.force[0]);
    for (int k = 0; k < 3; k++) {
        sphere_position(&scene->spheres, 0)[k] = 0.0;
        sphere_velocity(&scene->spheres, 0)[k] = 0.0;
    }
}

/* From v(-1/2) = 0 the leapfrog falls g dt^2 n (n + 1) / 2 in n steps. */
TEST(free_fall)
{
    struct scene scene;
    scene_single(&scene, 0.0);
    for (int n = 1; n <= 500; n++) {
        integrate_choose(ISA_AUTO).apply(&scene.work);
        const double fallen = 0.5 * 1e-6 * n * (n + 1);
        EXPECT_NEAR(sphere_position(&scene.spheres, 0)[2], -9.81 * fallen, 1e-13);
        EXPECT_NEAR(sphere_position(&scene.spheres, 0)[0], 0.5 * fallen, 1e-13);
    }
    spheres_clear(&scene.spheres);
}

/* Half a second at 2/s leaves exp(-1), to second order in the step. */
TEST(mass_proportional_damping)
{
    struct scene scene;
    scene_single(&scene, 2.0);
    const double mass = 1.0 / sphere_inverse_mass(&scene.spheres, 0),
                 radius = sphere_radius(&scene.spheres, 0);
    for (int k = 0; k < 3; k++) {
        scene.work.gravity[k] = 0.0;
        sphere_angular_velocity(&scene.spheres, 0)[k] = 0.0;
    }
    sphere_velocity(&scene.spheres, 0)[1] = 3.0;
    sphere_angular_velocity(&scene.spheres, 0)[0] = 800.0;
    const double before = scene.spheres.dissipated_damping[0];
    for (int n = 0; n < 500; n++)
        integrate_choose(ISA_AUTO).apply(&scene.work);
    const double *v = sphere_velocity(&scene.spheres, 0),
                 *w = sphere_angular_velocity(&scene.spheres, 0);
    EXPECT_NEAR(v[1] / 3.0, 0.3678794411714423, 1e-6);
    EXPECT_NEAR(w[0] / 800.0, 0.3678794411714423, 1e-6);
    const double lost = 0.5 * mass * (9.0 - v[1] * v[1]) +
                        0.2 * mass * radius * radius * (640000.0 - w[0] * w[0]);
    EXPECT_NEAR((scene.spheres.dissipated_damping[0] - before) / lost, 1.0, 1e-12);
    spheres_clear(&scene.spheres);
}

/* Torque over 2/5 m R^2. */
TEST(rotation)
{
    struct scene scene;
    scene_single(&scene, 0.0);
    const double radius = sphere_radius(&scene.spheres, 0);
    const double mass = 1.0 / sphere_inverse_mass(&scene.spheres, 0);
    double *spin = sphere_angular_velocity(&scene.spheres, 0);
    spin[0] = spin[1] = spin[2] = 0.0;
    for (int n = 0; n < 100; n++) {
        scene.spheres.force[0].lane[5] = 0.02;
        integrate_choose(ISA_AUTO).apply(&scene.work);
    }
    EXPECT_NEAR(spin[1] * 0.4 * mass * radius * radius / (0.02 * 0.1), 1.0, 1e-12);
    EXPECT(spin[0] == 0.0 && spin[2] == 0.0);
    spheres_clear(&scene.spheres);
}

/* Never less than the largest share of an allowance, and not more than sqrt 3 times it. */
TEST(spent_is_a_bound)
{
    struct scene scene;
    for (int round = 0; round < 50; round++) {
        scene_fill(&scene, 0.0, false);
        integrate_choose(ISA_AUTO).apply(&scene.work);
        double most[2] = {0.0, 0.0};
        for (int i = 0; i < N; i++) {
            const double *v = sphere_velocity(&scene.spheres, i);
            const double way = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * scene.work.dt;
            for (int s = 0; s < 2; s++) {
                const double share = way * scene.spheres.inverse_allowance[i][s];
                most[s] = share > most[s] ? share : most[s];
            }
        }
        for (int s = 0; s < 2; s++)
            EXPECT(scene.work.spent[s] > most[s] * (1.0 - 1e-14) &&
                   scene.work.spent[s] < 1.7321 * most[s]);
        spheres_clear(&scene.spheres);
    }
}

TEST(runaways_are_noticed)
{
    const double bad[3] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    for (int k = 0; k < 3; k++) {
        for (int lane = 0; lane < 7; lane += lane == 2 ? 2 : 1) {
            struct scene scene;
            scene_fill(&scene, 0.0, true);
            scene.spheres.force[N - 1 - k].lane[lane] = bad[k];
            integrate_choose(ISA_AUTO).apply(&scene.work);
            EXPECT(scene.work.bad);
            spheres_clear(&scene.spheres);
        }
    }
}

/* In periodic space motions are rounded to the quantum, so a period more or less of the place
 * is all that differs afterwards; along other directions nothing changes. */
TEST(periods_do_not_matter)
{
    const double quantum = 0x1p-50, period = 3.0 + 17.0 * quantum;
    for (int variant = 0; variant < 3; variant++) {
        struct scene scenes[3];
        const uint64_t seed = dice.state;
        for (int s = 0; s < 3; s++) {
            dice.state = seed;
            scene_fill(&scenes[s], variant == 2 ? 3.0 : 0.0, variant > 0);
            const double snap = 1.5 * 0x1p52 * quantum;
            for (int i = 0; i < N; i++) {
                double *x = sphere_position(&scenes[s].spheres, i);
                x[0] = (x[0] + snap) - snap + (s == 1 ? period : 0.0);
                x[2] = (x[2] + snap) - snap - (s == 1 ? period : 0.0);
            }
            scenes[s].work.periodic = s < 2;
            scenes[s].work.snap[0] = scenes[s].work.snap[2] = snap;
            integrate_choose(ISA_AUTO).apply(&scenes[s].work);
        }
        for (int i = 0; i < N; i++) {
            double here[8], there[8], plain[8];
            memcpy(here, scenes[0].spheres.motion[i].lane, sizeof here);
            memcpy(there, scenes[1].spheres.motion[i].lane, sizeof there);
            memcpy(plain, scenes[2].spheres.motion[i].lane, sizeof plain);
            EXPECT(here[1] == plain[1] && fabs(here[0] - plain[0]) <= 2.0 * quantum);
            there[0] -= period;
            there[2] += period;
            EXPECT(memcmp(here, there, sizeof here) == 0);
            EXPECT(memcmp(here + 3, plain + 3, 5 * sizeof *here) == 0);
            EXPECT(memcmp(&scenes[0].spheres.spin[i], &scenes[2].spheres.spin[i],
                          sizeof scenes[0].spheres.spin[i]) == 0);
            EXPECT(scenes[0].spheres.dissipated_damping[i] ==
                   scenes[2].spheres.dissipated_damping[i]);
        }
        for (int s = 0; s < 3; s++)
            spheres_clear(&scenes[s].spheres);
    }
}

TEST(nobody_at_all)
{
    struct integrate_work work = {.dt = 1e-3};
    integrate_choose(ISA_AUTO).apply(&work);
    EXPECT(work.spent[0] == 0.0 && work.spent[1] == 0.0 && !work.bad);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
