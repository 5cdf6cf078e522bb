/*
 * The facet kernel of eight lanes, compiled here for the processor that the tests are built
 * for: so it is tested where there are no vectors of eight.
 */
#define facet_kernel_blocks_v4 wide_blocks /* beside the library's own */
#define KERNEL_ISA             4
/* Everything is inlined; nothing passes such vectors. */
#pragma GCC diagnostic ignored "-Wpsabi"
#include "contact/facet_kernel_blocks.c"

#include "base/array.h"
#include "check.h"
#include "random_cloud.h"

enum { N = 77, MATERIALS = 2, STEPS = 30 };

static struct cloud_random dice = {5};

/* Spheres over a square, in turns touching it and not, and what is known of them. */
struct scene {
    struct sphere_row motion[N + 2], spin[N + 2], force[N + 2];
    int32_t material[N + 2];
    struct facet_contact contacts[N + 1];
    struct facet_kernel_load loads[2];
};

static const struct material_pair PAIRS[MATERIALS * MATERIALS] = {
    {4e7, 3e7, 2e3, 0.8, 0.3, 0.0, 0.4, 0.05, 0.02, 0.0},
    {3e7, 2e7, 1e3, 0.9, 0.5, 0.0, 0.5, 0.1, 0.1, 1.0},
    {3e7, 2e7, 1e3, 0.9, 0.5, 0.0, 0.5, 0.1, 0.1, 1.0},
    {1e4, 1e4, 3.0, 0.7, 0.6, 1.0, 0.8, 0.1, 0.0, 0.0},
};

static void scene_fill(struct scene *scene)
{
    memset(scene, 0, sizeof *scene);
    for (int i = 0; i < N + 2; i++) {
        const double radius = cloud_between(&dice, 0.05, 0.1);
        double *x = scene->motion[i].lane, *w = scene->spin[i].lane;
        scene->material[i] = i % 3 == 0;
        for (int k = 0; k < 3; k++) {
            x[k] = cloud_between(&dice, -0.9, 0.9);
            x[4 + k] = cloud_between(&dice, -1.0, 1.0);
            w[4 + k] = cloud_between(&dice, -9.0, 9.0);
            w[k] = radius * w[4 + k];
        }
        x[2] = (i % 2 ? 0.97 : -0.98) * radius;
        x[3] = x[7] = radius;
        w[3] = 1.0 / radius;
        w[7] = 1.0 / (1e4 * radius * radius * radius);
    }
    scene->motion[N].lane[2] = 1e9; /* the dummy */
    for (int i = 0; i <= N; i++)
        scene->contacts[i].sphere = i;
}

static struct facet_kernel_work work_on(struct scene *scene)
{
    return (struct facet_kernel_work){.motion = scene->motion,
                                      .spin = scene->spin,
                                      .force = scene->force,
                                      .material = scene->material,
                                      .n_materials = MATERIALS,
                                      .pairs = PAIRS,
                                      .dummy = &scene->contacts[N],
                                      .dt = 1e-4};
}

static void apply_as_batch(struct scene *scene, struct facet_kernel kernel)
{
    static struct facet_kernel_batch batch;
    struct facet_kernel_work work = work_on(scene);
    for (int i = 0; i < N; i++) {
        const double height = scene->motion[i].lane[2], side = height < 0.0 ? 1.0 : -1.0;
        const int k = batch.n++;
        batch.contact[k] = &scene->contacts[i];
        batch.sphere[k] = i;
        batch.load[k] = &scene->loads[i % 5 == 0];
        batch.pair[k] = &PAIRS[scene->material[i] * MATERIALS];
        for (int x = 0; x < 3; x++) {
            batch.normal[x][k] = x == 2 ? side : 0.0;
            batch.point[x][k] = x == 2 ? 0.0 : scene->motion[i].lane[x];
            batch.wall[x][k] = 0.1 * (x + 1);
            batch.turns[x][k] = 1.0 - x;
        }
        const double overlap = scene->motion[i].lane[3] + side * height;
        batch.overlap[k] = overlap > 0.0 ? overlap : 0.0;
        batch.yield[k] = i % 7 == 0 ? 0.01 : 0.0;
        batch.width[k] = i % 5 == 0 ? 0.7 : 1.0;
    }
    kernel.batch(&work, &batch);
    batch.n = 0;
}

