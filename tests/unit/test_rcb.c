/* Bisection: weights in balance, boxes that tile space, the same tree on all ranks.
 *
 * ranks: 1 2 3 5
 */
#include "domain/rcb.h"

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/comm.h"
#include "check.h"
#include "domain/boxes.h"
#include "random_cloud.h"

enum { N = 6000 };

/* All spheres of the run; rank r holds those with id % n_ranks == r. */
struct cloud {
    int n;
    double x[N][3];
    int64_t weight[N];
};

static struct cloud cloud;

static void partition(struct boxes *boxes, const struct comm *comm)
{
    struct rcb_point *points = array_allocate((size_t)cloud.n, sizeof *points);
    int n = 0;
    for (int id = comm->rank; id < cloud.n; id += comm->n_ranks) {
        memcpy(points[n].place, cloud.x[id], sizeof points[n].place);
        points[n++].weight = cloud.weight[id];
    }
    boxes_init(boxes, comm->n_ranks);
    rcb_partition(boxes, comm, n, points);
    boxes_update(boxes);
    free(points);
}

static bool is_inside(const struct boxes *boxes, int rank, const double *x)
{
    bool inside = true;
    for (int k = 0; k < 3; k++)
        inside = inside && x[k] >= boxes->low[rank][k] && x[k] < boxes->high[rank][k];
    return inside;
}

/* Every place has one owner, and it is the one whose box holds it. */
static void expect_tiles(const struct boxes *boxes, const double *x)
{
    int n_holders = 0, holder = -1;
    for (int q = 0; q < boxes->n_ranks; q++) {
        n_holders += is_inside(boxes, q, x);
        holder = is_inside(boxes, q, x) ? q : holder;
    }
    EXPECT(n_holders == 1 && holder == boxes_owner(boxes, x));
}

static void expect_same_everywhere(const struct boxes *boxes, const struct comm *comm)
{
    const size_t n = (size_t)(6 * comm->n_ranks) * sizeof(double);
    double *own = array_allocate(1, n), *all = array_allocate((size_t)comm->n_ranks, n);
    memcpy(own, boxes->low, n / 2);
    memcpy(own + 3 * comm->n_ranks, boxes->high, n / 2);
    comm_gather_all(comm, own, all, n);
    for (int q = 0; q < comm->n_ranks; q++)
        EXPECT(memcmp(own, all + 6 * q * comm->n_ranks, n) == 0);
    free(own);
    free(all);
}

/* Checks the tree, returns the largest weight of a rank over the mean. */
static double check_partition(const struct boxes *boxes, const struct comm *comm)
{
    struct cloud_random dice = {11};
    int64_t most = 0, sum = 0;
    int64_t *owned = array_allocate((size_t)comm->n_ranks, sizeof *owned);
    EXPECT(boxes->n_nodes == comm->n_ranks - 1);
    expect_same_everywhere(boxes, comm);
    for (int id = 0; id < cloud.n; id++) {
        expect_tiles(boxes, cloud.x[id]);
        owned[boxes_owner(boxes, cloud.x[id])] += cloud.weight[id];
        sum += cloud.weight[id];
    }
    for (int k = 0; k < 300; k++) { /* also far out, where nobody was */
        const double size = k % 2 == 0 ? 3.0 : 1e7;
        const double x[3] = {cloud_between(&dice, -size, size),
                             cloud_between(&dice, -size, size),
                             cloud_between(&dice, -size, size)};
        expect_tiles(boxes, x);
    }
    for (int k = 0; k < boxes->n_nodes; k++) { /* on the cuts themselves */
        double x[3] = {0.5, 0.5, 0.5};
        x[boxes->nodes[k].axis] = boxes->nodes[k].cut;
        expect_tiles(boxes, x);
    }
    for (int q = 0; q < comm->n_ranks; q++)
        most = owned[q] > most ? owned[q] : most;
    free(owned);
    return sum > 0 ? (double)most * comm->n_ranks / (double)sum : 1.0;
}

static double imbalance(void)
{
    const struct comm comm = comm_world();
    struct boxes boxes;
    partition(&boxes, &comm);
    const double found = check_partition(&boxes, &comm);
    boxes_clear(&boxes);
    return found;
}

static void fill(int n, double sx, double sy, double sz)
{
    struct cloud_random dice = {7};
    cloud.n = n;
    for (int id = 0; id < n; id++) {
        cloud.x[id][0] = cloud_between(&dice, 0.0, sx);
        cloud.x[id][1] = cloud_between(&dice, -sy, 0.0);
        cloud.x[id][2] = cloud_between(&dice, 1.0, 1.0 + sz);
        cloud.weight[id] = 1;
    }
}

