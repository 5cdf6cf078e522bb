/*
 * See local_damping.h.  Integration knows one damping, that of the job; the force that is added
 * here is such that it comes to the velocity that both together give by (5.3).
 */
#include "run/local_damping.h"

#include <stdlib.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "model/region.h"
#include "run/simulation.h"

void local_damping_init(struct local_damping *damping, const struct simulation *sim)
{
    const struct job *job = sim->job;
    *damping = (struct local_damping){.n = job->n_damping_regions};
    damping->regions = array_allocate((size_t)damping->n, sizeof *damping->regions);
    for (int r = 0; r < damping->n; r++) {
        char *why = NULL;
        CHECK(region_build(&damping->regions[r], &job->damping_regions[r].region, &sim->bodies,
                           &why),
              "%s", why);
    }
}

void local_damping_clear(struct local_damping *damping)
{
    for (int r = 0; r < damping->n; r++)
        region_clear(&damping->regions[r]);
    free(damping->regions);
    *damping = (struct local_damping){0, NULL};
}

/* Of all regions that hold the sphere [1/s]. */
static double damping_at(const struct simulation *sim, struct vec3 place)
{
    double sum = 0.0;
    for (int r = 0; r < sim->local_damping.n; r++)
        if (region_contains(&sim->local_damping.regions[r], place, 0.0))
            sum += sim->job->damping_regions[r].damping;
    return sum;
}

/* What the job's damping c makes of a velocity, and c and the region's together. */
struct factors {
    double keep, push;
};

static struct factors factors_of(double damping, double dt)
{
    const double half = 0.5 * damping * dt;
    return (struct factors){(1.0 - half) / (1.0 + half), 1.0 / (1.0 + half)};
}

/* Brings the pull (force over inertia, gravity in it) on a velocity to the one whose velocity
 * under `own` is that of the same pull under `all`; returns the velocity at the step. (5.6) */
static double damp(double *pull, double velocity, struct factors own, struct factors all,
                   double dt)
{
    const double after = all.keep * velocity + all.push * dt * *pull;
    *pull = (after - own.keep * velocity) / (own.push * dt);
    return 0.5 * (velocity + after);
}

static void damp_sphere(struct simulation *sim, int i, double damping)
{
    const struct spheres *spheres = &sim->spheres;
    const double g[3] = {sim->gravity.x, sim->gravity.y, sim->gravity.z};
    const double *motion = spheres->motion[i].lane, *spin = spheres->spin[i].lane;
    double *force = spheres->force[i].lane;
    const double inverse_mass = spin[7], radius = sphere_radius(spheres, i);
    const double inverse_inertia = 2.5 * inverse_mass * spin[3] * spin[3];
    const struct factors own = factors_of(sim->job->damping, sim->dt),
                         all = factors_of(sim->job->damping + damping, sim->dt);
    double speed2 = 0.0, spin2 = 0.0;
    for (int k = 0; k < 3; k++) {
        double pull = force[k] * inverse_mass + g[k], twist = force[4 + k] * inverse_inertia;
        const double v = damp(&pull, motion[4 + k], own, all, sim->dt);
        const double w = damp(&twist, spin[4 + k], own, all, sim->dt);
        force[k] = (pull - g[k]) / inverse_mass;
        force[4 + k] = twist / inverse_inertia;
        speed2 += v * v;
        spin2 += w * w;
    }
    if (sim->job->energy_ledger)
        force[7] += damping * sim->dt / inverse_mass * (speed2 + 0.4 * radius * radius * spin2);
}

void local_damping_apply(struct simulation *sim)
{
    for (int i = 0; sim->local_damping.n > 0 && i < sim->spheres.n_owned; i++) {
        const double damping = damping_at(sim, sphere_place(&sim->spheres, i));
        if (damping > 0.0)
            damp_sphere(sim, i, damping);
    }
}
