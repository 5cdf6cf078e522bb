/* See impact.h. */
#include "impact.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/report.h"
#include "run/simulation.h"
#include "run/step.h"
#include "verify.h"

enum { STEPS_BEFORE = 3, STEPS_MOST = 10000000 };

const struct impact_solid impact_rigid = {1e15, 0.3, 7850.0};

/* Materials and all pairs of them: as far as the job knows, spheres of one kind may meet. */
static char *describe(const struct impact *impact)
{
    static const char *const names[2] = {"first", "second"};
    const int n = impact->solid[0] == impact->solid[1] ? 1 : 2;
    char *text = array_string("materials:\n"), *longer;
    for (int m = 0; m < n; m++) {
        const struct impact_solid *solid = impact->solid[m];
        longer = array_format("%s  %s: {density: %.17g, young: %.17g, poisson: %.17g}\n", text,
                              names[m], solid->density, solid->young, solid->poisson);
        free(text);
        text = longer;
    }
    longer = array_format(
        "%scontact:\n  pairs:\n"
        "    - {between: [first, %s], friction: %.17g, restitution: %.17g%s}\n%s",
        text, names[n - 1], impact->friction, impact->restitution,
        impact->more != NULL ? impact->more : "",
        n == 1 ? ""
               : "    - {between: [first, first], friction: 0, restitution: 1}\n"
                 "    - {between: [second, second], friction: 0, restitution: 1}\n");
    free(text);
    return longer;
}

static struct simulation *build(const struct impact *impact, double *touch)
{
    const bool pair = impact->radius[1] > 0.0;
    const char *other = impact->solid[0] == impact->solid[1] ? "first" : "second";
    const double approach = impact->velocity[1].z - impact->velocity[0].z;
    CHECK(approach > 0.0, "surfaces do not approach");
    *touch = (STEPS_BEFORE + impact->phase) * impact->dt;
    const struct vec3 meet = {0.0, 0.0, impact->radius[0] + impact->radius[1]};
    char *first = verify_sphere("upper", "first", impact->radius[0],
                                vec3_axpy(meet, -*touch, impact->velocity[0]),
                                impact->velocity[0], impact->spin[0]);
    const struct vec3 back = vec3_scale(-*touch, impact->velocity[1]);
    char *second = pair ? verify_sphere("lower", other, impact->radius[1], back,
                                        impact->velocity[1], impact->spin[1])
                        : array_format("bodies:\n  - {name: plane, material: %s, geometry: "
                                       "{kind: plane, point: [0, 0, 0], normal: [0, 0, 1], "
                                       "extent: %.17g}}\n",
                                       other, 1e3 * impact->radius[0]);
    char *rest = describe(impact);
    struct simulation *sim =
        verify_scene(impact->dt,
                     "gravity: [0, 0, 0]\ndomain: {leavers: ignore}\nwatch: {overlap: 1}\n"
                     "output: {series: {every: 1.0e+9}}\n%sspheres:\n%s%s",
                     rest, first, second);
    free(rest);
    free(first);
    free(second);
    return sim;
}

static double overlap_now(const struct simulation *sim, bool pair, const double radius[2])
{
    const struct vec3 x = verify_position(sim, 0);
    if (!pair)
        return radius[0] - x.z;
    return radius[0] + radius[1] - vec3_norm(vec3_sub(x, verify_position(sim, 1)));
}

/* The top of the parabola through three values at equal distances. */
static double parabola_top(const double y[3])
{
    const double slope = 0.5 * (y[2] - y[0]), curve = y[2] - 2.0 * y[1] + y[0];
    return curve < 0.0 ? y[1] - 0.5 * slope * slope / curve : y[1];
}

/* The largest value so far, as the top of the parabola around it. */
struct top {
    double last[3], most;
};

static void top_add(struct top *top, double value)
{
    top->last[0] = top->last[1];
    top->last[1] = top->last[2];
    top->last[2] = value;
    if (top->last[1] >= top->last[0] && top->last[1] >= top->last[2] && top->last[1] > 0.0) {
        const double here = parabola_top(top->last);
        top->most = here > top->most ? here : top->most;
    }
}

