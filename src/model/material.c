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
static struct material_pair pair_of(const struct job_material *a, const struct job_material *b,
                                    const struct job_pair *asked)
{
    const double e_star = 1.0 / ((1.0 - a->poisson * a->poisson) / a->young +
                                 (1.0 - b->poisson * b->poisson) / b->young); /* [Pa] */
    const double g_star = 1.0 / ((2.0 - a->poisson) / shear_modulus(a) +
                                 (2.0 - b->poisson) / shear_modulus(b)); /* [Pa] */
    const double beta = restitution_damping(asked->restitution);

    return (struct material_pair){
        .normal = 4.0 / 3.0 * e_star,
        .tangential = 8.0 * g_star,
        .damping = 2.0 * sqrt(5.0 / 6.0) * beta * sqrt(2.0 * e_star),
        .damping_ratio = sqrt(4.0 * g_star / e_star),
        .friction = asked->friction,
    };
}

void materials_build(struct materials *materials, const struct job *job)
{
    const size_t n = (size_t)job->n_materials;

    materials->n = job->n_materials;
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
        const struct material_pair pair =
            pair_of(&job->materials[a], &job->materials[b], asked);
        materials->pairs[a * n + b] = pair;
        materials->pairs[b * n + a] = pair;
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