static void apply_as_run(struct scene *scene, struct facet_kernel kernel,
                         const struct body *body)
{
    enum { PADDED = (N + FACET_KERNEL_PAD - 1) / FACET_KERNEL_PAD * FACET_KERNEL_PAD };
    struct facet_contact *contacts[PADDED + FACET_KERNEL_AHEAD + FACET_KERNEL_PAD];
    int spheres[PADDED + FACET_KERNEL_AHEAD + FACET_KERNEL_PAD];
    struct facet_kernel_work work = work_on(scene);
    for (int k = 0; k < PADDED + FACET_KERNEL_AHEAD + FACET_KERNEL_PAD; k++) {
        contacts[k] = &scene->contacts[k < N ? k : N];
        spheres[k] = contacts[k]->sphere;
    }
    kernel.run(&work, &(struct facet_kernel_run){.body = body,
                                                 .face = 0,
                                                 .n = PADDED,
                                                 .contacts = contacts,
                                                 .spheres = spheres,
                                                 .load = &scene->loads[0]});
}

/* On and off the surface, and along it. */
static void scene_move(struct scene *scene, int step)
{
    for (int i = 0; i < N; i++) {
        double *x = scene->motion[i].lane;
        x[0] += 1e-4 * x[4];
        x[2] *= step % 7 < 4 ? 0.98 : 1.03;
        x[6] = step % 7 < 4 ? -0.5 : 0.5;
    }
}

static bool same_loads(const struct scene *a, const struct scene *b)
{
    for (int l = 0; l < 2; l++) {
        struct facet_kernel_load p = a->loads[l], q = b->loads[l];
        for (int s = 0; s < FACET_KERNEL_SUMS; s++) {
            struct exact_sum sum_p = {{0, 0, 0}, 0, 0}, sum_q = {{0, 0, 0}, 0, 0};
            lanes_exact_merge(&p.sums[s], 0, &sum_p);
            lanes_exact_merge(&q.sums[s], 0, &sum_q);
            exact_sum_normalise(&sum_p);
            exact_sum_normalise(&sum_q);
            if (memcmp(sum_p.limb, sum_q.limb, sizeof sum_p.limb) != 0)
                return false;
        }
    }
    return true;
}

static void compare(bool full, bool ledger, const struct body *body)
{
    static struct scene expected, got;
    const struct facet_kernel narrow = facet_kernel_choose(ISA_AUTO, full, ledger);
    const struct facet_kernel wide = wide_blocks().choice[full][ledger];
    int touching = 0, sliding = 0;
    scene_fill(&expected);
    memcpy(&got, &expected, sizeof got);
    for (int step = 0; step < STEPS; step++) {
        if (body == NULL) {
            apply_as_batch(&expected, narrow);
            apply_as_batch(&got, wide);
        } else {
            apply_as_run(&expected, narrow, body);
            apply_as_run(&got, wide, body);
        }
        EXPECT(memcmp(expected.force, got.force, sizeof got.force) == 0);
        EXPECT(memcmp(expected.contacts, got.contacts, sizeof got.contacts) == 0);
        EXPECT(same_loads(&expected, &got));
        for (int i = 0; i < N; i++) {
            touching += got.contacts[i].history[CONTACT_RADIUS_LANE] > 0.0;
            sliding += got.force[i].lane[3] > 0.0;
        }
        scene_move(&expected, step);
        scene_move(&got, step);
    }
    EXPECT(touching > 10 * N && touching < STEPS * N);
    EXPECT(!ledger || sliding > N);
}

TEST(eight_lanes_give_the_same_bits_to_batches)
{
    for (int choice = 0; choice < 4; choice++)
        compare(choice & 1, choice & 2, NULL);
}

TEST(eight_lanes_give_the_same_bits_to_runs)
{
    const struct vec3 corners[4] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 0.5, 0}};
    const int facets[1][4] = {{0, 1, 2, 3}};
    struct body body = {.exists = true,
                        .moves = true,
                        .velocity_now = {0.1, 0.2, 0.3},
                        .spin_now = {1.0, 0.0, -1.0}};
    mesh_build(&body.mesh, 4, corners, 1, facets);
    for (int choice = 0; choice < 4; choice++)
        compare(choice & 1, choice & 2, &body);
    mesh_clear(&body.mesh);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
