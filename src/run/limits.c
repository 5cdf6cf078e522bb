/* See limits.h. */
#include "run/limits.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "base/array.h"
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
/* Partners of a sphere in a bed, each as deep as the bed can press it. */
enum { PARTNERS = 8 };

void limits_spheres_init(struct limits_spheres *spheres, const struct job *job)
{
    *spheres = (struct limits_spheres){.n_materials = job->n_materials};
    spheres->sizes = array_allocate((size_t)job->n_materials, sizeof *spheres->sizes);
}

void limits_spheres_clear(struct limits_spheres *spheres)
{
    free(spheres->sizes);
    *spheres = (struct limits_spheres){0};
}

struct limits limits_nothing(struct limits_spheres *all)
{
    return (struct limits){.rayleigh = 1e300,
                           .springs = 1e300,
                           .speed = all->speed,
                           .all = all,
                           .shortest = {1e300, NULL},
                           .longest = {0.0, NULL}};
}

/* From R* and the overlap; not beyond what a run would bear of a sphere of this radius. */
static double contact_radius(const struct material_pair *pair, double effective, double radius,
                             double overlap)
{
    if (!(overlap <= OVERLAP_MOST * radius))
        overlap = OVERLAP_MOST * radius;
    return pair->linear > 0.0 ? 1.0 : sqrt(effective * overlap);
}

/* The sphere amid partners of its own size under a column of them of this head [m2/s2], while
 * another strikes it, across this pair of materials. */
static void add_partner(struct limits *limits, const struct material_pair *pair,
                        const char *partner, double mass, double radius, double head)
{
    const double half = 0.5 * mass, curvature = 2.0 / radius; /* m*, 1/R* */
    const double impact = critical_step_impact_overlap(pair, half, curvature, limits->speed);
    const double rest =
        critical_step_rest_overlap(pair, mass * head / (2.0 * radius), curvature);
    const double duration = critical_step_duration(pair, half, curvature, limits->speed);
    const struct critical_step_contact
        pressed =
            critical_step_contact(pair, contact_radius(pair, 0.5 * radius, radius, rest), half),
        struck = critical_step_contact(pair, contact_radius(pair, 0.5 * radius, radius, impact),
                                       half);
    const struct critical_step_side side = critical_step_side(1.0 / mass, 1.0, 1.0);
    struct critical_step_sums sums = critical_step_amid(&pressed, 1.0 / mass, PARTNERS);
    critical_step_add(&sums, &struck, &side);
    const double springs = critical_step_of_sums(&sums);
    limits->overlap = impact > limits->overlap * radius ? impact / radius : limits->overlap;
    limits->springs = springs < limits->springs ? springs : limits->springs;
    if (duration < limits->shortest.duration)
        limits->shortest = (struct limits_impact){duration, partner};
    if (duration > limits->longest.duration)
        limits->longest = (struct limits_impact){duration, partner};
}

static double mass_of(const struct job_material *material, double radius)
{
    return material->density * 4.0 / 3.0 * 3.14159265358979323846 * radius * radius * radius;
}

static void note_size(struct limits_sizes *sizes, double radius)
{
    sizes->least = sizes->most > 0.0 && sizes->least < radius ? sizes->least : radius;
    sizes->most = radius > sizes->most ? radius : sizes->most;
}

void limits_add(struct limits *limits, const struct job *job, const struct materials *materials,
                const struct packing_sphere *sphere)
{
    const struct job_material *m = &job->materials[sphere->material];
    const double radius = sphere->radius;
    const double mass = mass_of(m, radius);
    const double rayleigh = critical_step_rayleigh(radius, m->density, m->young, m->poisson);
    const double fall = limits_fall_speed(job);
    note_size(&limits->all->sizes[sphere->material], radius);
    limits->rayleigh = rayleigh < limits->rayleigh ? rayleigh : limits->rayleigh;
    for (int b = 0; b < materials->n; b++) {
        const struct material_pair *pair =
            &materials->pairs[sphere->material * materials->n + b];
        if (pair->normal > 0.0)
            add_partner(limits, pair, job->materials[b].name, mass, radius, fall * fall);
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

struct limits_strike limits_strike(const struct limits_spheres *spheres, const struct job *job,
                                   const struct material_pair *pair, int material,
                                   double radius)
{
    const double mass = mass_of(&job->materials[material], radius), g = gravity_most(job);
    const double fall = limits_fall_speed(job), curvature = 1.0 / radius;
    const double column = mass * fall * fall / (2.0 * radius), all = spheres->mass * g;
    const double weight = all < column ? all : column; /* [N] */
    struct limits_strike strike = {.material = material, .radius = radius, .mass = mass};
    strike.overlap = critical_step_impact_overlap(pair, mass, curvature, spheres->speed);
    const double width = pair->linear > 0.0 ? 1.0 : sqrt(radius * strike.overlap);
    strike.force = pair->normal * width * strike.overlap;
    strike.struck = contact_radius(pair, radius, radius, strike.overlap);
    if (weight > 0.0)
        strike.pressed = contact_radius(pair, radius, radius,
                                        critical_step_rest_overlap(pair, weight, curvature));
    return strike;
}

struct limits_strike limits_hardest_strike(const struct limits_spheres *spheres,
                                           const struct job *job,
                                           const struct materials *materials, int wall)
{
    struct limits_strike hardest = {.force = 0.0};
    for (int m = 0; m < spheres->n_materials; m++) {
        const struct material_pair *pair = &materials->pairs[m * materials->n + wall];
        const double radius = spheres->sizes[m].most;
        if (!(radius > 0.0 && pair->normal > 0.0))
            continue;
        const struct limits_strike strike = limits_strike(spheres, job, pair, m, radius);
        hardest = strike.force > hardest.force ? strike : hardest;
    }
    return hardest;
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
