/*
 * Oblique impacts of two spheres of unlike materials, alike in size and 1 to 20, about their
 * common centre of mass.
 *
 * Where the contact slides throughout, momentum gives the answer: the tangential impulse is mu
 * times the normal one, m* (1 + e) v_n.  Where it sticks, the law itself is integrated here
 * once more, as the continuous equations of THEORY.md say it and by the plainest scheme, in
 * steps so small that its error does not count: overlap, its rate, the patch's speed and the
 * spring's force are all there is as long as the normal does not turn.  Spheres meet slowly, so
 * that it hardly does.
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "impact.h"
#include "verify.h"

enum { STEPS = 1000, FINE = 200000 };

static const struct impact_solid oxide = {380e9, 0.23, 4000.0}, iron = {100e9, 0.25, 7000.0};
static const double RADIUS = 2.5e-3, SPEED = 0.01, DEGREE = M_PI / 180.0;

struct meeting {
    double stiffness, stiffness_ratio; /* of the linear law [N/m], [-]; 0: Hertz */
    double size_ratio;                 /* of the second's radius to the first's */
    double friction, restitution;
    double degrees; /* from the normal */
};

/* What the contact is to the relative motion of its two sides. */
struct contact {
    double mass, radius, young, shear, damping; /* effective [kg], [m], [Pa], [Pa]; beta */
};

/* (1.23) for beta < 1, and the beta that gives e, by halves. */
static double restitution_of(double beta)
{
    return exp(-beta / sqrt(1.0 - beta * beta) * (M_PI - 2.0 * asin(beta)));
}

static double damping_for(double restitution)
{
    double low = 0.0, high = 0.999;
    for (int k = 0; k < 60; k++) {
        const double middle = 0.5 * (low + high);
        if (restitution_of(middle) > restitution)
            low = middle;
        else
            high = middle;
    }
    return restitution < 1.0 ? low : 0.0;
}

static double shear_part(const struct impact_solid *solid)
{
    return 2.0 * (2.0 - solid->poisson) * (1.0 + solid->poisson) / solid->young;
}

/* (1.1) to (1.3) */
static struct contact contact_of(const struct meeting *meeting)
{
    const double second = meeting->size_ratio * RADIUS;
    return (struct contact){
        .mass = 1.0 / (1.0 / impact_mass(&oxide, RADIUS) + 1.0 / impact_mass(&iron, second)),
        .radius = 1.0 / (1.0 / RADIUS + 1.0 / second),
        .young = impact_modulus(&oxide, &iron),
        .shear = 1.0 / (shear_part(&oxide) + shear_part(&iron)),
        .damping = damping_for(meeting->restitution)};
}

/* How long the contact lasts, were it elastic [s]. */
static double duration_of(const struct meeting *meeting, const struct impact *impact)
{
    if (meeting->stiffness > 0.0)
        return M_PI * sqrt(contact_of(meeting).mass / meeting->stiffness);
    return impact_hertz(impact).duration;
}

/* The tangential impulse over m*, of the continuous law (1.4) to (1.13), (1.30), (1.31). */
static double integrate(const struct meeting *meeting, double v_n, double v_t, double dt)
{
    const struct contact c = contact_of(meeting);
    const bool linear = meeting->stiffness > 0.0;
    double depth = 0.0, rate = v_n, patch = v_t, spring = 0.0, impulse = 0.0;
    double k_t_before = 0.0;
    while ((depth += 0.5 * dt * rate) > 0.0) {
        const double a = sqrt(c.radius * depth);
        const double k_n = linear ? meeting->stiffness : 2.0 * c.young * a;
        const double k_t = linear ? meeting->stiffness_ratio * k_n : 8.0 * c.shear * a;
        const double c_n =
            (linear ? 2.0 : 2.0 * sqrt(5.0 / 6.0)) * c.damping * sqrt(k_n * c.mass);
        const double c_t = c_n * sqrt(k_t / k_n);
        const double push = fmax((linear ? 1.0 : 2.0 / 3.0) * k_n * depth + c_n * rate, 0.0);
        if (k_t < k_t_before)
            spring *= k_t / k_t_before;
        spring += k_t * patch * dt;
        double grip = spring + c_t * patch;
        const double held = meeting->friction * push;
        if (fabs(grip) > held) {
            const double limited = copysign(held, grip);
            const double kept = spring - k_t * patch * dt;
            spring = kept + k_t * dt / (k_t * dt + c_t) * (limited - kept);
            grip = limited;
        }
        k_t_before = k_t;
        rate -= dt * push / c.mass;
        patch -= 3.5 * dt * grip / c.mass;
        impulse += dt * grip / c.mass;
        depth += 0.5 * dt * rate;
    }
    return impulse;
}

