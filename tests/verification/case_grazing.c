/*
 * Oblique impacts at every angle never gain energy along the contact.
 *
 * On a plane what happens across the contact does not depend on what happens along it, so the
 * two energies part exactly: the first is that of a normal impact at the same phase, and the
 * second (sliding and turning) may only fall.  With two spheres the normal turns; then the
 * energy kept is compared with that of the normal impact at the same phase.
 */
#include <math.h>
#include <stdio.h>

#include "impact.h"
#include "verify.h"

enum { PHASES = 3, FIRST_ANGLE = 1, ANGLES_APART = 4 };

static const struct impact_solid stone = {7e10, 0.25, 2500.0}, steel = {2e11, 0.3, 7850.0};
/* Two spheres meet so slowly that their normal hardly turns meanwhile. */
static const double RADIUS = 0.01, SPEED = 1.0, SLOW = 0.01, DEGREE = M_PI / 180.0;

static const double frictions[] = {0.1, 0.3, 0.5, 1.0, 3.0, 10.0};
enum { N_FRICTIONS = sizeof frictions / sizeof frictions[0] };

/* Energy of motion along the plane and of turning [J]. */
static double along(const struct impact_result *result, struct vec3 v, struct vec3 w)
{
    return 0.5 * result->mass[0] * (v.x * v.x + v.y * v.y) +
           0.5 * result->inertia[0] * vec3_dot(w, w);
}

/* The laws that are swept. */
struct law {
    const char *name, *more;
    double stiffness; /* of the linear law [N/m]; 0: Hertz */
};

/* How long an undamped impact takes [s]. */
static double duration_of(const struct law *law, const struct impact *impact)
{
    if (law->stiffness == 0.0)
        return impact_hertz(impact).duration;
    double inverse = 1.0 / impact_mass(impact->solid[0], impact->radius[0]);
    if (impact->radius[1] > 0.0)
        inverse += 1.0 / impact_mass(impact->solid[1], impact->radius[1]);
    return M_PI / sqrt(law->stiffness * inverse);
}

/* What an elastic normal impact gains and loses at worst over the phase, of its energy. */
struct phase_error {
    double gain, size; /* size: of gain or loss */
};

static struct phase_error normal_error(const struct law *law, int steps)
{
    struct phase_error most = {0.0, 0.0};
    for (int k = 0; k < 20 * PHASES; k++) {
        struct impact impact = {.solid = {&stone, &stone},
                                .restitution = 1.0,
                                .more = law->more,
                                .radius = {RADIUS, 0.0},
                                .velocity = {{0.0, 0.0, -SPEED}},
                                .phase = (k + 0.5) / (20 * PHASES)};
        impact.dt = duration_of(law, &impact) / (steps + 0.3);
        const struct impact_result result = impact_run(&impact);
        const double gain = result.kinetic[1] / result.kinetic[0] - 1.0;
        most.gain = gain > most.gain ? gain : most.gain;
        most.size = fabs(gain) > most.size ? fabs(gain) : most.size;
    }
    return most;
}

/* The largest gain along a plane over what was there, of all angles, phases and three
 * spins. */
static double plane_gain(const struct law *law, double friction, double restitution, int steps)
{
    double most = -1.0;
    for (int degrees = FIRST_ANGLE; degrees < 90; degrees += ANGLES_APART) {
        const double v_n = SPEED * cos(degrees * DEGREE), v_t = SPEED * sin(degrees * DEGREE);
        for (int k = 0; k < 3 * PHASES; k++) {
            const int turns = k / PHASES - 1; /* against, none, along */
            struct impact impact = {.solid = {&stone, &stone},
                                    .friction = friction,
                                    .restitution = restitution,
                                    .more = law->more,
                                    .radius = {RADIUS, 0.0},
                                    .velocity = {{v_t, 0.0, -v_n}},
                                    .spin = {{20.0 * turns, 30.0 * turns, 0.0}},
                                    .phase = (k % PHASES + 0.5) / PHASES};
            impact.dt = duration_of(law, &impact) / (steps + 0.3); /* no whole number */
            const struct impact_result result = impact_run(&impact);
            const double gain = along(&result, result.velocity[0], result.spin[0]) /
                                    along(&result, impact.velocity[0], impact.spin[0]) -
                                1.0;
            most = gain > most ? gain : most;
        }
    }
    return most;
}

/* Two spheres of unlike materials that meet about their common centre of mass. */
struct two {
    const struct law *law;
    double restitution, ratio; /* of the second's radius to the first's */
    int steps;
};

