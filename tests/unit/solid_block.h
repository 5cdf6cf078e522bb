/* Blocks of hexahedra or tetrahedra to make solids of, for tests. */
#ifndef TREMIE_TESTS_SOLID_BLOCK_H
#define TREMIE_TESTS_SOLID_BLOCK_H

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "solid/solid.h"

struct solid_block {
    int n[3]; /* cells along each direction */
    bool tetrahedra;
    struct solid_parts mesh;
    enum solid_element_shape *shapes;
};

static inline int solid_block_node(const struct solid_block *block, int i, int j, int k)
{
    return i + (block->n[0] + 1) * (j + (block->n[1] + 1) * k);
}

/* Six tetrahedra about the diagonal of a cell, the same in every cell, so that neighbours
 * fit. */
static inline void solid_block_split(const int corner[8],
                                     int (*elements)[SOLID_ELEMENT_CORNERS])
{
    static const int tetrahedra[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                         {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
    for (int t = 0; t < 6; t++)
        for (int c = 0; c < 4; c++)
            elements[t][c] = corner[tetrahedra[t][c]];
}

/* Cells of unequal corners are made by moving mesh.places afterwards. */
static inline void solid_block_build(struct solid_block *block, int nx, int ny, int nz,
                                     const double size[3], bool tetrahedra)
{
    static const int at[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                 {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    *block = (struct solid_block){.n = {nx, ny, nz}, .tetrahedra = tetrahedra};
    struct solid_parts *mesh = &block->mesh;
    const int per_cell = tetrahedra ? 6 : 1;
    mesh->n_nodes = (nx + 1) * (ny + 1) * (nz + 1);
    mesh->n_elements = nx * ny * nz * per_cell;
    mesh->places = array_allocate((size_t)mesh->n_nodes, sizeof *mesh->places);
    mesh->corners = array_allocate((size_t)mesh->n_elements, sizeof *mesh->corners);
    block->shapes = array_allocate((size_t)mesh->n_elements, sizeof *block->shapes);
    mesh->shapes = block->shapes;
    for (int k = 0; k <= nz; k++)
        for (int j = 0; j <= ny; j++)
            for (int i = 0; i <= nx; i++) {
                double *x = mesh->places[solid_block_node(block, i, j, k)];
                x[0] = size[0] * i / nx;
                x[1] = size[1] * j / ny;
                x[2] = size[2] * k / nz;
            }
    for (int cell = 0; cell < nx * ny * nz; cell++) {
        const int i = cell % nx, j = cell / nx % ny, k = cell / (nx * ny);
        int corner[8];
        for (int c = 0; c < 8; c++)
            corner[c] = solid_block_node(block, i + at[c][0], j + at[c][1], k + at[c][2]);
        if (tetrahedra)
            solid_block_split(corner, mesh->corners + (ptrdiff_t)per_cell * cell);
        else
            memcpy(mesh->corners[cell], corner, sizeof corner);
        for (int t = 0; t < per_cell; t++)
            block->shapes[per_cell * cell + t] =
                tetrahedra ? SOLID_ELEMENT_TETRAHEDRON : SOLID_ELEMENT_HEXAHEDRON;
    }
}

static inline void solid_block_free(struct solid_block *block)
{
    free(block->mesh.places);
    free(block->mesh.corners);
    free(block->shapes);
}

/* The next of a fixed sequence of numbers between -1 and 1. */
static inline double solid_block_random(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return 2.0 * (double)(*state >> 11) * 0x1p-53 - 1.0;
}

static inline bool solid_block_is_inside(const struct solid_block *block, int node)
{
    const int nx = block->n[0] + 1, ny = block->n[1] + 1;
    const int at[3] = {node % nx, node / nx % ny, node / (nx * ny)};
    for (int d = 0; d < 3; d++)
        if (at[d] == 0 || at[d] == block->n[d])
            return false;
    return true;
}

/* Moves nodes inside by up to a length along each direction. */
static inline void solid_block_distort(struct solid_block *block, double length, uint64_t *seed)
{
    for (int i = 0; i < block->mesh.n_nodes; i++)
        if (solid_block_is_inside(block, i))
            for (int d = 0; d < 3; d++)
                block->mesh.places[i][d] += length * solid_block_random(seed);
}

#endif
