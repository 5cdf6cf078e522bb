/*
 * See deform_capture.h.  Each rank gives the nodes that it moves and the elements that it
 * counts; rank 0 what stays: reference places, corners, the surface.  A node's share of the
 * area is made of sides of elements that are computed for it, so their nodes are where they
 * are.
 */
#include "run/deform_capture.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "job/job.h"
#include "model/solid_mesh.h"
#include "physics/principal.h"
#include "run/simulation.h"
#include "solid/solid_surface.h"
#include "store/snapshot.h"

/* --------------------------------------------------------------------------------- nodes */

/* Shares of the surface of the nodes moved here, outwards [m2]; the caller frees them. */
static double (*node_areas(const struct solid *solid, const struct solid_surface *surface))[3]
{
    double(*areas)[3] = array_allocate((size_t)solid->n_nodes, sizeof *areas);
    for (int f = 0; f < surface->n; f++) {
        const struct solid_surface_face *face = &surface->faces[f];
        double x[SOLID_SIDE_NODES][3] = {{0.0}}, area[SOLID_SIDE_NODES][3];
        bool here = false;
        for (int c = 0; c < SOLID_SIDE_NODES && c < face->n; c++) {
            here = here || solid->moves[face->nodes[c]];
            memcpy(x[c], solid_place(solid, face->nodes[c]), sizeof x[c]);
        }
        if (!here)
            continue;
        solid_side_areas(face->n, x, area);
        for (int c = 0; c < face->n; c++)
            for (int k = 0; k < 3; k++)
                areas[face->nodes[c]][k] += area[c][k];
    }
    return areas;
}

/* (12.18) */
static double pressure(const double force[3], const double area[3])
{
    const double inwards = -(force[0] * area[0] + force[1] * area[1] + force[2] * area[2]);
    const double square = area[0] * area[0] + area[1] * area[1] + area[2] * area[2];
    return square > 0.0 ? inwards / square : 0.0;
}

/* The fields that the table has, in the order of `values`. */
static void put_row(struct table *table, const struct field *fields, int n_fields,
                    const void *const *values)
{
    unsigned char *record = array_allocate(1, table->record_size);
    table_append(table, record, 1);
    for (int f = 0; f < n_fields; f++) {
        const int column = snapshot_column(table, fields[f].name);
        if (column >= 0)
            snapshot_put(table, table->n - 1, column, values[f]);
    }
    free(record);
}

static void put_node(const struct solid *solid, int i, double dt, const double area[3],
                     struct table *table)
{
    const double *x = solid_place(solid, i), *from = solid->reference[i];
    const double way[3] = {x[0] - from[0], x[1] - from[1], x[2] - from[2]};
    const double pressed = pressure(solid->contact[i], area);
    const int64_t id = i;
    double velocity[3];
    solid_velocity_now(solid, i, dt, velocity);
    const void *const values[SNAPSHOT_N_NODE_FIELDS] = {
        [SNAPSHOT_NODE_ID] = &id,
        [SNAPSHOT_NODE_POSITION] = x,
        [SNAPSHOT_NODE_DISPLACEMENT] = way,
        [SNAPSHOT_NODE_VELOCITY] = velocity,
        [SNAPSHOT_NODE_CONTACT_FORCE] = solid->contact[i],
        [SNAPSHOT_NODE_CONTACT_PRESSURE] = &pressed,
    };
    put_row(table, snapshot_node_fields, SNAPSHOT_N_NODE_FIELDS, values);
}

static void add_nodes(const struct simulation *sim, struct solid *solid,
                      const struct solid_surface *surface, struct table *table)
{
    double(*areas)[3] = node_areas(solid, surface);
    const double dt = deform_dt(&sim->deform, sim->dt);
    solid_supports_set(&solid->supports, deform_step(&sim->deform, sim->step) + 1, dt);
    for (int i = 0; i < solid->n_nodes; i++)
        if (solid->moves[i])
            put_node(solid, i, dt, areas[i], table);
    free(areas);
}

/* ------------------------------------------------------------------------------ elements */

static void put_element(const struct solid *solid, int e, struct table *table)
{
    const struct solid_element_state *state = &solid->state[e];
    const double mises = solid_mises(solid, e);
    const double thickness =
        shell_element_is(solid->shape[e]) ? solid->shell[e].thickness : 0.0;
    const int64_t id = e;
    double principal[3];
    principal_values(state->stress, principal);
    const void *const values[SNAPSHOT_N_ELEMENT_FIELDS] = {
        [SNAPSHOT_ELEMENT_ID] = &id,
        [SNAPSHOT_ELEMENT_STRESS] = state->stress,
        [SNAPSHOT_ELEMENT_VON_MISES] = &mises,
        [SNAPSHOT_ELEMENT_PRINCIPAL_STRESS] = principal,
        [SNAPSHOT_ELEMENT_PLASTIC_STRAIN] = &state->plastic_strain,
        [SNAPSHOT_ELEMENT_THICKNESS] = &thickness,
        [SNAPSHOT_ELEMENT_ALIVE] = &solid->alive[e],
    };
    put_row(table, snapshot_element_fields, SNAPSHOT_N_ELEMENT_FIELDS, values);
}

