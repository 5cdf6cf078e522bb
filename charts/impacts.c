/*
 * How right a single impact is for how many steps, and what the steps cost: the tables of
 * charts/README.md, of impacts that the program's own step computes (tests/verification/
 * impact.h).
 *
 *   impacts WORK OUT      tables to the folder OUT, passing files to WORK
 *
 * Each number of steps a contact, the duration of the elastic impact (1.25) over dt, is tried
 * with PHASES phases of first touch, evenly spread over a step.  Of the errors' sizes the
 * tables give the root mean square, the tenth of the phases that is least wrong and the
 * largest; of the errors, the mean.  What has no formula is compared with the same impact in
 * 20 480 steps, where the errors, of second order, are a thousandth of those in 640 steps.
 *
 * The law takes the normal velocity extrapolated to the step (1.7).  Lagged damping, which
 * takes that of half a step before, is what the law does when the velocity that it remembers is
 * the present one; a small integration of two spheres head on calls it so.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../tests/verification/impact.h"
#include "../tests/verification/verify.h"
#include "base/array.h"
#include "base/report.h"
#include "bed.h"
#include "physics/contact_law.h"
#include "run/simulation.h"

enum { PHASES = 32, PHASES_FINE = 4, STEPS_FINE = 20480, N_STEPS = 13 };

static const int steps_tried[N_STEPS] = {10,  14,  20,  28,  40,  57, 80,
                                         113, 160, 226, 320, 453, 640};

/* Two spheres of 10 mm, or one and a plane. */
static const double RADIUS = 0.01, SPEED = 1.0;
static const struct impact_solid grain = {1e9, 0.25, 2500.0};

/* ------------------------------------------------------------------------------- scatter */

/* Errors over the phases. */
struct scatter {
    double rms, low, high, bias;
};

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static struct scatter scatter_of(const double errors[PHASES])
{
    double sizes[PHASES], squares = 0.0, sum = 0.0;
    for (int p = 0; p < PHASES; p++) {
        sizes[p] = fabs(errors[p]);
        squares += errors[p] * errors[p];
        sum += errors[p];
    }
    qsort(sizes, PHASES, sizeof *sizes, compare_numbers);
    return (struct scatter){sqrt(squares / PHASES), sizes[PHASES / 10], sizes[PHASES - 1],
                            sum / PHASES};
}

static double phase_of(int p, int n)
{
    return (p + 0.5) / n;
}

/* ------------------------------------------------------------------------------- impacts */

struct law {
    const char *name, *more; /* keys of the pair but restitution and friction */
    double stiffness;        /* [N/m]; 0: Hertz */
};

/* An impact but for its step and phase. */
struct setting {
    const struct law *law;
    double restitution, friction;
    double angle; /* between velocity and normal [degrees]; 0: two spheres head on */
};

/* Of the relative speed; [N]; [s]; of the spin with which the sphere would roll on. */
enum quantity { RESTITUTION, FORCE, DURATION, SPIN, N_QUANTITIES };

static struct impact impact_of(const struct setting *setting)
{
    const double along = SPEED * tan(setting->angle * M_PI / 180.0);
    return (struct impact){.solid = {&grain, &grain},
                           .friction = setting->friction,
                           .restitution = setting->restitution,
                           .more = setting->law->more,
                           .radius = {RADIUS, setting->angle > 0.0 ? 0.0 : RADIUS},
                           .velocity = {{along, 0.0, -SPEED}}};
}

/* Of the elastic impact [s]. */
static double duration_of(const struct setting *setting)
{
    const struct impact impact = impact_of(setting);
    const double share = setting->angle > 0.0 ? 1.0 : 0.5; /* m* over m */
    if (setting->law->stiffness > 0.0)
        return M_PI * sqrt(share * impact_mass(&grain, RADIUS) / setting->law->stiffness);
    return impact_hertz(&impact).duration;
}

static void run_impact(const struct setting *setting, int steps, double phase,
                       double quantities[N_QUANTITIES])
{
    struct impact impact = impact_of(setting);
    const double rolling = 5.0 / 7.0 * impact.velocity[0].x / RADIUS;
    impact.dt = duration_of(setting) / steps;
    impact.phase = phase;
    const struct impact_result result = impact_run(&impact);
    quantities[RESTITUTION] = (result.velocity[0].z - result.velocity[1].z) / SPEED;
    quantities[FORCE] = result.force_max;
    quantities[DURATION] = result.duration;
    quantities[SPIN] = rolling > 0.0 ? result.spin[0].y / rolling : 0.0;
}

