/* See side.h. */
#include "model/side.h"

#include <stdlib.h>

void side_add(struct side *sides, int *n_sides, int polygon, int n, const int *corners)
{
    for (int k = 0; k < n; k++) {
        const int a = corners[k], b = corners[(k + 1) % n];
        sides[(*n_sides)++] = (struct side){{a < b ? a : b, a < b ? b : a}, polygon, k, a > b};
    }
}

static int compare_ends(const struct side *p, const struct side *q)
{
    for (int k = 0; k < 2; k++)
        if (p->ends[k] != q->ends[k])
            return p->ends[k] < q->ends[k] ? -1 : 1;
    return 0;
}

static int compare_sides(const void *a, const void *b)
{
    const struct side *p = a, *q = b;
    const int order = compare_ends(p, q);
    if (order != 0)
        return order;
    if (p->polygon != q->polygon)
        return p->polygon < q->polygon ? -1 : 1;
    return (p->side > q->side) - (p->side < q->side);
}

void side_sort(struct side *sides, int n)
{
    if (n > 0)
        qsort(sides, (size_t)n, sizeof *sides, compare_sides);
}

int side_edge_end(const struct side *sides, int first, int n)
{
    int end = first + 1;
    while (end < n && compare_ends(&sides[first], &sides[end]) == 0)
        end++;
    return end;
}
