/* See limits.h. */
#include "run/limits.h"

#include <math.h>
#include <stddef.h>

#include "base/elementary.h"
#include "job/job.h"
#include "model/gravity.h"
#include "model/material.h"
#include "model/packing.h"
#include "physics/critical_step.h"

/* Share of the springs' critical step that the automatic step may take. */
static const double SPRINGS_SHARE = 0.8;
/* Overlap over radius at which springs are taken at most: deeper, a run would be stopped. */
static const double OVERLAP_MOST = 0.1;
/* Partners of a sphere in the densest packing of equal spheres. */
enum { PARTNERS = 12 };

struct limits limits_nothing(double speed)
{
    return (struct limits){.rayleigh = 1e300,
                           .springs = 1e300,
                           .speed = speed,
                           .shortest = {1e300, NULL},
                           .longest = {0.0, NULL}};
}

/* The sphere amid partners of its own size, across this pair of materials. */
static void add_partner(struct limits *limits, const struct material_pair *pair,
                        const char *partner, double mass, double radius)
{
    double overlap =
        critical_step_impact_overlap(pair, 0.5 * mass, 2.0 / radius, limits->speed);
    limits->overlap = overlap > limits->overlap * radius ? overlap / radius : limits->overlap;
    const double duration =
        critical_step_duration(pair, 0.5 * mass, 2.0 / radius, limits->speed);
    if (!(overlap <= OVERLAP_MOST * radius))
        overlap = OVERLAP_MOST * radius;
    const struct critical_step_contact contact = critical_step_contact(
        pair, pair->linear > 0.0 ? 1.0 : sqrt(0.5 * radius * overlap), 0.5 * mass);
    const double springs = critical_step_amid(&contact, 1.0 / mass, PARTNERS);
    limits->springs = springs < limits->springs ? springs : limits->springs;
    if (duration < limits->shortest.duration)
        limits->shortest = (struct limits_impact){duration, partner};
    if (duration > limits->longest.duration)
        limits->longest = (struct limits_impact){duration, partner};
}

void limits_add(struct limits *limits, const struct job *job, const struct materials *materials,
                const struct packing_sphere *sphere)
{
    const struct job_material *m = &job->materials[sphere->material];
    const double radius = sphere->radius;
    const double mass =
        m->density * 4.0 / 3.0 * 3.14159265358979323846 * radius * radius * radius;
    const double rayleigh = critical_step_rayleigh(radius, m->density, m->young, m->poisson);
    limits->rayleigh = rayleigh < limits->rayleigh ? rayleigh : limits->rayleigh;
    for (int b = 0; b < materials->n; b++) {
        const struct material_pair *pair =
            &materials->pairs[sphere->material * materials->n + b];
        if (pair->normal > 0.0)
            add_partner(limits, pair, job->materials[b].name, mass, radius);
    }
}

double limits_fall_speed(const struct job *job)
{
    struct vec3 g = job->gravity;
    const double most = gravity_most(job);
    if (gravity_varies(job)) /* in whatever direction */
        g = (struct vec3){most, most, most};
    const struct vec3 size = vec3_sub(job->domain.max, job->domain.min);
    const double along = fabs(g.x) * size.x + fabs(g.y) * size.y + fabs(g.z) * size.z;
    return along > 0.0 ? sqrt(along) : 1.0;
}

double limits_step(const struct limits *limits, double safety)
{
    const double waves = safety * limits->rayleigh, springs = SPRINGS_SHARE * limits->springs;
    return critical_step_round_down(waves < springs ? waves : springs);
}

double limits_scatter(double n_steps)
{
    return 0.013 * elementary_exp(1.25 * elementary_log(20.0 / n_steps));
}
