/* See sections.h. */
#include "run/sections.h"

#include <stdlib.h>

#include "base/array.h"
#include "job/job.h"
#include "model/sphere.h"

void sections_init(struct sections *sections, const struct job *job)
{
    *sections = (struct sections){.n = job->n_sections, .list = job->sections};
    sections->counts = array_allocate((size_t)job->n_sections, sizeof *sections->counts);
}

void sections_clear(struct sections *sections)
{
    free(sections->counts);
    free(sections->near);
    *sections = (struct sections){0};
}

/* Distance of the centre from the plane, positive on the forward side [m]. */
static double distance(const struct job_section *section, const double *x)
{
    const struct vec3 offset = {x[0] - section->point.x, x[1] - section->point.y,
                                x[2] - section->point.z};
    return vec3_dot(offset, section->normal);
}

void sections_begin(const struct sections *sections, struct spheres *spheres, int i)
{
    spheres->sides[i] = 0;
    for (int s = 0; s < sections->n; s++) {
        if (distance(&sections->list[s], sphere_position(spheres, i)) > 0.0)
            spheres->sides[i] |= (int64_t)1 << s;
    }
}

void sections_search(struct sections *sections, const struct spheres *spheres)
{
    sections->n_near = 0;
    for (int i = 0; i < spheres->n_owned; i++) {
        for (int s = 0; s < sections->n; s++) {
            const double d = distance(&sections->list[s], sphere_position(spheres, i));
            /* Twice the allowance: room for the rounding of d. */
            if (d > 2.0 * spheres->allowance[i] || d < -2.0 * spheres->allowance[i])
                continue;
            ARRAY_GROW(sections->near, sections->n_near + 1, sections->near_capacity);
            sections->near[sections->n_near++] = (struct sections_near){i, s};
        }
    }
}

void sections_pass(struct sections *sections, struct spheres *spheres)
{
    for (int k = 0; k < sections->n_near; k++) {
        const int i = sections->near[k].sphere, s = sections->near[k].section;
        const int64_t bit = (int64_t)1 << s;
        const int forward = distance(&sections->list[s], sphere_position(spheres, i)) > 0.0;
        if (forward == ((spheres->sides[i] & bit) != 0))
            continue;
        spheres->sides[i] ^= bit;
        struct sections_count *count = &sections->counts[s];
        exact_sum_add(&count->number[forward ? 0 : 1], 1.0);
        exact_sum_add(&count->mass[forward ? 0 : 1], 1.0 / sphere_inverse_mass(spheres, i));
    }
}
