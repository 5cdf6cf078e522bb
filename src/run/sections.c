/* See sections.h. */
#include "run/sections.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/array.h"
#include "job/job.h"
#include "model/sphere.h"

void sections_init(struct sections *sections, const struct job *job)
{
    *sections = (struct sections){.n = job->n_sections, .list = job->sections};
    sections->counts = array_allocate((size_t)job->n_sections, sizeof *sections->counts);
    for (int s = 0; s < job->n_sections; s++) {
        const struct job_section *section = &job->sections[s];
        const struct tally_split split =
            tally_split(job, section->by, section->n_classes, section->classes);
        for (int way = 0; way < 2; way++)
            tally_init(&sections->counts[s].passed[way], &split);
    }
}

void sections_clear(struct sections *sections)
{
    for (int s = 0; s < sections->n; s++) {
        tally_clear(&sections->counts[s].passed[0]);
        tally_clear(&sections->counts[s].passed[1]);
    }
    free(sections->counts);
    free(sections->near);
    *sections = (struct sections){0};
}

/* Period along the normal; 0 where the plane is not across a periodic direction [m]. */
static double period_of(const struct job_section *section, const struct spheres *spheres)
{
    const double n[3] = {section->normal.x, section->normal.y, section->normal.z};
    double period = 0.0;
    for (int k = 0; k < 3 && spheres->periodic.any; k++)
        period = n[k] != 0.0 ? spheres->periodic.period[k] : period;
    return period;
}

/* Distance of the centre from the plane, or the nearest image of it, positive on the forward
 * side [m]. */
static double distance(const struct job_section *section, const struct spheres *spheres, int i)
{
    const struct vec3 offset = periodic_shortest(
        &spheres->periodic, vec3_sub(sphere_place(spheres, i), section->point));
    return vec3_dot(offset, section->normal);
}

/* Is the sphere about half way between a plane and its image?  There sides change without a
 * passage. */
static bool is_between(double d, double period)
{
    return period > 0.0 && !(d > -0.25 * period && d < 0.25 * period);
}

/* Where the centre, which is `past` beyond the plane along the normal, went through it, seen
 * from the plane's point; its step ended with velocity v. [m]              (8.2) */
static struct vec3 passage(const struct job_section *section, const struct spheres *spheres,
                           int i, double past)
{
    const double *v = sphere_velocity(spheres, i);
    const struct vec3 place = vec3_sub(sphere_place(spheres, i), section->point);
    const struct vec3 velocity = {v[0], v[1], v[2]};
    const double speed = vec3_dot(velocity, section->normal);
    /* Rounding may have brought it across against its velocity: then it is there already. */
    const bool went = (past > 0.0 && speed > 0.0) || (past < 0.0 && speed < 0.0);
    return periodic_shortest(&spheres->periodic,
                             went ? vec3_axpy(place, -(past / speed), velocity) : place);
}

/* Does the part of the plane that counts hold the place with this offset from its point? */
static bool holds(const struct job_section *section, struct vec3 offset)
{
    if (section->kind == JOB_SECTION_DISC)
        return vec3_dot(offset, offset) <= section->radius * section->radius;
    /* `across` may lean towards the normal: the offset does not, so its length is all that
     * must be put right. */
    const struct vec3 upwards = vec3_cross(section->normal, section->across);
    const double length = vec3_norm(upwards);
    return fabs(vec3_dot(offset, section->across)) <= 0.5 * section->size[0] * length &&
           fabs(vec3_dot(offset, upwards)) <= 0.5 * section->size[1] * length;
}

void sections_begin(const struct sections *sections, struct spheres *spheres, int i)
{
    spheres->sides[i] = 0;
    for (int s = 0; s < sections->n; s++) {
        if (distance(&sections->list[s], spheres, i) > 0.0)
            spheres->sides[i] |= (int64_t)1 << s;
    }
}

void sections_search(struct sections *sections, const struct spheres *spheres)
{
    sections->n_near = 0;
    for (int i = 0; i < spheres->n_owned; i++) {
        for (int s = 0; s < sections->n; s++) {
            const double d = distance(&sections->list[s], spheres, i);
            const double period = period_of(&sections->list[s], spheres);
            /* Twice the allowance: room for the rounding of d. */
            const double reach = 2.0 * spheres->allowance[i], size = d < 0.0 ? -d : d;
            if (size > reach && !(period > 0.0 && 0.5 * period - size <= reach))
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
        const struct job_section *section = &sections->list[s];
        const double past = distance(section, spheres, i);
        const bool forward = past > 0.0;
        if (forward == ((spheres->sides[i] & bit) != 0))
            continue;
        spheres->sides[i] ^= bit;
        if (is_between(past, period_of(section, spheres)))
            continue;
        if (section->kind == JOB_SECTION_PLANE ||
            holds(section, passage(section, spheres, i, past)))
            tally_add(&sections->counts[s].passed[forward ? 0 : 1], spheres, i);
    }
}