/* ---------------------------------------------------------------------------------- mesh */

static int32_t *part_of(struct snapshot_rows *part, int64_t n_most, int width)
{
    part->width = width;
    part->rows = array_allocate((size_t)(n_most * width), sizeof(int32_t));
    return part->rows;
}

static void add_corners(const struct solid *solid, int width, struct snapshot_solid *shown)
{
    int32_t *corners = part_of(&shown->parts[SNAPSHOT_CORNERS], solid->n_elements, width);
    shown->parts[SNAPSHOT_CORNERS].n = solid->n_elements;
    for (int e = 0; e < solid->n_elements; e++)
        for (int c = 0; c < width; c++)
            *corners++ = c < solid_element_corners(solid->shape[e])    ? solid->corners[e][c]
                         : c == 4 && shell_element_is(solid->shape[e]) ? SOLID_MESH_SHEET
                                                                       : -1;
}

/* As XDMF lists elements of several kinds. */
static void add_cells(const struct solid *solid, struct snapshot_solid *shown)
{
    enum { TRIANGLE = 4, QUAD = 5, TETRAHEDRON = 6, HEXAHEDRON = 9 };
    struct snapshot_rows *part = &shown->parts[SNAPSHOT_CELLS];
    int32_t *cells = part_of(part, (int64_t)solid->n_elements * (1 + SOLID_ELEMENT_CORNERS), 1);
    for (int e = 0; e < solid->n_elements; e++) {
        const int n = solid_element_corners(solid->shape[e]);
        if (shell_element_is(solid->shape[e]))
            cells[part->n++] = n == 4 ? QUAD : TRIANGLE;
        else
            cells[part->n++] = n == 4 ? TETRAHEDRON : HEXAHEDRON;
        for (int c = 0; c < n; c++)
            cells[part->n++] = solid->corners[e][c];
    }
}

static void add_triangles(const struct solid_surface *surface, struct snapshot_solid *shown)
{
    struct snapshot_rows *part = &shown->parts[SNAPSHOT_TRIANGLES];
    int32_t *triangle = part_of(part, 2 * (int64_t)surface->n, 3);
    for (int f = 0; f < surface->n; f++) {
        const int *nodes = surface->faces[f].nodes;
        for (int k = 2; k < surface->faces[f].n; k++, part->n++) {
            *triangle++ = nodes[0];
            *triangle++ = nodes[k - 1];
            *triangle++ = nodes[k];
        }
    }
}

static void add_mesh(const struct solid *solid, const struct solid_surface *surface,
                     struct snapshot_solid *shown)
{
    struct snapshot_rows *reference = &shown->parts[SNAPSHOT_REFERENCE];
    int n_tetrahedra = 0, n_hexahedra = 0; /* the others are sheets */
    for (int e = 0; e < solid->n_elements; e++) {
        n_tetrahedra += solid->shape[e] == SOLID_ELEMENT_TETRAHEDRON;
        n_hexahedra += solid->shape[e] == SOLID_ELEMENT_HEXAHEDRON;
    }
    reference->n = solid->n_nodes;
    reference->rows = array_allocate((size_t)solid->n_nodes, sizeof *solid->reference);
    memcpy(reference->rows, solid->reference,
           (size_t)solid->n_nodes * sizeof *solid->reference);
    add_corners(solid, n_tetrahedra < solid->n_elements ? SOLID_ELEMENT_CORNERS : 4, shown);
    add_triangles(surface, shown);
    shown->mixed = n_tetrahedra < solid->n_elements && n_hexahedra < solid->n_elements;
    if (shown->mixed)
        add_cells(solid, shown);
}

/* --------------------------------------------------------------------------------- whole */

static void add_solid(struct simulation *sim, struct deform_body *deform,
                      struct snapshot *snapshot)
{
    const struct job *job = sim->job;
    const struct body *body = &sim->bodies.list[deform->body];
    struct solid *solid = &deform->solid;
    struct solid_surface surface = {0};
    struct snapshot_solid *shown = snapshot_add_solid(
        snapshot, body->name, job->output.snapshots.solids, solid->shell != NULL,
        job->output.snapshots.precision == JOB_PRECISION_SINGLE,
        job->output.snapshots.compress == JOB_COMPRESS_LOSSLESS);
    shown->material = array_string(job->materials[body->material].name);
    shown->n_nodes = solid->n_nodes;
    shown->n_elements = solid->n_elements;
    solid_surface_build(&surface, solid);
    add_nodes(sim, solid, &surface, &shown->nodes);
    for (int e = 0; e < solid->n_elements; e++)
        if (solid_counts(solid, e))
            put_element(solid, e, &shown->elements);
    if (sim->comm->rank == 0)
        add_mesh(solid, &surface, shown);
    solid_surface_clear(&surface);
    table_arrange(&shown->nodes, sim->comm, solid->n_nodes);
    table_arrange(&shown->elements, sim->comm, solid->n_elements);
}

void deform_capture(struct simulation *sim, struct snapshot *snapshot)
{
    for (int k = 0; k < sim->deform.n; k++)
        if (sim->bodies.list[sim->deform.list[k].body].exists)
            add_solid(sim, &sim->deform.list[k], snapshot);
}
