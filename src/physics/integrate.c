/*
 * See integrate.h.  The two halves of a row are vectors of four; what is spent of the
 * allowances is gathered by component, whose norm bounds the largest |v| / allowance and needs
 * no square root a sphere.
 */
#include "physics/integrate.h"

#include <math.h>

typedef double quad __attribute__((vector_size(32), may_alias));

struct spent {
    double component[2][3];
    double bad; /* stays 0.0 as long as everything is finite: x - x is NaN otherwise */
};

static inline void gather_spent(struct spent *spent, const double *v, const double inverse[2])
{
    for (int k = 0; k < 3; k++) {
        const double speed = v[k] < 0.0 ? -v[k] : v[k];
        for (int s = 0; s < 2; s++) {
            const double share = speed * inverse[s];
            spent->component[s][k] =
                share > spent->component[s][k] ? share : spent->component[s][k];
        }
    }
}

/* What mass-proportional damping takes in a step: c m v(n)^2 dt [J]. */
static inline double background_loss(const struct integrate_work *work, quad before, quad after,
                                     double inverse_mass)
{
    if (!(work->damping > 0.0))
        return 0.0;
    const quad v = 0.5 * (before + after);
    const double speed2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    return work->damping * work->dt / inverse_mass * speed2;
}

/* The two factors of v(n+1/2) = keep v(n-1/2) + push a(n) dt under mass-proportional damping c:
 * (1 - c dt/2)/(1 + c dt/2) and 1/(1 + c dt/2). (5.3) */
static inline void move_spheres(struct integrate_work *work, struct spent *spent, double keep,
                                double push, bool ledger)
{
    const double dt = work->dt;
    const quad fall = {push * dt * work->gravity[0], push * dt * work->gravity[1],
                       push * dt * work->gravity[2], 0.0};
    const quad step = {dt, dt, dt, 0.0}, velocity_only = {1.0, 1.0, 1.0, 0.0};
    const quad kept = {keep, keep, keep, 1.0}, zero = {0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i < work->n; i++) {
        quad *motion = (quad *)(void *)&work->motion[i], *spin = (quad *)(void *)&work->spin[i];
        quad *force = (quad *)(void *)&work->force[i];
        const double radius = motion[0][3], inverse_mass = spin[1][3],
                     inverse_radius = spin[0][3];
        /* Inertia of a sphere 2/5 m R^2. (5.2) */
        const double turn = push * dt * 2.5 * inverse_mass * inverse_radius * inverse_radius;
        const quad v =
            motion[1] * kept + force[0] * velocity_only * (push * dt * inverse_mass) + fall;
        const quad w = spin[1] * kept + force[1] * velocity_only * turn;
        if (ledger) {
            work->dissipated_friction[i] += force[0][3];
            work->dissipated_damping[i] +=
                force[1][3] + background_loss(work, motion[1], v, inverse_mass);
        }
        const quad x = motion[0] + v * step;
        motion[0] = x;
        motion[1] = v;
        spin[1] = w;
        spin[0] =
            w * (quad){radius, radius, radius, 0.0} + (quad){0.0, 0.0, 0.0, inverse_radius};
        force[0] = zero;
        force[1] = zero;
        const quad sum = x + v + w * velocity_only;
        spent->bad += (sum[0] - sum[0]) + (sum[1] - sum[1]) + (sum[2] - sum[2]);
        const double speed[3] = {v[0], v[1], v[2]};
        gather_spent(spent, speed, work->inverse_allowance[i]);
    }
}

void integrate_spheres(struct integrate_work *work)
{
    struct spent spent = {{{0.0}}, 0.0};
    const double half = 0.5 * work->damping * work->dt;
    const double push = 1.0 / (1.0 + half), keep = (1.0 - half) / (1.0 + half);
    if (work->ledger)
        move_spheres(work, &spent, keep, push, true);
    else
        move_spheres(work, &spent, keep, push, false);
    for (int s = 0; s < 2; s++) {
        const double *c = spent.component[s];
        work->spent[s] = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) * work->dt;
    }
    work->bad = !(spent.bad == 0.0);
}
