/* Sheets of quadrilaterals or triangles to make shells and membranes of, for tests. */
#ifndef TREMIE_TESTS_SHELL_SHEET_H
#define TREMIE_TESTS_SHELL_SHEET_H

#include <stdlib.h>

#include "base/array.h"
#include "solid/solid.h"
#include "solid_block.h"

struct shell_sheet {
    int n[2]; /* cells along each direction */
    enum solid_element_shape shape;
    struct solid_parts mesh;
    enum solid_element_shape *shapes;
    double *thickness;
};

static inline int shell_sheet_node(const struct shell_sheet *sheet, int i, int j)
{
    return i + (sheet->n[0] + 1) * j;
}

/* Flat, at z = 0; other sheets are made by moving mesh.places afterwards. Triangles are halves
 * of cells, the diagonals in turn one way and the other. */
static inline void shell_sheet_build(struct shell_sheet *sheet, int nx, int ny,
                                     const double size[2], enum solid_element_shape shape,
                                     double thickness, int layers)
{
    static const int half[2][2][3] = {{{0, 1, 2}, {0, 2, 3}}, {{0, 1, 3}, {1, 2, 3}}};
    *sheet = (struct shell_sheet){.n = {nx, ny}, .shape = shape};
    struct solid_parts *mesh = &sheet->mesh;
    const int per_cell = solid_element_corners(shape) == 3 ? 2 : 1;
    mesh->n_nodes = (nx + 1) * (ny + 1);
    mesh->n_elements = nx * ny * per_cell;
    mesh->places = array_allocate((size_t)mesh->n_nodes, sizeof *mesh->places);
    mesh->corners = array_allocate((size_t)mesh->n_elements, sizeof *mesh->corners);
    sheet->shapes = array_allocate((size_t)mesh->n_elements, sizeof *sheet->shapes);
    sheet->thickness = array_allocate((size_t)mesh->n_elements, sizeof *sheet->thickness);
    mesh->shapes = sheet->shapes;
    mesh->thickness = sheet->thickness;
    mesh->layers = layers;
    for (int j = 0; j <= ny; j++)
        for (int i = 0; i <= nx; i++) {
            double *x = mesh->places[shell_sheet_node(sheet, i, j)];
            x[0] = size[0] * i / nx;
            x[1] = size[1] * j / ny;
        }
    for (int e = 0; e < mesh->n_elements; e++) {
        const int cell = e / per_cell, i = cell % nx, j = cell / nx;
        const int corner[4] = {shell_sheet_node(sheet, i, j), shell_sheet_node(sheet, i + 1, j),
                               shell_sheet_node(sheet, i + 1, j + 1),
                               shell_sheet_node(sheet, i, j + 1)};
        for (int c = 0; c < solid_element_corners(shape); c++)
            mesh->corners[e][c] =
                per_cell == 2 ? corner[half[(i + j) % 2][e % 2][c]] : corner[c];
        sheet->shapes[e] = shape;
        sheet->thickness[e] = thickness;
    }
}

static inline void shell_sheet_free(struct shell_sheet *sheet)
{
    free(sheet->mesh.places);
    free(sheet->mesh.corners);
    free(sheet->shapes);
    free(sheet->thickness);
}

static inline bool shell_sheet_is_inside(const struct shell_sheet *sheet, int node)
{
    const int i = node % (sheet->n[0] + 1), j = node / (sheet->n[0] + 1);
    return i > 0 && i < sheet->n[0] && j > 0 && j < sheet->n[1];
}

/* Moves nodes inside by up to a length in the plane. */
static inline void shell_sheet_distort(struct shell_sheet *sheet, double length, uint64_t *seed)
{
    for (int i = 0; i < sheet->mesh.n_nodes; i++)
        if (shell_sheet_is_inside(sheet, i))
            for (int d = 0; d < 2; d++)
                sheet->mesh.places[i][d] += length * solid_block_random(seed);
}

#endif
