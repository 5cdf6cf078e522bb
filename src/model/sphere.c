/*
 * See sphere.h.  Every array has room for the dummies behind its capacity, so that kernels may
 * load any of them for a padded entry.
 */
#include "model/sphere.h"

#include <stdlib.h>

#include "base/array.h"
#include "base/report.h"
#include "model/material.h"

static const double PI = 3.14159265358979323846;

/* Farther than any scene reaches, and near enough that squares of it stay finite [m]. */
static const double DUMMY_PLACE[SPHERE_DUMMIES] = {1e9, 2e9};

const struct field sphere_fields[SPHERE_N_FIELDS] = {
    [SPHERE_ID] = {"id", "1", "global number, never reused", FIELD_INT64, 1,
                   FIELD_GHOST | FIELD_SAVED},
    [SPHERE_ORDER_CELL] = {"order_cell", "1",
                           "cell of the order grid at birth or at the last renewal",
                           FIELD_INT64, 1, FIELD_GHOST | FIELD_SAVED},
    [SPHERE_POSITION] = {"position", "m", "centre at this step", FIELD_DOUBLE, 3,
                         FIELD_GHOST | FIELD_MOTION | FIELD_SAVED | FIELD_PLOTTED},
    [SPHERE_VELOCITY] = {"velocity", "m/s", "velocity half a step earlier", FIELD_DOUBLE, 3,
                         FIELD_GHOST | FIELD_MOTION | FIELD_SAVED | FIELD_PLOTTED},
    [SPHERE_ANGULAR_VELOCITY] = {"angular_velocity", "rad/s",
                                 "angular velocity half a step earlier", FIELD_DOUBLE, 3,
                                 FIELD_GHOST | FIELD_MOTION | FIELD_SAVED | FIELD_PLOTTED},
    [SPHERE_RADIUS] = {"radius", "m", "radius", FIELD_DOUBLE, 1,
                       FIELD_GHOST | FIELD_SAVED | FIELD_PLOTTED},
    [SPHERE_MATERIAL] = {"material", "1", "material, counted from 0 in the order of the job",
                         FIELD_INT32, 1, FIELD_GHOST | FIELD_SAVED | FIELD_PLOTTED},
    [SPHERE_GROUP] = {"group", "1", "group of spheres, counted from 0 in the order of the job",
                      FIELD_INT32, 1, FIELD_SAVED | FIELD_PLOTTED},
    [SPHERE_SIDES] = {"sides", "1", "bit s is set on the forward side of section s",
                      FIELD_INT64, 1, FIELD_SAVED},
    [SPHERE_DISSIPATED_FRICTION] = {"dissipated_friction", "J",
                                    "turned into heat by friction since birth", FIELD_DOUBLE, 1,
                                    FIELD_SAVED},
    [SPHERE_DISSIPATED_DAMPING] = {"dissipated_damping", "J",
                                   "turned into heat by contact damping since birth",
                                   FIELD_DOUBLE, 1, FIELD_SAVED},
    [SPHERE_CAUGHT] =
        {"caught", "1",
         "1 + the removal, counted from 0 in the order of the job, that is to take "
         "it out; 0: none",
         FIELD_INT32, 1, FIELD_SAVED},
};

void spheres_init(struct spheres *spheres)
{
    *spheres = (struct spheres){0};
    spheres_reserve(spheres, 0);
    spheres_pad(spheres);
}

void spheres_clear(struct spheres *spheres)
{
    free(spheres->motion);
    free(spheres->spin);
    free(spheres->force);
    free(spheres->id);
    free(spheres->order_cell);
    free(spheres->material);
    free(spheres->group);
    free(spheres->sides);
    free(spheres->dissipated_friction);
    free(spheres->dissipated_damping);
    free(spheres->caught);
    free(spheres->allowance);
    free(spheres->inverse_allowance);
    free(spheres->searched_at);
    *spheres = (struct spheres){0};
}

