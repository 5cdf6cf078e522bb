/* See contents.h. */
#include "run/contents.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "model/sphere.h"
#include "store/series.h"

static int find_body(const struct bodies *bodies, const char *name)
{
    int found = -1;
    for (int b = 0; name != NULL && b < bodies->n; b++)
        found = strcmp(bodies->list[b].name, name) == 0 ? b : found;
    return found;
}

void contents_init(struct contents *contents, const struct job *job,
                   const struct bodies *bodies)
{
    *contents = (struct contents){.n = job->n_contents};
    contents->list = array_allocate((size_t)job->n_contents, sizeof *contents->list);
    for (int c = 0; c < contents->n; c++) {
        struct content *content = &contents->list[c];
        const struct tally_split split = tally_split(job, job->contents[c].by, 0, NULL);
        char *why = NULL;
        CHECK(region_build(&content->region, &job->contents[c].region, bodies, &why), "%s",
              why);
        content->follows = find_body(bodies, job->contents[c].follows);
        tally_init(&content->tally, &split);
        for (int k = 0; k < 3; k++)
            content->momentum[k] =
                array_allocate((size_t)content->tally.n_parts, sizeof *content->momentum[k]);
    }
}

void contents_clear(struct contents *contents)
{
    for (int c = 0; c < contents->n; c++) {
        struct content *content = &contents->list[c];
        region_clear(&content->region);
        tally_clear(&content->tally);
        for (int k = 0; k < 3; k++)
            free(content->momentum[k]);
    }
    free(contents->list);
    *contents = (struct contents){0};
}

void contents_add_columns(const struct contents *contents, const struct job *job,
                          struct series *table)
{
    static const char axes[] = "xyz";
    for (int c = 0; c < contents->n; c++) {
        const struct tally *tally = &contents->list[c].tally;
        const char *owner = job->contents[c].name;
        tally_add_columns(&tally->split, job, table, owner, "", "in the region");
        for (int part = 0; part < tally->n_parts; part++) {
            char name[TALLY_PART_SIZE];
            tally_part(&tally->split, job, part, name);
            for (int k = 0; k < 3; k++)
                series_add_column(table, "m/s", "mean velocity of the mass in the region",
                                  "%s%s%s.velocity_%c", owner, part > 0 ? "." : "", name,
                                  axes[k]);
        }
    }
}

void contents_begin(struct contents *contents, const struct bodies *bodies, double time)
{
    for (int c = 0; c < contents->n; c++) {
        struct content *content = &contents->list[c];
        if (content->follows >= 0)
            content->frame = body_frame(&bodies->list[content->follows], time);
        const size_t size = (size_t)content->tally.n_parts * sizeof(struct exact_sum);
        memset(content->tally.number, 0, size);
        memset(content->tally.mass, 0, size);
        for (int k = 0; k < 3; k++)
            memset(content->momentum[k], 0, size);
    }
}

void contents_add(struct contents *contents, const struct spheres *spheres, int i,
                  const double velocity[3])
{
    const struct vec3 x = sphere_place(spheres, i);
    const double mass = 1.0 / sphere_inverse_mass(spheres, i);
    for (int c = 0; c < contents->n; c++) {
        struct content *content = &contents->list[c];
        const struct vec3 place =
            content->follows < 0 ? x : body_frame_reference(&content->frame, x);
        if (!region_contains(&content->region, place, 0.0))
            continue;
        tally_add(&content->tally, spheres, i);
        for (int k = 0; k < 3; k++) {
            exact_sum_add(&content->momentum[k][0], mass * velocity[k]);
            if (content->tally.split.n_materials > 0)
                exact_sum_add(&content->momentum[k][1 + spheres->material[i]],
                              mass * velocity[k]);
        }
    }
}

int contents_values(const struct contents *contents, const struct comm *comm, double *row,
                    int n)
{
    for (int c = 0; c < contents->n; c++) {
        const struct content *content = &contents->list[c];
        const int n_parts = content->tally.n_parts, first = n;
        n = tally_totals(&content->tally, comm, row, n);
        struct exact_sum *sums = array_allocate(3 * (size_t)n_parts, sizeof *sums);
        for (int part = 0; part < n_parts; part++)
            for (int k = 0; k < 3; k++)
                sums[3 * part + k] = content->momentum[k][part];
        exact_sum_reduce(comm, sums, 3 * n_parts);
        for (int part = 0; part < n_parts; part++) {
            const double mass = row[first + 2 * part + 1];
            for (int k = 0; k < 3; k++)
                row[n++] =
                    mass > 0.0 ? exact_sum_value(&sums[3 * part + k]) / mass : (double)NAN;
        }
        free(sums);
    }
    return n;
}
