/* See sheet_shape.h. */
#include "model/sheet_shape.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/groups.h"
#include "job/job.h"
#include "model/geometry.h"
#include "model/mesh.h"
#include "model/side.h"
#include "model/solid_mesh.h"

struct facet {
    int n, corners[4], edges[4]; /* edge k from corner k to the next */
};

struct edge {
    int ends[2]; /* ascending */
    int n_facets;
    int pieces;
    int first; /* node of those within it */
};

struct sheet {
    struct geometry geometry;
    int n_facets, n_edges;
    struct facet *facets;
    struct edge *edges;
    int *node; /* of each vertex of the geometry */
};

/* ------------------------------------------------------------------------------- topology */

/* Corners of which no two are in one place. */
static void take_facets(struct sheet *sheet)
{
    const struct geometry *geometry = &sheet->geometry;
    int *joined = mesh_joined_vertices(geometry->n_vertices, geometry->vertices);
    sheet->facets = array_allocate((size_t)geometry->n_facets, sizeof *sheet->facets);
    for (int f = 0; f < geometry->n_facets; f++) {
        struct facet facet = {.n = 0};
        for (int k = 0; k < 4 && geometry->facets[f][k] >= 0; k++) {
            const int vertex = joined[geometry->facets[f][k]];
            if (facet.n == 0 ||
                (vertex != facet.corners[facet.n - 1] && vertex != facet.corners[0]))
                facet.corners[facet.n++] = vertex;
        }
        if (facet.n >= 3)
            sheet->facets[sheet->n_facets++] = facet;
    }
    free(joined);
}

static void find_edges(struct sheet *sheet)
{
    struct side *sides = array_allocate(4 * (size_t)sheet->n_facets, sizeof *sides);
    int n = 0;
    for (int f = 0; f < sheet->n_facets; f++)
        side_add(sides, &n, f, sheet->facets[f].n, sheet->facets[f].corners);
    side_sort(sides, n);
    sheet->edges = array_allocate((size_t)n, sizeof *sheet->edges);
    for (int first = 0, end; first < n; first = end) {
        end = side_edge_end(sides, first, n);
        sheet->edges[sheet->n_edges] =
            (struct edge){.ends = {sides[first].ends[0], sides[first].ends[1]},
                          .pieces = 1,
                          .n_facets = end - first};
        for (int k = first; k < end; k++)
            sheet->facets[sides[k].polygon].edges[sides[k].side] = sheet->n_edges;
        sheet->n_edges++;
    }
    free(sides);
}

/* As many pieces as the longest of those that are alike needs. */
static void cut_edges(struct sheet *sheet, const struct job_body *body)
{
    static const double HAIR = 1e-9;
    const double cell = body->sheet.cell, scale = body->scale > 0.0 ? body->scale : 1.0;
    struct edge *edges = sheet->edges;
    int *alike = groups_apart(sheet->n_edges);
    for (int f = 0; f < sheet->n_facets; f++) {
        const struct facet *facet = &sheet->facets[f];
        if (facet->n == 4) {
            (void)groups_join(alike, facet->edges[0], facet->edges[2]);
            (void)groups_join(alike, facet->edges[1], facet->edges[3]);
        } else {
            (void)groups_join(alike, facet->edges[0], facet->edges[1]);
            (void)groups_join(alike, facet->edges[1], facet->edges[2]);
        }
    }
    for (int e = 0; e < sheet->n_edges && cell > 0.0; e++) {
        struct edge *all = &edges[groups_first(alike, e)];
        const struct vec3 way = vec3_sub(sheet->geometry.vertices[edges[e].ends[1]],
                                         sheet->geometry.vertices[edges[e].ends[0]]);
        const double wanted = scale * vec3_norm(way) / cell - HAIR;
        while ((double)all->pieces < wanted && (double)all->pieces < 1e6)
            all->pieces++;
    }
    for (int e = 0; e < sheet->n_edges; e++)
        edges[e].pieces = edges[groups_first(alike, e)].pieces;
    free(alike);
}

static void sheet_init(struct sheet *sheet, const struct job_body *body)
{
    *sheet = (struct sheet){.n_facets = 0};
    geometry_build_shape(&sheet->geometry, body);
    take_facets(sheet);
    find_edges(sheet);
    cut_edges(sheet, body);
}