TEST(equal_weights)
{
    fill(N, 1.0, 2.0, 3.0);
    EXPECT(imbalance() < 1.01);
    fill(N, 2.0, 1e-3, 1.0);
    EXPECT(imbalance() < 1.01);
}

TEST(uneven_weights)
{
    fill(N, 3.0, 1.0, 1.0);
    for (int id = 0; id < N; id++)
        cloud.weight[id] = 8 + (int64_t)(100.0 * cloud.x[id][0] * cloud.x[id][0]);
    EXPECT(imbalance() < 1.02);
    for (int id = 0; id < N; id++)
        cloud.weight[id] = cloud.x[id][1] > -0.1 ? 100000 : 1;
    EXPECT(imbalance() < 1.05);
}

/* Dense here, thin there, and a few so far away that all others share a bin. */
TEST(uneven_places)
{
    fill(N, 1.0, 1.0, 1.0);
    for (int id = 0; id < N; id++) {
        for (int k = 0; k < 3; k++)
            cloud.x[id][k] = cloud.x[id][k] * cloud.x[id][k] * cloud.x[id][k];
    }
    EXPECT(imbalance() < 1.02);
    cloud.x[17][0] = 1e4;
    cloud.x[18][2] = -1e4;
    EXPECT(imbalance() < 1.1);
}

/* Whole planes go to one side: at most one plane more than its share. */
TEST(planes_of_a_lattice)
{
    cloud.n = 12 * 10 * 10;
    for (int id = 0; id < cloud.n; id++) {
        const int row = id / 12 % 10, layer = id / 120;
        cloud.x[id][0] = 0.22 * (id % 12);
        cloud.x[id][1] = 0.22 * row;
        cloud.x[id][2] = 0.22 * layer;
        cloud.weight[id] = 3;
    }
    EXPECT(imbalance() < 1.4);
    const struct comm comm = comm_world();
    if (comm.n_ranks == 2)
        EXPECT(imbalance() == 1.0);
}

/* Nothing to share out, or less than a sphere a rank: any tree will do. */
TEST(few_spheres)
{
    for (int n = 0; n < 7; n++) {
        fill(n, 1.0, 1.0, 1.0);
        imbalance();
    }
}

TEST(all_at_one_place)
{
    const struct comm comm = comm_world();
    fill(50, 0.0, 0.0, 0.0);
    EXPECT(imbalance() == comm.n_ranks);
    fill(50, 0.0, 0.0, 1.0); /* on a line */
    EXPECT(imbalance() < 1.5);
}

/* One sphere weighs more than all others. */
TEST(one_heavy_sphere)
{
    fill(500, 1.0, 1.0, 1.0);
    cloud.weight[123] = (int64_t)1 << 40;
    imbalance();
}

TEST(even_grids)
{
    const struct comm comm = comm_world();
    const struct vec3 low = {0.0, -1.0, 2.0}, high = {1.0, 1.0, 3.0};
    const int grids[3][3] = {{comm.n_ranks, 1, 1}, {1, comm.n_ranks, 1}, {1, 1, comm.n_ranks}};
    fill(100, 1.0, 1.0, 2.0);
    for (int g = 0; g < 3; g++) {
        struct boxes boxes;
        boxes_init(&boxes, comm.n_ranks);
        boxes_set_grid(&boxes, grids[g], low, high);
        check_partition(&boxes, &comm);
        const double inside[3] = {(comm.rank + 0.5) / comm.n_ranks, 0.0, 2.0};
        if (g == 0)
            EXPECT(boxes_owner(&boxes, inside) == comm.rank);
        boxes_clear(&boxes);
    }
    struct boxes boxes;
    const int eight[3] = {2, 2, 2};
    boxes_init(&boxes, 8);
    boxes_set_grid(&boxes, eight, low, high);
    for (int q = 0; q < 8; q++) {
        const int row = q / 2 % 2, layer = q / 4;
        const double x[3] = {0.25 + 0.5 * (q % 2), row - 0.5, 2.25 + 0.5 * layer};
        EXPECT(boxes_owner(&boxes, x) == q);
        expect_tiles(&boxes, x);
    }
    boxes_clear(&boxes);
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    const int status = check_run(argc, argv);
    MPI_Finalize();
    return status;
}