static double kinetic(const struct impact_result *result, const struct vec3 *velocity,
                      const struct vec3 *spin, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += 0.5 * result->mass[i] * vec3_dot(velocity[i], velocity[i]) +
               0.5 * result->inertia[i] * vec3_dot(spin[i], spin[i]);
    return sum;
}

/* Steps through the impact: sizes and times. */
static void follow(const struct impact *impact, struct simulation *sim, double touch,
                   struct impact_result *result)
{
    const bool pair = impact->radius[1] > 0.0;
    struct top overlap = {{0.0}, 0.0}, force = {{0.0}, 0.0};
    double before = overlap_now(sim, pair, impact->radius), v_z = impact->velocity[0].z;
    bool touched = false;
    for (int k = 0; k < STEPS_MOST; k++) {
        verify_steps(sim, 1);
        const double now = overlap_now(sim, pair, impact->radius);
        const double v_now = verify_velocity(sim, 0).z;
        const double push = result->mass[0] * (v_now - v_z) / impact->dt; /* at `before` */
        top_add(&overlap, now);
        top_add(&force, push);
        if (push > 0.0)
            result->pushed = k * impact->dt - touch;
        touched = touched || now > 0.0;
        result->steps += now > 0.0;
        if (touched && before > 0.0 && now <= 0.0) {
            result->duration = (k + before / (before - now)) * impact->dt - touch;
            break;
        }
        before = now;
        v_z = v_now;
    }
    result->overlap_max = overlap.most;
    result->force_max = force.most;
}

struct impact_result impact_run(const struct impact *impact)
{
    const int n = impact->radius[1] > 0.0 ? 2 : 1;
    double touch;
    struct simulation *sim = build(impact, &touch);
    struct impact_result result = {.steps = 0};
    for (int i = 0; i < n; i++) {
        result.mass[i] = verify_mass(sim, i);
        result.inertia[i] = 0.4 * result.mass[i] * impact->radius[i] * impact->radius[i];
    }
    result.kinetic[0] = kinetic(&result, impact->velocity, impact->spin, n);
    follow(impact, sim, touch, &result);
    /* One more, in which the ledger books what the contact held; then a sample. */
    verify_steps(sim, 1);
    for (int i = 0; i < n; i++) {
        result.velocity[i] = verify_velocity(sim, i);
        result.spin[i] = verify_spin(sim, i);
    }
    result.kinetic[1] = kinetic(&result, result.velocity, result.spin, n);
    sim->sample_every = 1;
    step_forces(sim);
    result.balance = verify_series(sim, "balance") / result.kinetic[0];
    verify_scene_free(sim);
    return result;
}

double impact_modulus(const struct impact_solid *a, const struct impact_solid *b)
{
    return 1.0 / ((1.0 - a->poisson * a->poisson) / a->young +
                  (1.0 - b->poisson * b->poisson) / b->young);
}

double impact_mass(const struct impact_solid *solid, double radius)
{
    return solid->density * 4.0 / 3.0 * M_PI * radius * radius * radius;
}

struct impact_hertz impact_hertz(const struct impact *impact)
{
    const double modulus = impact_modulus(impact->solid[0], impact->solid[1]);
    const double speed = impact->velocity[1].z - impact->velocity[0].z;
    double radius = impact->radius[0], mass = impact_mass(impact->solid[0], radius);
    if (impact->radius[1] > 0.0) {
        radius = 1.0 / (1.0 / radius + 1.0 / impact->radius[1]);
        mass = 1.0 / (1.0 / mass + 1.0 / impact_mass(impact->solid[1], impact->radius[1]));
    }
    struct impact_hertz hertz;
    hertz.overlap = pow(15.0 * mass * speed * speed / (16.0 * modulus * sqrt(radius)), 0.4);
    hertz.force = 4.0 / 3.0 * modulus * sqrt(radius) * pow(hertz.overlap, 1.5);
    hertz.duration = 0.8 * sqrt(M_PI) * tgamma(0.4) / tgamma(0.9) * hertz.overlap / speed;
    return hertz;
}
