/* See order.h. */
#include "model/order.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "model/sphere.h"

enum { CELL_BITS = 21 };

static int64_t cell_along(double x, double inverse_size)
{
    const double limit = (double)(1 << (CELL_BITS - 1));
    const double cell = x * inverse_size;
    if (!(cell > 1.0 - limit))
        return 0;
    if (!(cell < limit - 1.0))
        return (1 << CELL_BITS) - 1;
    /* Truncation towards zero of a positive number: a floor without the mathematics library. */
    return (int64_t)(cell + limit);
}

int64_t order_cell_at(const double x[3], double radius_max)
{
    const double inverse_size = radius_max > 0.0 ? 1.0 / (2.2 * radius_max) : 1.0;
    return (cell_along(x[2], inverse_size) << (2 * CELL_BITS)) |
           (cell_along(x[1], inverse_size) << CELL_BITS) | cell_along(x[0], inverse_size);
}

void order_renew(struct spheres *spheres, const struct comm *comm)
{
    double radius_max = 0.0;
    for (int i = 0; i < spheres->n_owned; i++) {
        const double radius = sphere_radius(spheres, i);
        radius_max = radius > radius_max ? radius : radius_max;
    }
    comm_max(comm, &radius_max, 1);
    for (int i = 0; i < spheres->n_owned; i++)
        spheres->order_cell[i] = order_cell_at(sphere_position(spheres, i), radius_max);
}

static bool key_before(const struct order_key *a, const struct order_key *b)
{
    return order_before(a->cell, a->id, b->cell, b->id);
}

/* End of the ascending run that begins at `begin`. */
static int run_end(const struct order_key *keys, int begin, int n)
{
    int end = begin + 1;
    while (end < n && !key_before(&keys[end], &keys[end - 1]))
        end++;
    return end;
}

static void merge(const struct order_key *a, int n_a, const struct order_key *b, int n_b,
                  struct order_key *out)
{
    int i = 0, j = 0, k = 0;
    while (i < n_a && j < n_b)
        out[k++] = key_before(&b[j], &a[i]) ? b[j++] : a[i++];
    memcpy(out + k, a + i, (size_t)(n_a - i) * sizeof *a);
    k += n_a - i;
    memcpy(out + k, b + j, (size_t)(n_b - j) * sizeof *b);
}

void order_sort(struct order_key *keys, int n, struct order_key *scratch)
{
    struct order_key *from = keys, *to = scratch;
    while (n > 0 && run_end(from, 0, n) < n) {
        for (int begin = 0; begin < n;) {
            const int middle = run_end(from, begin, n);
            const int end = middle < n ? run_end(from, middle, n) : n;
            merge(from + begin, middle - begin, from + middle, end - middle, to + begin);
            begin = end;
        }
        struct order_key *swap = from;
        from = to;
        to = swap;
    }
    if (from != keys)
        memcpy(keys, from, (size_t)n * sizeof *keys);
}

void order_arrange(struct spheres *spheres, int begin, struct order_key *keys, int n)
{
    struct order_key *scratch = array_allocate((size_t)n, sizeof *scratch);
    unsigned char *values = (unsigned char *)scratch;
    order_sort(keys, n, scratch);
    for (int f = 0; f < SPHERE_N_FIELDS; f++) {
        const struct field_view view = sphere_view(spheres, f);
        const size_t size = field_size(&sphere_fields[f]);
        CHECK(size <= sizeof *scratch, "field %s has %zu bytes", sphere_fields[f].name, size);
        for (int k = 0; k < n; k++)
            memcpy(values + (size_t)k * size, field_at(&view, keys[k].index), size);
        for (int k = 0; k < n; k++)
            memcpy(field_at(&view, begin + k), values + (size_t)k * size, size);
    }
    free(scratch);
}
