/*
 * Materials and the constants of contact between each two of them.
 *
 * Every pair that can meet is in the job; the others keep zeros and exert no force.  The table
 * is square and symmetric, so that a kernel looks up (first, second) without asking which is
 * less.
 */
#include "model/material.h"

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "job/job.h"
#include "model/restitution.h"

static double shear_modulus(const struct job_material *material)
{
    return material->young / (2.0 * (1.0 + material->poisson)); /* [Pa] */
}

/* (1.1), (1.2), (1.5), (1.6), (1.9), (1.12). */
static void make_hertz(struct material_pair *pair, const struct job_material *a,
                       const struct job_material *b, double beta)
{
    const double e_star = 1.0 / ((1.0 - a->poisson * a->poisson) / a->young +
                                 (1.0 - b->poisson * b->poisson) / b->young); /* [Pa] */
    const double g_star = 1.0 / ((2.0 - a->poisson) / shear_modulus(a) +
                                 (2.0 - b->poisson) / shear_modulus(b)); /* [Pa] */

    pair->normal = 4.0 / 3.0 * e_star;
    pair->tangential = 8.0 * g_star;
    pair->damping = 2.0 * sqrt(5.0 / 6.0) * beta * sqrt(2.0 * e_star);
    pair->damping_ratio = sqrt(4.0 * g_star / e_star);
}

/* (1.30) to (1.32). */
static void make_linear(struct material_pair *pair, double stiffness, double ratio, double beta)
{
    pair->linear = 1.0;
    pair->normal = stiffness;
    pair->tangential = ratio * stiffness;
    pair->damping = 2.0 * beta * sqrt(stiffness);
    pair->damping_ratio = sqrt(ratio);
}

static struct material_pair pair_of(const struct job *job, const struct job_pair *asked)
{
    const enum job_law law = asked->law == JOB_LAW_DEFAULT ? job->law : asked->law;
    const double stiffness = asked->stiffness > 0.0 ? asked->stiffness : job->stiffness;
    const bool yields = asked->static_friction >= 0.0; /* to less than what set it moving */
    const double beta = restitution_damping(asked->restitution);
    struct material_pair pair = {
        .friction = asked->friction,
        .static_friction = yields ? asked->static_friction : asked->friction,
        .rolling = asked->rolling_friction,
        .twisting = asked->twisting_friction,
        .constant_torque = asked->rolling == JOB_ROLLING_CONSTANT ? 1.0 : 0.0,
    };

    if (law == JOB_LAW_LINEAR)
        make_linear(&pair, stiffness, asked->tangential_ratio, beta);
    else
        make_hertz(&pair, &job->materials[asked->a], &job->materials[asked->b], beta);
    return pair;
}

struct material_pair material_touch(const struct job *job, const struct job_pair *asked)
{
    const double p = job->materials[asked->a].young, q = job->materials[asked->b].young;
    struct material_pair pair = {.friction = asked->friction,
                                 .static_friction = asked->friction};
    make_linear(&pair, p < q ? p : q, asked->tangential_ratio,
                restitution_damping(asked->restitution));
    return pair;
}

static bool is_full(const struct material_pair *pair)
{
    return pair->static_friction > pair->friction || pair->rolling > 0.0 ||
           pair->twisting > 0.0;
}

void materials_build(struct materials *materials, const struct job *job)
{
    const size_t n = (size_t)job->n_materials;

    materials->n = job->n_materials;
    materials->full = false;
    materials->density = array_allocate(n, sizeof *materials->density);
    materials->young = array_allocate(n, sizeof *materials->young);
    materials->poisson = array_allocate(n, sizeof *materials->poisson);
    materials->pairs = array_allocate(n * n, sizeof *materials->pairs);
    for (size_t i = 0; i < n; i++) {
        materials->density[i] = job->materials[i].density;
        materials->young[i] = job->materials[i].young;
        materials->poisson[i] = job->materials[i].poisson;
    }
    for (int k = 0; k < job->n_pairs; k++) {
        const struct job_pair *asked = &job->pairs[k];
        const size_t a = (size_t)asked->a, b = (size_t)asked->b;
        const struct material_pair pair = pair_of(job, asked);
        materials->pairs[a * n + b] = pair;
        materials->pairs[b * n + a] = pair;
        materials->full = materials->full || is_full(&pair);
    }
}

void materials_clear(struct materials *materials)
{
    free(materials->density);
    free(materials->young);
    free(materials->poisson);
    free(materials->pairs);
    *materials = (struct materials){0};
}
