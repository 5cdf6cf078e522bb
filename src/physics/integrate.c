/*
 * See integrate.h.  Rows are worked on as pairs of lanes, which every x86-64 has.  What is
 * spent of the allowances is gathered by component, whose norm bounds the largest |v| /
 * allowance and needs no square root a sphere.
 */
#include "physics/integrate.h"

#include <math.h>
#include <stdint.h>

typedef double two __attribute__((vector_size(16), may_alias));
typedef int64_t two_bits __attribute__((vector_size(16), may_alias));

/* Running maxima of |v| / allowance: x and y, and z (in lane 0), for both lists. */
struct spent {
    two xy[2], z[2];
    two bad; /* stays 0.0 as long as everything is finite: 0 x is NaN otherwise */
};

static inline two absolute(two a)
{
    return (two)((two_bits)a & INT64_MAX);
}

static inline two larger(two a, two b)
{
    const two_bits first = a > b;
    return (two)(((two_bits)a & first) | ((two_bits)b & ~first));
}

static inline void gather_spent(struct spent *spent, two v_xy, two v_z, const double inverse[2])
{
    const two speed_xy = absolute(v_xy), speed_z = absolute(v_z);
    for (int s = 0; s < 2; s++) {
        spent->xy[s] = larger(speed_xy * inverse[s], spent->xy[s]);
        spent->z[s] = larger(speed_z * inverse[s], spent->z[s]);
    }
}

/* What mass-proportional damping takes in a step: c (m v(n)^2 + 2/5 m R^2 w(n)^2) dt [J]. */
static double background_loss(const struct integrate_work *work, const double before[6],
                              const double after[6], double inverse_mass, double radius)
{
    double speed2 = 0.0, spin2 = 0.0;
    for (int k = 0; k < 3; k++) {
        const double v = 0.5 * (before[k] + after[k]), w = 0.5 * (before[3 + k] + after[3 + k]);
        speed2 += v * v;
        spin2 += w * w;
    }
    return work->damping * work->dt / inverse_mass * (speed2 + 0.4 * radius * radius * spin2);
}

/* The two factors of v(n+1/2) = keep v(n-1/2) + push a(n) dt under mass-proportional damping c:
 * (1 - c dt/2)/(1 + c dt/2) and 1/(1 + c dt/2); the same for w.
 * (5.3) */
static inline __attribute__((always_inline)) void move_spheres(struct integrate_work *work,
                                                               struct spent *spent, double keep,
                                                               double push, bool ledger,
                                                               bool damped, bool periodic)
{
    const double dt = work->dt, kick = push * dt;
    const two fall_xy = {kick * work->gravity[0], kick * work->gravity[1]},
              fall_z = {kick * work->gravity[2], 0.0};
    const two first = {1.0, 0.0}, keep_z = {keep, 1.0}, step_z = {dt, 0.0}, zero = {0.0, 0.0};
    const two snap_xy = {work->snap[0], work->snap[1]}, snap_z = {work->snap[2], 0.0};
    for (int i = 0; i < work->n; i++) {
        two *motion = (two *)(void *)&work->motion[i], *spin = (two *)(void *)&work->spin[i];
        two *force = (two *)(void *)&work->force[i];
        const double radius = motion[1][1], inverse_mass = spin[3][1],
                     inverse_radius = spin[1][1];
        const double gain = kick * inverse_mass;
        /* Inertia of a sphere 2/5 m R^2.
         * (5.2) */
        const double turn = kick * 2.5 * inverse_mass * inverse_radius * inverse_radius;
        const two v_xy = motion[2] * keep + force[0] * gain + fall_xy;
        const two v_z = motion[3] * keep_z + force[1] * (first * gain) + fall_z;
        const two w_xy = spin[2] * keep + force[2] * turn;
        const two w_z = spin[3] * keep_z + force[3] * (first * turn);
        if (ledger) {
            work->dissipated_friction[i] += force[1][1];
            work->dissipated_damping[i] += force[3][1];
        }
        if (ledger && damped) {
            const double before[6] = {motion[2][0], motion[2][1], motion[3][0],
                                      spin[2][0],   spin[2][1],   spin[3][0]};
            const double after[6] = {v_xy[0], v_xy[1], v_z[0], w_xy[0], w_xy[1], w_z[0]};
            work->dissipated_damping[i] +=
                background_loss(work, before, after, inverse_mass, radius);
        }
        two d_xy = v_xy * dt, d_z = v_z * step_z;
        if (periodic) { /* (5.5) */
            d_xy = (d_xy + snap_xy) - snap_xy;
            d_z = (d_z + snap_z) - snap_z;
        }
        const two x_xy = motion[0] + d_xy, x_z = motion[1] + d_z;
        motion[0] = x_xy;
        motion[1] = x_z;
        motion[2] = v_xy;
        motion[3] = v_z;
        spin[0] = w_xy * radius;
        spin[1] = w_z * (first * radius) + (two){0.0, inverse_radius};
        spin[2] = w_xy;
        spin[3] = w_z;
        force[0] = zero;
        force[1] = zero;
        force[2] = zero;
        force[3] = zero;
        const two sum = (x_xy + v_xy) + (w_xy + x_z) + (v_z + w_z);
        spent->bad += sum * 0.0;
        gather_spent(spent, v_xy, v_z, work->inverse_allowance[i]);
    }
}

void integrate_spheres(struct integrate_work *work)
{
    struct spent spent = {{{0.0}}, {{0.0}}, {0.0}};
    const double half = 0.5 * work->damping * work->dt;
    const double push = 1.0 / (1.0 + half), keep = (1.0 - half) / (1.0 + half);
    const bool damped = work->damping > 0.0;
    if (work->periodic)
        move_spheres(work, &spent, keep, push, work->ledger, damped, true);
    else if (work->ledger && damped)
        move_spheres(work, &spent, keep, push, true, true, false);
    else if (work->ledger)
        move_spheres(work, &spent, keep, push, true, false, false);
    else
        move_spheres(work, &spent, keep, push, false, false, false);
    for (int s = 0; s < 2; s++) {
        const double c[3] = {spent.xy[s][0], spent.xy[s][1], spent.z[s][0]};
        work->spent[s] = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) * work->dt;
    }
    work->bad = !(spent.bad[0] == 0.0 && spent.bad[1] == 0.0);
}
