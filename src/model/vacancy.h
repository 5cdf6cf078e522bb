/*
 * Where there may still be room: a grid of boxes of space, of which those are kept that are not
 * known to be taken, cut finer as fewer are left.  For random addition near saturation: a point
 * of these boxes is as good as one of all space, and far more often free.  Local, all of it.
 */
#ifndef TREMIE_MODEL_VACANCY_H
#define TREMIE_MODEL_VACANCY_H

#include <stdbool.h>
#include <stdint.h>

#include "base/vec3.h"

struct vacancy_cell {
    uint32_t at[3]; /* in cells from the lower corner */
};

struct vacancy {
    struct vec3 low, edge; /* corner of the grid; sides of a cell as cut now [m] */
    uint32_t along;        /* cells along the longest side */
    int64_t n, capacity;
    struct vacancy_cell *cells;
};

/* Is all of a box known to be taken?  May say no where it is. */
typedef bool vacancy_taken(const void *context, struct vec3 centre, struct vec3 half);

/* All of a box, in cells about as wide as `edge` [m]; wider where they would be very many. */
void vacancy_open(struct vacancy *vacancy, struct vec3 low, struct vec3 high, double edge);
void vacancy_close(struct vacancy *vacancy);
/* Cuts all cells in eight and drops what is taken.  False, nothing done, where they would be
 * too many or too small. */
bool vacancy_cut(struct vacancy *vacancy, vacancy_taken *taken, const void *context);
/* A cell's point, at these parts of its sides. */
struct vec3 vacancy_point(const struct vacancy *vacancy, int64_t cell, const double part[3]);
/* Its centre, and half of its sides. */
struct vec3 vacancy_box(const struct vacancy *vacancy, int64_t cell, struct vec3 *half);
/* Drops it; the last one gets its number. */
void vacancy_drop(struct vacancy *vacancy, int64_t cell);

#endif