static void sheet_clear(struct sheet *sheet)
{
    geometry_clear(&sheet->geometry);
    free(sheet->facets);
    free(sheet->edges);
    free(sheet->node);
}

static int pieces_of(const struct sheet *sheet, const struct facet *facet, int side)
{
    return sheet->edges[facet->edges[side]].pieces;
}

double sheet_shape_n_elements(const struct job_body *body)
{
    struct sheet sheet;
    double n = 0.0;
    sheet_init(&sheet, body);
    for (int f = 0; f < sheet.n_facets; f++)
        n += (double)pieces_of(&sheet, &sheet.facets[f], 0) *
             (double)pieces_of(&sheet, &sheet.facets[f], 1);
    sheet_clear(&sheet);
    return n;
}

/* ---------------------------------------------------------------------------------- nodes */

static void add_node(struct solid_mesh *mesh, int *capacity, struct vec3 place)
{
    ARRAY_GROW(mesh->nodes, mesh->n_nodes + 1, *capacity);
    mesh->nodes[mesh->n_nodes++] = place;
}

static struct vec3 between(struct vec3 a, struct vec3 b, int k, int n)
{
    return vec3_axpy(a, (double)k / (double)n, vec3_sub(b, a));
}

static void add_corners_and_sides(struct sheet *sheet, struct solid_mesh *mesh, int *capacity)
{
    const struct vec3 *vertices = sheet->geometry.vertices;
    sheet->node = array_allocate((size_t)sheet->geometry.n_vertices, sizeof *sheet->node);
    for (int f = 0; f < sheet->n_facets; f++)
        for (int k = 0; k < sheet->facets[f].n; k++)
            sheet->node[sheet->facets[f].corners[k]] = 1;
    for (int v = 0; v < sheet->geometry.n_vertices; v++)
        if (sheet->node[v] != 0) {
            sheet->node[v] = mesh->n_nodes;
            add_node(mesh, capacity, vertices[v]);
        }
    for (int e = 0; e < sheet->n_edges; e++) {
        struct edge *edge = &sheet->edges[e];
        edge->first = mesh->n_nodes;
        for (int k = 1; k < edge->pieces; k++)
            add_node(
                mesh, capacity,
                between(vertices[edge->ends[0]], vertices[edge->ends[1]], k, edge->pieces));
    }
}

/* Node k of a facet's side, from its corner `side` on. */
static int side_node(const struct sheet *sheet, const struct facet *facet, int side, int k)
{
    const struct edge *edge = &sheet->edges[facet->edges[side]];
    const int from = facet->corners[side], to = facet->corners[(side + 1) % facet->n];
    if (k == 0 || k == edge->pieces)
        return sheet->node[k == 0 ? from : to];
    return edge->first + (edge->ends[0] == from ? k : edge->pieces - k) - 1;
}

static void add_element(struct solid_mesh *mesh, int a, int b, int c, int d)
{
    const int element[8] = {a, b, c, d, SOLID_MESH_SHEET, -1, -1, -1};
    memcpy(mesh->elements[mesh->n_elements++], element, sizeof element);
}

/* ---------------------------------------------------------------------------------- quads */

/* Node in column i and row j: along side 0, and from there to side 2. */
static int quad_node(const struct sheet *sheet, const struct facet *facet, int first, int i,
                     int j)
{
    const int across = pieces_of(sheet, facet, 0), up = pieces_of(sheet, facet, 1);
    if (j == 0)
        return side_node(sheet, facet, 0, i);
    if (i == across)
        return side_node(sheet, facet, 1, j);
    if (j == up)
        return side_node(sheet, facet, 2, across - i);
    if (i == 0)
        return side_node(sheet, facet, 3, up - j);
    return first + (j - 1) * (across - 1) + i - 1;
}