static void resize(struct spheres *spheres, size_t capacity)
{
    const size_t was = spheres->motion != NULL ? (size_t)spheres->capacity + SPHERE_DUMMIES : 0;
    const size_t now = capacity + SPHERE_DUMMIES;
#define RESIZE(member)                                                                         \
    spheres->member = array_resize(spheres->member, was, now, sizeof *spheres->member)
#define RESIZE_ROWS(member)                                                                    \
    spheres->member = array_resize_rows(spheres->member, was, now, sizeof *spheres->member)
    RESIZE_ROWS(motion);
    RESIZE_ROWS(spin);
    RESIZE_ROWS(force);
    RESIZE(id);
    RESIZE(order_cell);
    RESIZE(material);
    RESIZE(group);
    RESIZE(sides);
    RESIZE(dissipated_friction);
    RESIZE(dissipated_damping);
    RESIZE(caught);
    RESIZE(allowance);
    RESIZE(inverse_allowance);
    RESIZE(searched_at);
#undef RESIZE
#undef RESIZE_ROWS
    spheres->capacity = (int)capacity;
}

void spheres_reserve(struct spheres *spheres, int n)
{
    if (spheres->motion == NULL || n > spheres->capacity)
        resize(spheres, array_capacity((size_t)spheres->capacity, (size_t)n));
}

void spheres_fit(struct spheres *spheres)
{
    const int enough = spheres->n_all + spheres->n_all / 32;
    if (enough < spheres->capacity)
        resize(spheres, (size_t)enough);
}

struct field_view sphere_view(const struct spheres *spheres, int field)
{
    const size_t row = sizeof(struct sphere_row);
    CHECK(field >= 0 && field < SPHERE_N_FIELDS, "there is no field %d", field);
#define VIEW(member) ((struct field_view){(unsigned char *)(member), sizeof *(member)})
    switch ((enum sphere_field)field) {
    case SPHERE_ID:
        return VIEW(spheres->id);
    case SPHERE_ORDER_CELL:
        return VIEW(spheres->order_cell);
    case SPHERE_POSITION:
        return (struct field_view){(unsigned char *)spheres->motion, row};
    case SPHERE_VELOCITY:
        return (struct field_view){(unsigned char *)(spheres->motion->lane + 4), row};
    case SPHERE_ANGULAR_VELOCITY:
        return (struct field_view){(unsigned char *)(spheres->spin->lane + 4), row};
    case SPHERE_RADIUS:
        return (struct field_view){(unsigned char *)(spheres->motion->lane + 3), row};
    case SPHERE_MATERIAL:
        return VIEW(spheres->material);
    case SPHERE_GROUP:
        return VIEW(spheres->group);
    case SPHERE_SIDES:
        return VIEW(spheres->sides);
    case SPHERE_DISSIPATED_FRICTION:
        return VIEW(spheres->dissipated_friction);
    case SPHERE_DISSIPATED_DAMPING:
        return VIEW(spheres->dissipated_damping);
    case SPHERE_CAUGHT:
    default:
        return VIEW(spheres->caught);
    }
#undef VIEW
}

void sphere_complete(struct spheres *spheres, int i, const struct materials *materials)
{
    double *motion = spheres->motion[i].lane, *spin = spheres->spin[i].lane;
    const double radius = motion[3];
    const double mass = materials->density[spheres->material[i]] * (4.0 / 3.0 * PI) *
                        (radius * radius * radius);
    motion[7] = radius;
    for (int k = 0; k < 3; k++)
        spin[k] = radius * spin[4 + k];
    spin[3] = 1.0 / radius;
    spin[7] = 1.0 / mass;
}

void spheres_pad(struct spheres *spheres)
{
    for (int k = 0; k < SPHERE_DUMMIES; k++) {
        const int i = spheres->n_all + k;
        const double place = DUMMY_PLACE[k];
        spheres->motion[i] =
            (struct sphere_row){{place, place, place, 1.0, 0.0, 0.0, 0.0, 1.0}};
        spheres->spin[i] = (struct sphere_row){{0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
        spheres->force[i] = (struct sphere_row){{0.0}};
        spheres->id[i] = -1;
        spheres->order_cell[i] = -1;
        spheres->material[i] = 0;
        spheres->group[i] = 0;
        spheres->sides[i] = 0;
        spheres->dissipated_friction[i] = 0.0;
        spheres->dissipated_damping[i] = 0.0;
        spheres->caught[i] = 0;
        spheres->allowance[i] = 0.0;
        spheres->inverse_allowance[i][0] = spheres->inverse_allowance[i][1] = 0.0;
    }
}