/* Oblique by `degrees`: share of the energy gained. */
static double gain_of(const struct two *two, double friction, int degrees, double phase)
{
    struct impact impact = {.solid = {&stone, &steel},
                            .friction = friction,
                            .restitution = two->restitution,
                            .more = two->law->more,
                            .radius = {RADIUS, two->ratio * RADIUS},
                            .phase = phase};
    const double m_0 = impact_mass(&stone, impact.radius[0]),
                 m_1 = impact_mass(&steel, impact.radius[1]), part = m_1 / (m_0 + m_1);
    const struct vec3 v = {SLOW * sin(degrees * DEGREE), 0.0, -SLOW * cos(degrees * DEGREE)};
    impact.velocity[0] = vec3_scale(part, v);
    impact.velocity[1] = vec3_scale(part - 1.0, v);
    impact.dt = duration_of(two->law, &impact) / (two->steps + 0.3);
    const struct impact_result result = impact_run(&impact);
    return result.kinetic[1] / result.kinetic[0] - 1.0;
}

/* The largest gain beyond that of a normal impact of the same v_n and phase; what an impact
 * returns does not depend on its speed, so that is a share of one head on. */
static double pair_gain(const struct two *two)
{
    double most = -1.0;
    for (int k = 0; k < PHASES; k++) {
        const double phase = (k + 0.5) / PHASES;
        const double normal = gain_of(two, 0.0, 0, phase);
        for (int degrees = FIRST_ANGLE; degrees < 90; degrees += ANGLES_APART) {
            const double share = cos(degrees * DEGREE) * cos(degrees * DEGREE);
            for (int f = 0; f < N_FRICTIONS; f++) {
                const double gain = gain_of(two, frictions[f], degrees, phase) - share * normal;
                most = gain > most ? gain : most;
            }
        }
    }
    return most;
}

static void compare_pair(const struct two *two)
{
    char name[160];
    snprintf(name, sizeof name,
             "%s, unlike spheres 1:%g, e %g, %d steps a contact, mu .1 to 10: largest gain "
             "beyond the normal impact's, over all",
             two->law->name, two->ratio, two->restitution, two->steps);
    verify_row(name, "", 0.0, pair_gain(two), normal_error(two->law, two->steps).gain,
               VERIFY_AT_MOST, "what the integrator gives an elastic normal impact");
}

/* What all of the above rests on, in absolute numbers. */
static void compare_normal(const struct law *law)
{
    static const int steps[] = {20, 40, 400};
    static const double most[] = {8e-4, 1.5e-4, 6e-7};
    for (int k = 0; k < 3; k++) {
        char name[128];
        snprintf(name, sizeof name,
                 "%s, normal, elastic, %d steps a contact: largest gain or loss over the phase",
                 law->name, steps[k]);
        verify_row(name, "", most[k], normal_error(law, steps[k]).size, 0.0, VERIFY_AT_MOST,
                   "stated in THEORY.md to one digit");
    }
}

static void compare_plane(const struct law *law, double restitution, int steps)
{
    const double limit = normal_error(law, steps).gain;
    for (int f = 0; f < N_FRICTIONS; f++) {
        char name[160];
        snprintf(name, sizeof name,
                 "%s, plane, mu %g, e %g, %d steps a contact: largest gain along the contact, "
                 "over what was there",
                 law->name, frictions[f], restitution, steps);
        verify_row(name, "", 0.0, plane_gain(law, frictions[f], restitution, steps), limit,
                   VERIFY_AT_MOST, "what the integrator gives an elastic normal impact");
    }
}

int main(int argc, char **argv)
{
    static const struct law hertz = {"Hertz", NULL, 0.0};
    static const struct law soft = {"linear, k_t/k_n 2/7", ", law: linear, stiffness: 1.0e+6",
                                    1e6};
    static const struct law stiff = {
        "linear, k_t/k_n 0.8", ", law: linear, stiffness: 1.0e+6, tangential_ratio: 0.8", 1e6};
    verify_begin(argc, argv, "Grazing impacts, 1 to 89 degrees from the normal",
                 "energy; public reports of gains up to 34 % elsewhere");
    compare_plane(&hertz, 1.0, 20);
    compare_plane(&hertz, 1.0, 40);
    compare_plane(&hertz, 0.5, 40);
    compare_plane(&soft, 1.0, 40);
    compare_plane(&stiff, 1.0, 40);
    compare_plane(&stiff, 0.5, 40);
    for (int l = 0; l < 2; l++) {
        for (int k = 0; k < 4; k++)
            compare_pair(&(struct two){.law = l == 0 ? &hertz : &soft,
                                       .restitution = k % 2 == 0 ? 1.0 : 0.5,
                                       .ratio = k < 2 ? 1.0 : 20.0,
                                       .steps = 40});
    }
    verify_source("leapfrog that meets Hertz's spring within a step, THEORY.md, section 1.2");
    compare_normal(&hertz);
    return verify_end();
}
