/*
 * See taylor.h.  The cross-section is a square block about the axis and a ring of cells around
 * it, so that no cell is degenerate.
 */
#include "taylor.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../unit/solid_block.h"
#include "specimen.h"
#include "verify.h"

static const double LENGTH = 32.4e-3, RADIUS = 3.2e-3, SPEED = 227.0, UNTIL = 80e-6;
/* Hourglass viscosity alone: elastic hourglass stiffness is far too stiff for what flows. */
static const struct solid_yield_point yield[1] = {{0.0, 400e6}};
static const struct solid_material copper = {8930.0, 117e9, 0.35,  0.0,  0.0,
                                             0.05,   1,     yield, 100e6};

/* Node of a layer: the block's (i, j) first, then the rings' around index a = 0 to 2 m. */
static int ring_node(int m, int ring, int a)
{
    if (ring == 0)
        return a <= m ? m + (m + 1) * a : 2 * m - a + (m + 1) * m;
    return (m + 1) * (m + 1) + (ring - 1) * (2 * m + 1) + a;
}

static void place_layer(int m, double (*x)[3], double z)
{
    const double half = 0.5 * RADIUS;
    for (int j = 0; j <= m; j++)
        for (int i = 0; i <= m; i++) {
            double *at = x[i + (m + 1) * j];
            at[0] = half * i / m;
            at[1] = half * j / m;
            at[2] = z;
        }
    for (int ring = 1; ring <= m; ring++)
        for (int a = 0; a <= 2 * m; a++) {
            const double *from = x[ring_node(m, 0, a)], part = (double)ring / m;
            const double angle = 0.25 * M_PI * a / m;
            double *at = x[ring_node(m, ring, a)];
            at[0] = from[0] + part * (RADIUS * cos(angle) - from[0]);
            at[1] = from[1] + part * (RADIUS * sin(angle) - from[1]);
            at[2] = z;
        }
}

static void add_cell(struct solid_parts *mesh, enum solid_element_shape *shapes,
                     const int corner[4], int layer, int per_layer)
{
    for (int c = 0; c < 4; c++) {
        mesh->corners[mesh->n_elements][c] = corner[c] + layer * per_layer;
        mesh->corners[mesh->n_elements][4 + c] = corner[c] + (layer + 1) * per_layer;
    }
    shapes[mesh->n_elements++] = SOLID_ELEMENT_HEXAHEDRON;
}

static void build(struct solid_parts *mesh, enum solid_element_shape **shapes, int m, int along)
{
    const int per_layer = (m + 1) * (m + 1) + m * (2 * m + 1);
    const size_t n = (size_t)(3 * m * m * along);
    *mesh = (struct solid_parts){.n_nodes = per_layer * (along + 1)};
    mesh->places = array_allocate((size_t)mesh->n_nodes, sizeof *mesh->places);
    mesh->corners = array_allocate(n, sizeof *mesh->corners);
    mesh->shapes = *shapes = array_allocate(n, sizeof **shapes);
    for (int k = 0; k <= along; k++)
        place_layer(m, mesh->places + (ptrdiff_t)k * per_layer, LENGTH * k / along);
    for (int k = 0; k < along; k++) {
        for (int j = 0; j < m; j++)
            for (int i = 0; i < m; i++) {
                const int first = i + (m + 1) * j;
                add_cell(mesh, *shapes,
                         (const int[4]){first, first + 1, first + m + 2, first + m + 1}, k,
                         per_layer);
            }
        for (int ring = 0; ring < m; ring++)
            for (int a = 0; a < 2 * m; a++)
                add_cell(mesh, *shapes,
                         (const int[4]){ring_node(m, ring, a), ring_node(m, ring + 1, a),
                                        ring_node(m, ring + 1, a + 1),
                                        ring_node(m, ring, a + 1)},
                         k, per_layer);
    }
}

static double value(const struct solid_energies *energies, enum solid_energy energy)
{
    return solid_energy_value(energies, energy);
}

struct taylor_result taylor_run(int across, int along)
{
    struct solid_parts mesh;
    enum solid_element_shape *shapes;
    struct specimen specimen;
    struct taylor_result result = {0};
    build(&mesh, &shapes, across, along);
    /* Cells get thinner: their step to a fifth. */
    specimen_make(&specimen, &mesh, &copper, 0.2);
    struct solid *solid = &specimen.solid;
    for (int d = 0; d < 3; d++)
        specimen_fix(&specimen, d, 0.0, d);
    for (int i = 0; i < solid->n_nodes; i++)
        solid_velocity(solid, i)[2] = -SPEED;
    const struct solid_energies before = specimen_energies(&specimen);
    specimen_steps(&specimen, (int64_t)(UNTIL / specimen.dt));
    const struct solid_energies after = specimen_energies(&specimen);
    for (int i = 0; i < solid->n_nodes; i++) {
        const double *x = solid_place(solid, i);
        result.length = fmax(result.length, x[2]);
        if (solid->reference[i][2] == 0.0)
            result.foot = fmax(result.foot, sqrt(x[0] * x[0] + x[1] * x[1]));
    }
    for (int e = 0; e < solid->n_elements; e++)
        result.plastic_most = fmax(result.plastic_most, solid->state[e].plastic_strain);
    const double internal = value(&after, SOLID_ENERGY_INTERNAL);
    const double hourglass =
        value(&after, SOLID_ENERGY_HOURGLASS) + value(&after, SOLID_ENERGY_HOURGLASS_DAMPED);
    result.hourglass = hourglass / internal;
    result.held = (internal - value(&after, SOLID_ENERGY_ELASTIC) -
                   value(&after, SOLID_ENERGY_PLASTIC) - hourglass) /
                  internal;
    result.balance = (solid_energy_balance(&after) - solid_energy_balance(&before)) /
                     value(&before, SOLID_ENERGY_KINETIC);
    specimen_free(&specimen);
    free(mesh.places);
    free(mesh.corners);
    free(shapes);
    return result;
}

void taylor_rows(const struct taylor_result *from, int across, int along)
{
    const struct taylor_result result = *from;
    const int n = 3 * across * across * along;
    char text[96];
    snprintf(text, sizeof text, "%d cells: length at 80 us", n);
    verify_row(text, "mm", 21.4, 1e3 * result.length, 0.2, VERIFY_ABSOLUTE,
               "published results lie between 21.3 and 21.5");
    snprintf(text, sizeof text, "%d cells: radius of the foot", n);
    verify_row(text, "mm", 7.0, 1e3 * result.foot, 0.25, VERIFY_ABSOLUTE,
               "published results lie between 6.9 and 7.2");
    snprintf(text, sizeof text, "%d cells: hourglass energy over internal", n);
    verify_row(text, "", 0.05, result.hourglass, 0.0, VERIFY_AT_MOST, "usual bound");
    snprintf(text, sizeof text, "%d cells: internal energy nobody accounts for, over it", n);
    verify_row(text, "", 0.0, result.held, 0.01, VERIFY_ABSOLUTE, "usual bound");
    snprintf(text, sizeof text, "%d cells: energy balance over the energy", n);
    verify_row(text, "", 0.0, result.balance, 1e-10, VERIFY_ABSOLUTE, "rounding (12.14)");
}
