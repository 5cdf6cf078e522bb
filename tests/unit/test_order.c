/* Canonical order: cells of the order grid, and a sort that nothing confuses.
 *
 * ranks: 1 2 3
 */
#include "model/order.h"

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/comm.h"
#include "check.h"
#include "random_cloud.h"

enum { MIDDLE = 1 << 20, LAST = (1 << 21) - 1 };

static int64_t code(int64_t x, int64_t y, int64_t z)
{
    return ((z * (LAST + 1)) + y) * (LAST + 1) + x;
}

/* The cell of a sphere alone in the run on every rank, with cells one metre wide. */
static int64_t cell_of(double x, double y, double z)
{
    const struct comm comm = comm_world();
    const double place[3] = {x, y, z};
    struct spheres spheres;
    spheres_init(&spheres);
    cloud_add(&spheres, 0, place, 1.0 / 2.2);
    order_renew(&spheres, &comm);
    const int64_t cell = spheres.order_cell[0];
    spheres_clear(&spheres);
    return cell;
}

TEST(cells_go_row_by_row)
{
    EXPECT(cell_of(0.5, 0.5, 0.5) == code(MIDDLE, MIDDLE, MIDDLE));
    EXPECT(cell_of(3.5, -0.5, 0.5) == code(MIDDLE + 3, MIDDLE - 1, MIDDLE));
    EXPECT(cell_of(-7.25, 99.5, -3.5) == code(MIDDLE - 8, MIDDLE + 99, MIDDLE - 4));
    /* x runs fastest, then y, then z. */
    EXPECT(cell_of(0.5, 0.5, 0.5) < cell_of(1.5, 0.5, 0.5));
    EXPECT(cell_of(9.5, 0.5, 0.5) < cell_of(0.5, 1.5, 0.5));
    EXPECT(cell_of(9.5, 9.5, 0.5) < cell_of(-9.5, -9.5, 1.5));
}

TEST(far_cells_are_joined)
{
    EXPECT(cell_of(1e6, 0.5, 0.5) < cell_of(2e6, 0.5, 0.5));
    EXPECT(cell_of(2e6, 0.5, 0.5) == code(LAST, MIDDLE, MIDDLE));
    EXPECT(cell_of(1e300, -1e300, 0.5) == code(LAST, 0, MIDDLE));
    EXPECT(cell_of((double)INFINITY, 0.5, -(double)INFINITY) == code(LAST, MIDDLE, 0));
    EXPECT(cell_of((double)NAN, 0.5, 0.5) == code(0, MIDDLE, MIDDLE));
}

/* Cells are as wide for all, whoever owns the largest sphere. */
TEST(the_largest_sphere_decides_for_all)
{
    const struct comm comm = comm_world();
    struct spheres spheres;
    spheres_init(&spheres);
    const double far[3] = {10.0, 0.0, 0.0}, here[3] = {0.0, 0.0, 0.0};
    cloud_add(&spheres, comm.rank, far, 0.1);
    if (comm.rank == comm.n_ranks - 1)
        cloud_add(&spheres, comm.n_ranks, here, 1.0);
    order_renew(&spheres, &comm);
    EXPECT(spheres.order_cell[0] == code(MIDDLE + 4, MIDDLE, MIDDLE)); /* 10 / 2.2 = 4.5 */
    spheres_clear(&spheres);
}

TEST(a_rank_without_spheres)
{
    const struct comm comm = comm_world();
    struct spheres spheres;
    spheres_init(&spheres);
    order_renew(&spheres, &comm);
    EXPECT(spheres.n_owned == 0);
    spheres_clear(&spheres);
}

TEST(cell_first_then_id)
{
    EXPECT(order_before(1, 9, 2, 3) && !order_before(2, 3, 1, 9));
    EXPECT(order_before(5, 3, 5, 4) && !order_before(5, 4, 5, 3));
    EXPECT(!order_before(5, 3, 5, 3));
    EXPECT(order_before(-1, 0, 0, 0));
}

static int compare_keys(const void *a, const void *b)
{
    const struct order_key *p = a, *q = b;
    return order_before(p->cell, p->id, q->cell, q->id)   ? -1
           : order_before(q->cell, q->id, p->cell, p->id) ? 1
                                                          : 0;
}

/* Sorts n keys and compares with the library's sort; ids differ: there is one right order. */
static void sort_and_compare(const struct order_key *keys, int n)
{
    struct order_key *sorted = array_allocate((size_t)n, sizeof *sorted);
    struct order_key *expected = array_allocate((size_t)n, sizeof *expected);
    struct order_key *scratch = array_allocate((size_t)n, sizeof *scratch);
    for (int k = 0; k < n; k++)
        sorted[k] = expected[k] = keys[k];
    order_sort(sorted, n, scratch);
    qsort(expected, (size_t)n, sizeof *expected, compare_keys);
    for (int k = 0; k < n; k++)
        EXPECT(sorted[k].cell == expected[k].cell && sorted[k].id == expected[k].id &&
               sorted[k].index == expected[k].index);
    free(sorted);
    free(expected);
    free(scratch);
}

enum { N_KEYS = 1000 };

static struct order_key keys_here[N_KEYS];

TEST(sort_of_anything)
{
    struct cloud_random dice = {5};
    for (int n = 0; n <= N_KEYS; n = n < 20 ? n + 1 : 3 * n) {
        for (int k = 0; k < n; k++) {
            const int64_t cell = (int64_t)cloud_between(&dice, 0.0, 1.0 + 0.2 * n);
            keys_here[k] = (struct order_key){cell, k * 7919 % 10007, k};
        }
        sort_and_compare(keys_here, n);
    }
}

TEST(sort_of_what_is_nearly_sorted)
{
    for (int k = 0; k < N_KEYS; k++)
        keys_here[k] = (struct order_key){k / 4, k, k};
    sort_and_compare(keys_here, N_KEYS);
    for (int k = 0; k < N_KEYS; k += 111)
        keys_here[k].cell = (k * 37 + 5) % 250;
    sort_and_compare(keys_here, N_KEYS);
    for (int k = 0; k < N_KEYS; k++)
        keys_here[k] = (struct order_key){-k, k, k};
    sort_and_compare(keys_here, N_KEYS);
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    const int status = check_run(argc, argv);
    MPI_Finalize();
    return status;
}
