/* See tally.h. */
#include "run/tally.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/comm.h"
#include "job/job.h"
#include "model/sphere.h"
#include "store/series.h"

struct tally_split tally_split(const struct job *job, int by, int n_bounds,
                               const double *bounds)
{
    return (struct tally_split){
        .n_materials = (by & JOB_SPLIT_MATERIAL) != 0 ? job->n_materials : 0,
        .n_classes = (by & JOB_SPLIT_SIZE) != 0 ? n_bounds + 1 : 0,
        .bounds = bounds,
    };
}

static int count_parts(const struct tally_split *split)
{
    return 1 + split->n_materials + split->n_classes;
}

void tally_init(struct tally *tally, const struct tally_split *split)
{
    *tally = (struct tally){.split = *split, .n_parts = count_parts(split)};
    tally->number = array_allocate((size_t)tally->n_parts, sizeof *tally->number);
    tally->mass = array_allocate((size_t)tally->n_parts, sizeof *tally->mass);
}

void tally_clear(struct tally *tally)
{
    free(tally->number);
    free(tally->mass);
    *tally = (struct tally){0};
}

static void add_to(struct tally *tally, int part, double mass)
{
    exact_sum_add(&tally->number[part], 1.0);
    exact_sum_add(&tally->mass[part], mass);
}

void tally_add_one(struct tally *tally, int material, double radius, double mass)
{
    const struct tally_split *split = &tally->split;
    add_to(tally, 0, mass);
    if (split->n_materials > 0)
        add_to(tally, 1 + material, mass);
    if (split->n_classes > 0) {
        int class = 0;
        while (class < split->n_classes - 1 && radius >= split->bounds[class])
            class ++;
        add_to(tally, 1 + split->n_materials + class, mass);
    }
}

void tally_add(struct tally *tally, const struct spheres *spheres, int i)
{
    tally_add_one(tally, spheres->material[i], sphere_radius(spheres, i),
                  1.0 / sphere_inverse_mass(spheres, i));
}

const char *tally_part(const struct tally_split *split, const struct job *job, int part,
                       char text[TALLY_PART_SIZE])
{
    text[0] = '\0';
    if (part > split->n_materials)
        snprintf(text, TALLY_PART_SIZE, "class_%d", part - split->n_materials);
    else if (part > 0)
        snprintf(text, TALLY_PART_SIZE, "material_%s", job->materials[part - 1].name);
    return text;
}

/* ", of ore", ", of radius 0.01 m to below 0.02 m" */
static void describe_part(const struct tally_split *split, const struct job *job, int part,
                          char *text, size_t size)
{
    const int class = part - 1 - split->n_materials;
    text[0] = '\0';
    if (part > 0 && class < 0)
        snprintf(text, size, ", of %s", job->materials[part - 1].name);
    else if (part > 0 && split->n_classes == 1)
        snprintf(text, size, ", of any radius");
    else if (part > 0 && class == 0)
        snprintf(text, size, ", of radius below %.6g m", split->bounds[0]);
    else if (part > 0 && class == split->n_classes - 1)
        snprintf(text, size, ", of radius %.6g m and more", split->bounds[class - 1]);
    else if (part > 0)
        snprintf(text, size, ", of radius %.6g m to below %.6g m", split->bounds[class - 1],
                 split->bounds[class]);
}

void tally_add_columns(const struct tally_split *split, const struct job *job,
                       struct series *table, const char *owner, const char *suffix,
                       const char *what)
{
    for (int part = 0; part < count_parts(split); part++) {
        char name[TALLY_PART_SIZE], which[128], help[256];
        const char *dot = part > 0 ? "." : "";
        tally_part(split, job, part, name);
        describe_part(split, job, part, which, sizeof which);
        snprintf(help, sizeof help, "spheres %s%s", what, which);
        series_add_column(table, "1", help, "%s%s%s.count%s", owner, dot, name, suffix);
        snprintf(help, sizeof help, "mass of spheres %s%s", what, which);
        series_add_column(table, "kg", help, "%s%s%s.mass%s", owner, dot, name, suffix);
    }
}

int tally_totals(const struct tally *tally, const struct comm *comm, double *row, int n)
{
    const size_t n_parts = (size_t)tally->n_parts;
    struct exact_sum *sums = array_allocate(2 * n_parts, sizeof *sums);
    memcpy(sums, tally->number, n_parts * sizeof *sums);
    memcpy(sums + n_parts, tally->mass, n_parts * sizeof *sums);
    exact_sum_reduce(comm, sums, 2 * tally->n_parts);
    for (size_t part = 0; part < n_parts; part++) {
        row[n++] = exact_sum_value(&sums[part]);
        row[n++] = exact_sum_value(&sums[n_parts + part]);
    }
    free(sums);
    return n;
}