static void reference_of(const struct setting *setting, double reference[N_QUANTITIES])
{
    memset(reference, 0, N_QUANTITIES * sizeof *reference);
    for (int p = 0; p < PHASES_FINE; p++) {
        double one[N_QUANTITIES];
        run_impact(setting, STEPS_FINE, phase_of(p, PHASES_FINE), one);
        for (int q = 0; q < N_QUANTITIES; q++)
            reference[q] += one[q] / PHASES_FINE;
    }
}

/* Force and duration relative, the others, which are relative already, as differences. */
static void errors_of(const struct setting *setting, int steps,
                      const double reference[N_QUANTITIES],
                      struct scatter scatter[N_QUANTITIES])
{
    double errors[N_QUANTITIES][PHASES];
    for (int p = 0; p < PHASES; p++) {
        double one[N_QUANTITIES];
        run_impact(setting, steps, phase_of(p, PHASES), one);
        for (int q = 0; q < N_QUANTITIES; q++)
            errors[q][p] =
                (one[q] - reference[q]) / (q == FORCE || q == DURATION ? reference[q] : 1.0);
    }
    for (int q = 0; q < N_QUANTITIES; q++)
        scatter[q] = scatter_of(errors[q]);
}

/* -------------------------------------------------------------------------------- tables */

static FILE *open_table(const char *folder, const char *name)
{
    char *path = array_format("%s/%s", folder, name);
    FILE *table = fopen(path, "w");
    CHECK(table != NULL, "cannot write %s", path);
    free(path);
    return table;
}

static void write_names(FILE *table, int n, const char *const *names)
{
    for (int k = 0; k < n; k++)
        fprintf(table, ",%s_rms,%s_low,%s_high,%s_bias", names[k], names[k], names[k],
                names[k]);
    fprintf(table, "\n");
}

static void write_scatter(FILE *table, const struct scatter *scatter)
{
    fprintf(table, ",%.4g,%.4g,%.4g,%.4g", scatter->rms, scatter->low, scatter->high,
            scatter->bias);
}

static const char *const quantity_names[N_QUANTITIES] = {"restitution", "force", "duration",
                                                         "spin"};

/* Rows of one setting; `ns` is what a step of a contact costs. */
static void tabulate(FILE *table, const struct setting *setting, int n_quantities, double ns)
{
    double reference[N_QUANTITIES];
    reference_of(setting, reference);
    if (setting->angle <= 0.0)
        reference[RESTITUTION] = setting->restitution;
    for (int k = 0; k < N_STEPS; k++) {
        struct scatter scatter[N_QUANTITIES];
        errors_of(setting, steps_tried[k], reference, scatter);
        fprintf(table, "\"%s\",%g,%g,%d,%.4g", setting->law->name, setting->restitution,
                setting->angle, steps_tried[k], 1e-3 * ns * steps_tried[k]);
        for (int q = 0; q < n_quantities; q++)
            write_scatter(table, &scatter[q]);
        fprintf(table, "\n");
    }
}

/* -------------------------------------------------------------------------------- damping */

static struct material_pair pair_of(const struct setting *setting)
{
    char *sphere = verify_sphere("one", "grain", RADIUS, (struct vec3){0.0, 0.0, 0.0},
                                 (struct vec3){0.0, 0.0, 0.0}, (struct vec3){0.0, 0.0, 0.0});
    struct simulation *sim = verify_scene(
        1e-6,
        "materials:\n  grain: {density: %g, young: %g, poisson: %g}\n"
        "contact:\n  pairs:\n    - {between: [grain, grain], friction: %g, restitution: %g%s}\n"
        "spheres:\n%s",
        grain.density, grain.young, grain.poisson, setting->friction, setting->restitution,
        setting->law->more, sphere);
    const struct material_pair pair = sim->materials.pairs[0];
    verify_scene_free(sim);
    free(sphere);
    return pair;
}

