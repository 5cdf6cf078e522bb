/* See boxes.h. */
#include "domain/boxes.h"

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/report.h"

void boxes_init(struct boxes *boxes, int n_ranks)
{
    boxes->n_ranks = n_ranks;
    boxes->n_nodes = 0;
    boxes->nodes = array_allocate((size_t)n_ranks, sizeof *boxes->nodes);
    boxes->low = array_allocate((size_t)n_ranks, sizeof *boxes->low);
    boxes->high = array_allocate((size_t)n_ranks, sizeof *boxes->high);
    for (int k = 0; k < 3; k++) {
        boxes->low[0][k] = -(double)INFINITY;
        boxes->high[0][k] = (double)INFINITY;
    }
}

void boxes_clear(struct boxes *boxes)
{
    free(boxes->nodes);
    free(boxes->low);
    free(boxes->high);
    *boxes = (struct boxes){0};
}

int boxes_owner(const struct boxes *boxes, const double x[3])
{
    if (boxes->n_nodes == 0)
        return 0;
    int node = 0;
    while (node >= 0) {
        const struct boxes_node *n = &boxes->nodes[node];
        node = n->child[x[n->axis] < n->cut ? 0 : 1];
    }
    return -1 - node;
}

static void update_below(struct boxes *boxes, int node, const double low[3],
                         const double high[3])
{
    if (node < 0) {
        for (int k = 0; k < 3; k++) {
            boxes->low[-1 - node][k] = low[k];
            boxes->high[-1 - node][k] = high[k];
        }
        return;
    }
    const struct boxes_node *n = &boxes->nodes[node];
    double middle_high[3], middle_low[3];
    for (int k = 0; k < 3; k++) {
        middle_high[k] = k == n->axis && n->cut < high[k] ? n->cut : high[k];
        middle_low[k] = k == n->axis && n->cut > low[k] ? n->cut : low[k];
    }
    update_below(boxes, n->child[0], low, middle_high);
    update_below(boxes, n->child[1], middle_low, high);
}

void boxes_update(struct boxes *boxes)
{
    const double infinity = (double)INFINITY;
    const double low[3] = {-infinity, -infinity, -infinity},
                 high[3] = {infinity, infinity, infinity};
    update_below(boxes, boxes->n_nodes > 0 ? 0 : -1, low, high);
}

/* Cuts the block of cells begin <= cell < end along its longest side; returns the child's
 * code. */
static int grid_below(struct boxes *boxes, const int n[3], const double low[3],
                      const double width[3], const int begin[3], const int end[3])
{
    int axis = 0;
    for (int k = 1; k < 3; k++)
        axis = end[k] - begin[k] > end[axis] - begin[axis] ? k : axis;
    if (end[axis] - begin[axis] == 1)
        return -1 - ((begin[2] * n[1] + begin[1]) * n[0] + begin[0]);
    const int node = boxes->n_nodes++, middle = (begin[axis] + end[axis]) / 2;
    int first_end[3], second_begin[3];
    for (int k = 0; k < 3; k++) {
        first_end[k] = k == axis ? middle : end[k];
        second_begin[k] = k == axis ? middle : begin[k];
    }
    boxes->nodes[node].axis = axis;
    boxes->nodes[node].cut = low[axis] + width[axis] * middle;
    const int first = grid_below(boxes, n, low, width, begin, first_end);
    const int second = grid_below(boxes, n, low, width, second_begin, end);
    boxes->nodes[node].child[0] = first;
    boxes->nodes[node].child[1] = second;
    return node;
}

void boxes_set_grid(struct boxes *boxes, const int n[3], struct vec3 low, struct vec3 high)
{
    CHECK(n[0] * n[1] * n[2] == boxes->n_ranks, "a grid of %d x %d x %d boxes on %d ranks",
          n[0], n[1], n[2], boxes->n_ranks);
    const double corner[3] = {low.x, low.y, low.z};
    const double width[3] = {(high.x - low.x) / n[0], (high.y - low.y) / n[1],
                             (high.z - low.z) / n[2]};
    const int begin[3] = {0, 0, 0};
    boxes->n_nodes = 0;
    grid_below(boxes, n, corner, width, begin, n);
    boxes_update(boxes);
}
