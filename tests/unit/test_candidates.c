/* Global search: the grids find exactly the pairs that two nested loops find, in canonical
 * order, whatever the sizes, speeds and places. */
#include "contact/candidates.h"

#include <stdlib.h>

#include "base/array.h"
#include "check.h"
#include "model/order.h"
#include "random_cloud.h"

static struct candidates candidates; /* one for all scenes: it must grow and shrink */
static struct cloud_random dice = {1};

/* ------------------------------------------------------------------------- two nested loops */

static struct spheres *ordered; /* whom the comparison is about */

static int compare_order(const void *a, const void *b)
{
    const int i = *(const int *)a, j = *(const int *)b;
    return order_before(ordered->order_cell[i], ordered->id[i], ordered->order_cell[j],
                        ordered->id[j])
               ? -1
               : 1;
}

static bool is_candidate(const struct spheres *spheres, int i, int j)
{
    const double *a = sphere_position(spheres, i), *b = sphere_position(spheres, j);
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    const double reach = (a[3] + spheres->allowance[i]) + (b[3] + spheres->allowance[j]);
    return (i < spheres->n_owned || j < spheres->n_owned) &&
           d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach * reach;
}

/* Compares the list with what it should be; returns how many pairs there are. */
static int compare_with_loops(struct spheres *spheres, bool all_pairs)
{
    int *at = array_allocate((size_t)spheres->n_all, sizeof *at), n = 0;
    for (int i = 0; i < spheres->n_all; i++)
        at[i] = i;
    ordered = spheres;
    qsort(at, (size_t)spheres->n_all, sizeof *at, compare_order);
    for (int p = 0; p < spheres->n_all; p++) {
        EXPECT(candidates.at[p] == at[p] && candidates.place[at[p]] == p);
        for (int q = p + 1; q < spheres->n_all; q++) {
            const bool owned = at[p] < spheres->n_owned || at[q] < spheres->n_owned;
            if (!(all_pairs ? owned : is_candidate(spheres, at[p], at[q])))
                continue;
            EXPECT(n < candidates.n && candidates.second[n] == at[q]);
            n++;
        }
        EXPECT(candidates.row_end[p] == n);
    }
    EXPECT(candidates.n == n);
    free(at);
    return n;
}

/* ---------------------------------------------------------------------------------- scenes */

struct scene {
    int n;
    double low[3], high[3];
    double radius_min, radius_max;
    double allowance; /* of most, in radii */
    int fast_every;   /* these have 6 radii; 0: none */
    int ghost_every;  /* 0: all are owned */
};

static void exchange(struct spheres *spheres, int i, int j)
{
    for (int f = 0; f < SPHERE_N_FIELDS; f++) {
        const struct field_view view = sphere_view(spheres, f);
        unsigned char kept[64];
        const size_t size = field_size(&sphere_fields[f]);
        memcpy(kept, field_at(&view, i), size);
        memcpy(field_at(&view, i), field_at(&view, j), size);
        memcpy(field_at(&view, j), kept, size);
    }
    const double allowance = spheres->allowance[i];
    spheres->allowance[i] = spheres->allowance[j];
    spheres->allowance[j] = allowance;
}

/* Owned spheres first, then ghosts, each in canonical order. */
static void arrange(struct spheres *spheres, int ghost_every)
{
    for (int i = 0; i < spheres->n_owned; i++) {
        if (ghost_every > 0 && spheres->id[i] % ghost_every == 0)
            exchange(spheres, i--, --spheres->n_owned);
    }
    for (int i = 0; i < spheres->n_all; i++) {
        const int begin = i < spheres->n_owned ? 0 : spheres->n_owned;
        for (int k = i; k > begin; k--) {
            if (!order_before(spheres->order_cell[k], spheres->id[k],
                              spheres->order_cell[k - 1], spheres->id[k - 1]))
                break;
            exchange(spheres, k, k - 1);
        }
    }
}

static void fill(struct spheres *spheres, const struct scene *scene)
{
    spheres_init(spheres);
    for (int id = 0; id < scene->n; id++) {
        double x[3];
        for (int k = 0; k < 3; k++)
            x[k] = cloud_between(&dice, scene->low[k], scene->high[k]);
        const int i = cloud_add(spheres, id, x,
                                cloud_between(&dice, scene->radius_min, scene->radius_max));
        const bool fast = scene->fast_every > 0 && id % scene->fast_every == 0;
        spheres->allowance[i] = (fast ? 6.0 : scene->allowance) * sphere_radius(spheres, i);
    }
    arrange(spheres, scene->ghost_every);
}

static int search_and_compare(struct spheres *spheres)
{
    candidates_search(&candidates, spheres, false);
    const int n = compare_with_loops(spheres, false);
    spheres_clear(spheres);
    return n;
}

static int compare_scene(const struct scene *scene)
{
    struct spheres spheres;
    fill(&spheres, scene);
    return search_and_compare(&spheres);
}

TEST(equal_spheres)
{
    for (int n = 0; n < 700; n = 2 * n + 1) {
        const struct scene scene = {.n = n,
                                    .high = {1.0, 0.8, 0.9},
                                    .radius_min = 0.05,
                                    .radius_max = 0.05,
                                    .allowance = 0.2,
                                    .ghost_every = 3};
        const int found = compare_scene(&scene);
        EXPECT(n < 100 || found > n / 4);
    }
}