static void cut_quad(const struct sheet *sheet, const struct facet *facet,
                     struct solid_mesh *mesh, int *capacity)
{
    const int across = pieces_of(sheet, facet, 0), up = pieces_of(sheet, facet, 1);
    const int first = mesh->n_nodes;
    struct vec3 x[4];
    for (int k = 0; k < 4; k++)
        x[k] = sheet->geometry.vertices[facet->corners[k]];
    for (int j = 1; j < up; j++)
        for (int i = 1; i < across; i++)
            add_node(
                mesh, capacity,
                between(between(x[0], x[1], i, across), between(x[3], x[2], i, across), j, up));
    for (int j = 0; j < up; j++)
        for (int i = 0; i < across; i++)
            add_element(mesh, quad_node(sheet, facet, first, i, j),
                        quad_node(sheet, facet, first, i + 1, j),
                        quad_node(sheet, facet, first, i + 1, j + 1),
                        quad_node(sheet, facet, first, i, j + 1));
}

/* ------------------------------------------------------------------------------ triangles */

static int triangle_node(const struct sheet *sheet, const struct facet *facet, int first, int i,
                         int j)
{
    const int n = pieces_of(sheet, facet, 0);
    if (j == 0)
        return side_node(sheet, facet, 0, i);
    if (i + j == n)
        return side_node(sheet, facet, 1, j);
    if (i == 0)
        return side_node(sheet, facet, 2, n - j);
    return first + (j - 1) * (n - 1) - j * (j - 1) / 2 + i - 1;
}

static void cut_triangle(const struct sheet *sheet, const struct facet *facet,
                         struct solid_mesh *mesh, int *capacity)
{
    const int n = pieces_of(sheet, facet, 0), first = mesh->n_nodes;
    struct vec3 x[3];
    for (int k = 0; k < 3; k++)
        x[k] = sheet->geometry.vertices[facet->corners[k]];
    for (int j = 1; j < n; j++)
        for (int i = 1; i + j < n; i++)
            add_node(mesh, capacity,
                     vec3_axpy(between(x[0], x[1], i, n), (double)j / (double)n,
                               vec3_sub(x[2], x[0])));
    for (int j = 0; j < n; j++)
        for (int i = 0; i + j < n; i++) {
            const int right = triangle_node(sheet, facet, first, i + 1, j),
                      above = triangle_node(sheet, facet, first, i, j + 1);
            add_element(mesh, triangle_node(sheet, facet, first, i, j), right, above, -1);
            if (i + j < n - 1)
                add_element(mesh, right, triangle_node(sheet, facet, first, i + 1, j + 1),
                            above, -1);
        }
}

/* ------------------------------------------------------------------------------------ all */

static void add_rim(const struct sheet *sheet, struct solid_mesh *mesh)
{
    struct solid_mesh_list nodes = {0}, none = {0};
    for (int f = 0; f < sheet->n_facets; f++)
        for (int side = 0; side < sheet->facets[f].n; side++) {
            const struct edge *edge = &sheet->edges[sheet->facets[f].edges[side]];
            for (int k = 0; edge->n_facets == 1 && k <= edge->pieces; k++)
                solid_mesh_list_add(&nodes, side_node(sheet, &sheet->facets[f], side, k));
        }
    solid_mesh_add_set(mesh, "rim", &nodes, &none, &none);
    free(nodes.items);
}

void sheet_shape_build(struct solid_mesh *mesh, const struct job_body *body)
{
    struct sheet sheet;
    int capacity = 0, n = 0;
    sheet_init(&sheet, body);
    for (int f = 0; f < sheet.n_facets; f++)
        n += pieces_of(&sheet, &sheet.facets[f], 0) * pieces_of(&sheet, &sheet.facets[f], 1);
    mesh->elements = array_allocate((size_t)n, sizeof *mesh->elements);
    mesh->sheets = array_allocate((size_t)n, sizeof *mesh->sheets);
    add_corners_and_sides(&sheet, mesh, &capacity);
    for (int f = 0; f < sheet.n_facets; f++)
        if (sheet.facets[f].n == 4)
            cut_quad(&sheet, &sheet.facets[f], mesh, &capacity);
        else
            cut_triangle(&sheet, &sheet.facets[f], mesh, &capacity);
    for (int e = 0; e < mesh->n_elements; e++)
        mesh->sheets[e] =
            (struct solid_mesh_sheet){.thickness = body->sheet.thickness,
                                      .membrane = body->model == JOB_MODEL_MEMBRANE,
                                      .material = body->material};
    add_rim(&sheet, mesh);
    sheet_clear(&sheet);
}