/* The law alone, two spheres head on by leapfrog: the restitution that comes out. */
static double restitution_of_law(const struct setting *setting,
                                 const struct material_pair *pair, int steps, double phase,
                                 bool lagged)
{
    const double mass = impact_mass(&grain, RADIUS), dt = duration_of(setting) / steps;
    double history[CONTACT_LAW_LANES] = {0.0};
    double v = -SPEED, gap = (1.0 - phase) * SPEED * dt * -1.0; /* after the first step */
    struct contact_law_meeting meeting = {
        .normal = {0.0, 0.0, 1.0}, .inverse_radius = 2.0 / RADIUS, .inverse_mass = 2.0 / mass};
    while (gap < 0.0) {
        struct contact_law_result result;
        meeting.overlap = -gap;
        meeting.velocity[2] = v;
        if (lagged)
            history[CONTACT_LAW_VELOCITY] = v;
        contact_law_scalar(&meeting, pair, dt, (struct contact_law_choice){.ledger = false},
                           history, &result);
        v += dt * 2.0 / mass * result.normal;
        gap += dt * v;
    }
    return v / SPEED;
}

/* The law alone moves as the program's step does, so what holds for it holds for both. */
static void check_law_alone(const struct setting *setting, const struct material_pair *pair)
{
    double whole[N_QUANTITIES];
    run_impact(setting, 100, 0.25, whole);
    const double alone = restitution_of_law(setting, pair, 100, 0.25, false);
    CHECK(fabs(alone - whole[RESTITUTION]) < 1e-9, "restitution %.12g alone, %.12g in the step",
          alone, whole[RESTITUTION]);
}

static void tabulate_damping(FILE *table, const struct setting *setting)
{
    const struct material_pair pair = pair_of(setting);
    check_law_alone(setting, &pair);
    for (int lagged = 0; lagged < 2; lagged++)
        for (int k = 0; k < N_STEPS; k++) {
            double errors[PHASES];
            for (int p = 0; p < PHASES; p++)
                errors[p] = restitution_of_law(setting, &pair, steps_tried[k],
                                               phase_of(p, PHASES), lagged) -
                            setting->restitution;
            const struct scatter scatter = scatter_of(errors);
            fprintf(table, "%s,%s,%g,%d", setting->law->name,
                    lagged ? "lagged" : "extrapolated", setting->restitution, steps_tried[k]);
            write_scatter(table, &scatter);
            fprintf(table, ",%.4g\n", fabs(scatter.bias));
        }
}

/* ---------------------------------------------------------------------------------- main */

enum {
    HERTZ,
    HERTZ_BARE,
    HERTZ_ROLLING,
    HERTZ_CONSTANT,
    LINEAR,
    LINEAR_BARE,
    LINEAR_ROLLING,
    N_VARIANTS
};
/* About as stiff as Hertz' contact under a layer's weight. */
#define LINEAR_BED "friction: 0.5, restitution: 0.5, law: linear, stiffness: 2.0e+4"
static const struct bed_variant variants[N_VARIANTS] = {
    {"hertz-mindlin", "", "friction: 0.5, restitution: 0.5", ""},
    {"hertz-mindlin without ledger", "", "friction: 0.5, restitution: 0.5",
     "  ledger: false\n"},
    {"hertz-mindlin, rolling", "", "friction: 0.5, restitution: 0.5, rolling_friction: 0.1",
     ""},
    {"hertz-mindlin, rolling constant", "",
     "friction: 0.5, restitution: 0.5, rolling_friction: 0.1, rolling: constant", ""},
    {"linear", "", LINEAR_BED, ""},
    {"linear without ledger", "", LINEAR_BED, "  ledger: false\n"},
    {"linear, rolling", "", LINEAR_BED ", rolling_friction: 0.1", ""},
};

#define LINEAR_KEYS ", law: linear, stiffness: 1.0e+6"
#define ROLLING     ", rolling_friction: 0.1"
static const struct law hertz = {"hertz", "", 0.0}, linear = {"linear", LINEAR_KEYS, 1e6},
                        hertz_rolling = {"hertz rolling", ROLLING, 0.0},
                        hertz_constant = {"hertz constant", ROLLING ", rolling: constant", 0.0},
                        linear_rolling = {"linear rolling", LINEAR_KEYS ROLLING, 1e6};