TEST(sizes_up_to_twenty)
{
    const struct scene scene = {.n = 600,
                                .low = {-1.0, -1.0, -1.0},
                                .high = {1.0, 1.0, 1.0},
                                .radius_min = 0.01,
                                .radius_max = 0.20,
                                .allowance = 0.1,
                                .ghost_every = 4};
    EXPECT(compare_scene(&scene) > 1000);
    /* A few large ones among many small ones. */
    struct spheres spheres;
    const struct scene small = {.n = 700,
                                .low = {-1.0, -1.0, -1.0},
                                .high = {1.0, 1.0, 1.0},
                                .radius_min = 0.02,
                                .radius_max = 0.025,
                                .allowance = 0.1};
    fill(&spheres, &small);
    for (int i = 0; i < 12; i++)
        spheres.motion[i * 50].lane[3] = 0.4;
    EXPECT(search_and_compare(&spheres) > 200);
}

TEST(fast_spheres)
{
    const struct scene scene = {.n = 600,
                                .high = {1.0, 1.0, 1.0},
                                .radius_min = 0.02,
                                .radius_max = 0.04,
                                .allowance = 0.05,
                                .fast_every = 11,
                                .ghost_every = 5};
    EXPECT(compare_scene(&scene) > 1000);
    const struct scene all_fast = {.n = 300,
                                   .high = {1.0, 1.0, 1.0},
                                   .radius_min = 0.02,
                                   .radius_max = 0.04,
                                   .fast_every = 1,
                                   .ghost_every = 5};
    EXPECT(compare_scene(&all_fast) > 1000);
}

TEST(strays_far_away)
{
    struct spheres spheres;
    const struct scene scene = {.n = 500,
                                .high = {1.0, 1.0, 1.0},
                                .radius_min = 0.02,
                                .radius_max = 0.05,
                                .allowance = 0.2};
    fill(&spheres, &scene);
    for (int i = 0; i < 6; i++) {
        double *x = sphere_position(&spheres, 70 * i + 1);
        x[i % 3] = i % 2 == 0 ? 1e6 : -3e8;
    }
    /* Two strays that touch each other. */
    for (int k = 0; k < 4; k++)
        spheres.motion[2].lane[k] = spheres.motion[1].lane[k];
    EXPECT(search_and_compare(&spheres) > 100);
}

TEST(far_from_the_origin)
{
    const struct scene scene = {.n = 500,
                                .low = {1e6, -1e6, 1e6},
                                .high = {1e6 + 1.0, 1.0 - 1e6, 1e6 + 1.0},
                                .radius_min = 0.02,
                                .radius_max = 0.08,
                                .allowance = 0.2,
                                .fast_every = 13,
                                .ghost_every = 4};
    EXPECT(compare_scene(&scene) > 300);
    const struct scene negative = {.n = 500,
                                   .low = {-1.0, -1.0, -1.0},
                                   .high = {-0.99, -0.99, -0.99},
                                   .radius_min = 1e-4,
                                   .radius_max = 2e-3,
                                   .allowance = 0.2,
                                   .ghost_every = 4};
    EXPECT(compare_scene(&negative) > 300);
}

/* All on one plane, on one line, at one point. */
TEST(equal_coordinates)
{
    struct scene scene = {.n = 400,
                          .low = {0.0, 0.0, 0.5},
                          .high = {1.0, 1.0, 0.5},
                          .radius_min = 0.01,
                          .radius_max = 0.05,
                          .allowance = 0.2,
                          .ghost_every = 6};
    EXPECT(compare_scene(&scene) > 300);
    scene.low[0] = scene.high[0] = -3.0;
    EXPECT(compare_scene(&scene) > 300);
    scene.low[1] = scene.high[1] = 1e5;
    scene.ghost_every = 0;
    EXPECT(compare_scene(&scene) == 400 * 399 / 2);
}

/* On a lattice whose spacing is just two reaches: those that are just out of reach are out,
 * and nobody is found twice where places fall on the borders of cells. */
TEST(lattice_at_the_limit)
{
    for (int hair = 0; hair < 2; hair++) {
        struct spheres spheres;
        spheres_init(&spheres);
        for (int id = 0; id < 512; id++) {
            const int row = id / 8 % 8, layer = id / 64;
            const double x[3] = {0.5 * (id % 8), 0.5 * row, 0.5 * layer};
            const int i = cloud_add(&spheres, id, x, 0.125);
            spheres.allowance[i] = 0.125 + (hair != 0 ? 0x1p-50 : 0.0);
        }
        arrange(&spheres, 0);
        EXPECT(search_and_compare(&spheres) == (hair != 0 ? 3 * 7 * 64 : 0));
    }
}

TEST(all_pairs_lists_everybody)
{
    struct spheres spheres;
    const struct scene scene = {.n = 60,
                                .high = {1.0, 1.0, 1.0},
                                .radius_min = 0.01,
                                .radius_max = 0.05,
                                .allowance = 0.2,
                                .ghost_every = 2};
    fill(&spheres, &scene);
    candidates_search(&candidates, &spheres, true);
    EXPECT(compare_with_loops(&spheres, true) == 60 * 59 / 2 - 30 * 29 / 2);
    spheres_clear(&spheres);
}

TEST(only_ghosts_have_no_pairs)
{
    const struct scene scene = {.n = 50,
                                .high = {0.1, 0.1, 0.1},
                                .radius_min = 0.05,
                                .radius_max = 0.05,
                                .allowance = 0.2,
                                .ghost_every = 1};
    EXPECT(compare_scene(&scene) == 0);
}

int main(int argc, char **argv)
{
    const int status = check_run(argc, argv);
    candidates_clear(&candidates);
    return status;
}
