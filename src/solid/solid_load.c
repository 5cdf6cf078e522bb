/*
 * See solid_load.h.  Pressure has the nodal forces of the bilinear side, integrated exactly:
 * those that a uniform stress in a one-point hexahedron has, so the two balance to rounding.
 */
#include "solid/solid_load.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "solid/solid.h"

void solid_loads_clear(struct solid_loads *loads)
{
    for (int k = 0; k < loads->n; k++) {
        solid_table_clear(&loads->list[k].table);
        free(loads->list[k].nodes);
        free(loads->list[k].sides);
    }
    free(loads->list);
    *loads = (struct solid_loads){0};
}

static void *copied(const void *from, int n, size_t size)
{
    void *copy = array_allocate((size_t)n, size);
    if (n > 0)
        memcpy(copy, from, (size_t)n * size);
    return copy;
}

static void append(struct solid_loads *loads, struct solid_load load,
                   const struct solid_table *table)
{
    if (table != NULL)
        load.table = solid_table_copy(table);
    ARRAY_GROW(loads->list, loads->n + 1, loads->capacity);
    loads->list[loads->n++] = load;
}

static void add_to_nodes(struct solid_loads *loads, enum solid_load_kind kind,
                         struct vec3 force, const struct solid_table *table, int n,
                         const int *nodes)
{
    append(loads,
           (struct solid_load){
               .kind = kind, .force = force, .n = n, .nodes = copied(nodes, n, sizeof *nodes)},
           table);
}

void solid_loads_add_force(struct solid_loads *loads, struct vec3 force,
                           const struct solid_table *table, int n, const int *nodes)
{
    add_to_nodes(loads, SOLID_LOAD_FORCE, force, table, n, nodes);
}

void solid_loads_add_moment(struct solid_loads *loads, struct vec3 moment,
                            const struct solid_table *table, int n, const int *nodes)
{
    add_to_nodes(loads, SOLID_LOAD_MOMENT, moment, table, n, nodes);
}

void solid_loads_add_pressure(struct solid_loads *loads, double pressure,
                              const struct solid_table *table, int n,
                              const struct solid_side *sides)
{
    append(loads,
           (struct solid_load){.kind = SOLID_LOAD_PRESSURE,
                               .pressure = pressure,
                               .n = n,
                               .sides = copied(sides, n, sizeof *sides)},
           table);
}

/* ------------------------------------------------------------------------------- forces */

static void apply_force(const struct solid *solid, const struct solid_load *load, double factor,
                        double (*force)[3])
{
    const double f[3] = {factor * load->force.x, factor * load->force.y,
                         factor * load->force.z};
    for (int k = 0; k < load->n; k++)
        if (solid->moves[load->nodes[k]])
            for (int i = 0; i < 3; i++)
                force[load->nodes[k]][i] += f[i];
}

static void apply_pressure(const struct solid *solid, const struct solid_load *load,
                           double factor, double (*force)[3])
{
    const double pressure = factor * load->pressure;
    for (int k = 0; k < load->n; k++) {
        const struct solid_side *side = &load->sides[k];
        int nodes[SOLID_SIDE_NODES];
        const int n = solid_side_nodes(solid, side->element, side->side, nodes);
        CHECK(n > 0, "element %d has no side %d", side->element, side->side);
        bool here = false;
        for (int c = 0; c < n; c++)
            here |= solid->moves[nodes[c]];
        if (!here || !solid->alive[side->element])
            continue;
        double x[SOLID_SIDE_NODES][3] = {{0.0}}, area[SOLID_SIDE_NODES][3];
        for (int c = 0; c < n; c++)
            memcpy(x[c], solid_place(solid, nodes[c]), sizeof x[c]);
        solid_side_areas(n, x, area);
        for (int c = 0; c < n; c++)
            if (solid->moves[nodes[c]])
                for (int i = 0; i < 3; i++)
                    force[nodes[c]][i] -= pressure * area[c][i];
    }
}

void solid_loads_apply(const struct solid *solid, double time, double (*force)[3])
{
    for (int k = 0; k < solid->loads.n; k++) {
        const struct solid_load *load = &solid->loads.list[k];
        const double factor = solid_table_value(&load->table, time);
        if (load->kind == SOLID_LOAD_FORCE)
            apply_force(solid, load, factor, force);
        else if (load->kind == SOLID_LOAD_PRESSURE)
            apply_pressure(solid, load, factor, force);
    }
}

void solid_loads_apply_moments(const struct solid *solid, double time, double (*moment)[3])
{
    for (int k = 0; k < solid->loads.n; k++) {
        const struct solid_load *load = &solid->loads.list[k];
        if (load->kind == SOLID_LOAD_MOMENT)
            apply_force(solid, load, solid_table_value(&load->table, time), moment);
    }
}