static void write_costs(const char *work, const char *out, struct bed_cost *costs)
{
    bed_measure(N_VARIANTS, variants, work, costs);
    FILE *table = open_table(out, "costs.csv");
    fprintf(table, "# a settled bed of 2048 spheres; whole steps by CPU time, laws of pairs by "
                   "wall clock\nlaw,contacts,step_ns_a_contact,step_ratio,pairs_ratio\n");
    for (int v = 0; v < N_VARIANTS; v++)
        fprintf(table, "\"%s\",%d,%.1f,%.3f,%.3f\n", variants[v].name, costs[v].n_contacts,
                costs[v].step, costs[v].ratio, costs[v].ratio_pairs);
    fclose(table);
}

static void write_impacts(const char *out, const struct bed_cost *costs)
{
    static const double restitutions[] = {1.0, 0.9, 0.5, 0.3};
    static const char head[] = "law,restitution,angle_deg,steps,time_us";
    FILE *table = open_table(out, "impacts.csv");
    fprintf(table, "# two spheres head on; errors over %d phases of first touch\n%s", PHASES,
            head);
    write_names(table, SPIN, quantity_names);
    for (int k = 0; k < 4; k++)
        tabulate(table, &(struct setting){&hertz, restitutions[k], 0.0, 0.0}, SPIN,
                 costs[HERTZ].step);
    for (int k = 0; k < 3; k++)
        tabulate(table, &(struct setting){&linear, restitutions[k], 0.0, 0.0}, SPIN,
                 costs[LINEAR].step);
    fclose(table);

    static const struct {
        const struct law *law;
        double restitution, angle;
        int cost;
    } obliques[] = {
        {&hertz, 1.0, 15.0, HERTZ},
        {&hertz, 0.9, 15.0, HERTZ},
        {&hertz, 0.9, 30.0, HERTZ},
        {&hertz, 0.9, 50.0, HERTZ},
        {&hertz, 0.9, 70.0, HERTZ},
        {&linear, 1.0, 15.0, LINEAR},
        {&linear, 0.9, 15.0, LINEAR},
        {&linear, 0.9, 50.0, LINEAR},
        {&hertz_rolling, 0.9, 15.0, HERTZ_ROLLING},
        {&hertz_rolling, 0.9, 50.0, HERTZ_ROLLING},
        {&hertz_constant, 0.9, 15.0, HERTZ_CONSTANT},
        {&hertz_constant, 0.9, 50.0, HERTZ_CONSTANT},
        {&linear_rolling, 0.9, 15.0, LINEAR_ROLLING},
        {&linear_rolling, 0.9, 50.0, LINEAR_ROLLING},
    };
    table = open_table(out, "oblique.csv");
    fprintf(table,
            "# sphere on plane, friction .3, spin over that of rolling; errors over %d phases "
            "of first touch\n%s",
            PHASES, head);
    write_names(table, N_QUANTITIES, quantity_names);
    for (size_t k = 0; k < sizeof obliques / sizeof *obliques; k++) {
        const struct setting setting = {obliques[k].law, obliques[k].restitution, 0.3,
                                        obliques[k].angle};
        tabulate(table, &setting, N_QUANTITIES, costs[obliques[k].cost].step);
    }
    fclose(table);

    table = open_table(out, "damping.csv");
    fprintf(table, "# two spheres head on; the velocity of the dashpot\n"
                   "law,damping,restitution,steps");
    fprintf(table, ",restitution_rms,restitution_low,restitution_high,restitution_bias,"
                   "restitution_bias_size\n");
    for (int k = 1; k < 4; k++)
        tabulate_damping(table, &(struct setting){&hertz, restitutions[k], 0.0, 0.0});
    for (int k = 1; k < 3; k++)
        tabulate_damping(table, &(struct setting){&linear, restitutions[k], 0.0, 0.0});
    fclose(table);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "charts of impacts", "");
    CHECK(argc == 3, "usage: impacts WORK OUT");
    struct bed_cost costs[N_VARIANTS];
    write_costs(argv[1], argv[2], costs);
    write_impacts(argv[2], costs);
    verify_end();
    return 0;
}