static void compare(const struct meeting *meeting)
{
    char more[128] = "", what[96], name[160];
    if (meeting->stiffness > 0.0)
        snprintf(more, sizeof more, ", law: linear, stiffness: %.17g, tangential_ratio: %.17g",
                 meeting->stiffness, meeting->stiffness_ratio);
    struct impact impact = {.solid = {&oxide, &iron},
                            .friction = meeting->friction,
                            .restitution = meeting->restitution,
                            .more = more,
                            .radius = {RADIUS, meeting->size_ratio * RADIUS},
                            .phase = 0.5};
    const double m[2] = {impact_mass(&oxide, impact.radius[0]),
                         impact_mass(&iron, impact.radius[1])};
    const double mass = contact_of(meeting).mass, angle = meeting->degrees * DEGREE;
    const double v_n = SPEED * cos(angle), v_t = SPEED * sin(angle);
    impact.velocity[0] = vec3_scale(mass / m[0], (struct vec3){v_t, 0.0, -v_n});
    impact.velocity[1] = vec3_scale(-mass / m[1], (struct vec3){v_t, 0.0, -v_n});
    const double duration = duration_of(meeting, &impact);
    impact.dt = duration / STEPS;
    const struct impact_result result = impact_run(&impact);

    const bool slides = tan(angle) > 3.5 * meeting->friction * (1.0 + meeting->restitution);
    const double impulse = slides ? meeting->friction * (1.0 + meeting->restitution) * v_n
                                  : integrate(meeting, v_n, v_t, duration / FINE);
    verify_source(slides ? "momentum, sliding throughout"
                         : "the law's equations, integrated in the case at 2e5 steps");
    /* A tangential dashpot that is late by half a step is off by some of a step over all. The
     * line of centres turns, which mixes the normal impulse into the tangential one, and the
     * lever arm is R - overlap/2; a tangential spring that swings through some 5 radians,
     * pi sqrt(3.5 k_t/k_n), is off by that much more. */
    const double late = slides || meeting->restitution == 1.0 ? 1e-5 : 1.0 / STEPS;
    const double turned = v_t * duration / (impact.radius[0] + impact.radius[1]);
    const double off =
        late +
        (slides ? 1.0 : 5.0) * (0.5 * result.overlap_max / RADIUS + turned * tan(angle)) +
        0.5 * turned * (1.0 + meeting->restitution) * v_n / impulse;
    static const char why[] =
        "leapfrog; with dashpot and spring one of 1000 steps, (1.12); the "
        "line of centres turns; the lever arm is R - overlap/2";
    snprintf(what, sizeof what, "%s, 1:%g, mu %g, e %g, %g degrees, %s",
             meeting->stiffness > 0.0 ? "linear" : "Hertz", meeting->size_ratio,
             meeting->friction, meeting->restitution, meeting->degrees,
             slides ? "slides" : "sticks");
    snprintf(name, sizeof name, "%s: tangential impulse over m* v_t", what);
    verify_row(name, "", impulse / v_t,
               1.0 - (result.velocity[0].x - result.velocity[1].x) / v_t, off, VERIFY_RELATIVE,
               why);
    for (int k = 0; k < 2; k++) {
        snprintf(name, sizeof name, "%s: spin of the %s", what, k == 0 ? "first" : "second");
        verify_row(name, "rad/s", 2.5 * mass * impulse / (m[k] * impact.radius[k]),
                   result.spin[k].y, off, VERIFY_RELATIVE, why);
    }
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Oblique impact of unlike spheres", "");
    for (int law = 0; law < 2; law++) {
        const double stiffness = law == 0 ? 0.0 : 1e7;
        for (int k = 0; k < 2; k++) {
            const double ratio = k == 0 ? 1.0 : 20.0;
            compare(&(struct meeting){stiffness, 0.7, ratio, 0.1, 0.6, 45.0});
            compare(&(struct meeting){stiffness, 0.7, ratio, 10.0, 0.6, 20.0});
            compare(&(struct meeting){stiffness, 0.7, ratio, 0.8, 1.0, 30.0});
        }
    }
    return verify_end();
}
