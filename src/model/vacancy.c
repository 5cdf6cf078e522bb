/*
 * See vacancy.h.  All cells are cut together, so a cell is three whole numbers.  The order of
 * cells follows from what was asked and dropped before: the same everywhere.  A cut takes as
 * many questions as there are cells afterwards at most, eight times those before.
 */
#include "model/vacancy.h"

#include <stdlib.h>

#include "base/array.h"

enum { CELLS_AT_FIRST = 1000000, CELLS_MOST = 24000000, ALONG_MOST = 1 << 30 };

/* Cells of about this edge along a side. */
static uint32_t cells_along(double side, double edge)
{
    const double n = side / edge;
    return !(n > 1.0) ? 1 : n < CELLS_AT_FIRST ? (uint32_t)n : CELLS_AT_FIRST;
}

void vacancy_open(struct vacancy *vacancy, struct vec3 low, struct vec3 high, double edge)
{
    const struct vec3 size = vec3_sub(high, low);
    uint32_t n[3];
    do {
        n[0] = cells_along(size.x, edge);
        n[1] = cells_along(size.y, edge);
        n[2] = cells_along(size.z, edge);
        edge *= 1.25;
    } while ((double)n[0] * n[1] * n[2] > CELLS_AT_FIRST);
    *vacancy = (struct vacancy){.low = low,
                                .edge = {size.x / n[0], size.y / n[1], size.z / n[2]},
                                .n = (int64_t)n[0] * n[1] * n[2]};
    for (int c = 0; c < 3; c++)
        vacancy->along = n[c] > vacancy->along ? n[c] : vacancy->along;
    vacancy->capacity = vacancy->n;
    vacancy->cells = array_allocate((size_t)vacancy->n, sizeof *vacancy->cells);
    int64_t c = 0;
    for (uint32_t i = 0; i < n[0]; i++)
        for (uint32_t j = 0; j < n[1]; j++)
            for (uint32_t k = 0; k < n[2]; k++)
                vacancy->cells[c++] = (struct vacancy_cell){{i, j, k}};
}

void vacancy_close(struct vacancy *vacancy)
{
    free(vacancy->cells);
    *vacancy = (struct vacancy){0};
}

static struct vec3 point_of(const struct vacancy *vacancy, struct vacancy_cell cell,
                            const double part[3])
{
    return (struct vec3){vacancy->low.x + (cell.at[0] + part[0]) * vacancy->edge.x,
                         vacancy->low.y + (cell.at[1] + part[1]) * vacancy->edge.y,
                         vacancy->low.z + (cell.at[2] + part[2]) * vacancy->edge.z};
}

static const double MIDDLE[3] = {0.5, 0.5, 0.5};

/* Adds what is not taken of the eight parts of a cell; false where there is no place left. */
static bool add_parts(struct vacancy *finer, struct vacancy_cell whole, vacancy_taken *taken,
                      const void *context)
{
    const struct vec3 half = vec3_scale(0.5, finer->edge);
    for (uint32_t part = 0; part < 8; part++) {
        const struct vacancy_cell cell = {{2 * whole.at[0] + (part & 1),
                                           2 * whole.at[1] + (part >> 1 & 1),
                                           2 * whole.at[2] + (part >> 2)}};
        if (taken(context, point_of(finer, cell, MIDDLE), half))
            continue;
        if (finer->n == CELLS_MOST)
            return false;
        ARRAY_GROW(finer->cells, finer->n + 1, finer->capacity);
        finer->cells[finer->n++] = cell;
    }
    return true;
}

bool vacancy_cut(struct vacancy *vacancy, vacancy_taken *taken, const void *context)
{
    struct vacancy finer = {.low = vacancy->low,
                            .edge = vec3_scale(0.5, vacancy->edge),
                            .along = 2 * vacancy->along};
    bool fine = vacancy->along <= ALONG_MOST;
    for (int64_t c = 0; c < vacancy->n && fine; c++)
        fine = add_parts(&finer, vacancy->cells[c], taken, context);
    vacancy_close(fine ? vacancy : &finer);
    if (fine)
        *vacancy = finer;
    return fine;
}

struct vec3 vacancy_point(const struct vacancy *vacancy, int64_t cell, const double part[3])
{
    return point_of(vacancy, vacancy->cells[cell], part);
}

struct vec3 vacancy_box(const struct vacancy *vacancy, int64_t cell, struct vec3 *half)
{
    *half = vec3_scale(0.5, vacancy->edge);
    return point_of(vacancy, vacancy->cells[cell], MIDDLE);
}

void vacancy_drop(struct vacancy *vacancy, int64_t cell)
{
    vacancy->cells[cell] = vacancy->cells[--vacancy->n];
}
