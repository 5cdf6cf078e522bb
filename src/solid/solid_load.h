/* What loads a solid: forces and moments on nodes and pressure on sides of elements, each
 * times a table over time. */
#ifndef TREMIE_SOLID_SOLID_LOAD_H
#define TREMIE_SOLID_SOLID_LOAD_H

#include "base/vec3.h"
#include "solid/solid_side.h"
#include "solid/solid_table.h"

struct solid;

enum solid_load_kind { SOLID_LOAD_FORCE, SOLID_LOAD_MOMENT, SOLID_LOAD_PRESSURE };

struct solid_load {
    enum solid_load_kind kind;
    struct solid_table table; /* factor over time */
    struct vec3 force;        /* or moment on each node [N], [N m] */
    double pressure;          /* against the sides [Pa] */
    int n;
    int *nodes;
    struct solid_side *sides;
};

struct solid_loads {
    int n, capacity;
    struct solid_load *list;
};

void solid_loads_clear(struct solid_loads *loads);

/* The same force on each of these nodes; table NULL: constant.  Everything is copied. */
void solid_loads_add_force(struct solid_loads *loads, struct vec3 force,
                           const struct solid_table *table, int n, const int *nodes);
/* The same moment on each of these nodes, of shells. */
void solid_loads_add_moment(struct solid_loads *loads, struct vec3 moment,
                            const struct solid_table *table, int n, const int *nodes);
/* Pressure that pushes on these sides wherever they are; on those of living elements. */
void solid_loads_add_pressure(struct solid_loads *loads, double pressure,
                              const struct solid_table *table, int n,
                              const struct solid_side *sides);

/* Forces on the nodes moved here [N], added in the order of the list.  (12.16) */
void solid_loads_apply(const struct solid *solid, double time, double (*force)[3]);
/* Moments likewise [N m]. */
void solid_loads_apply_moments(const struct solid *solid, double time, double (*moment)[3]);

#endif
