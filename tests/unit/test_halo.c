/* Ghosts: every pair within reach that has an owned member has both here, whatever the sizes of
 * spheres and subdomains; what a ghost holds is what its owner holds.
 *
 * ranks: 1 2 3 5
 */
#include "domain/halo.h"

#include <stdlib.h>

#include "base/array.h"
#include "base/comm.h"
#include "check.h"
#include "domain/boxes.h"
#include "domain/rcb.h"
#include "job/job.h"
#include "model/material.h"
#include "random_cloud.h"

enum { N_MAX = 700 };

/* The whole run, known to every rank; row k is the sphere with id k. */
static struct {
    int n;
    double x[N_MAX][3], radius[N_MAX], allowance[N_MAX];
} cloud;

static double density[1] = {2000.0};
static const struct materials materials = {.n = 1, .density = density};

struct scene {
    struct comm comm;
    struct boxes boxes;
    struct spheres spheres;
    struct halo halo;
};

/* Velocities are functions of id and time. */
static double motion_of(int64_t id, int k, int time)
{
    return 0.1 * (double)(id % 13) - 0.01 * k + 0.001 * time;
}

static void set_motion(struct spheres *spheres, int i, int time)
{
    const int64_t id = spheres->id[i];
    for (int k = 0; k < 3; k++) {
        sphere_position(spheres, i)[k] = cloud.x[id][k] + 1e-3 * time * k;
        sphere_velocity(spheres, i)[k] = motion_of(id, k, time);
        sphere_angular_velocity(spheres, i)[k] = motion_of(id, 10 + k, time);
    }
    sphere_complete(spheres, i, &materials);
}

/* Gives the ranks what lies in their boxes, in canonical order, and makes the ghosts. */
static void begin(struct scene *scene)
{
    scene->comm = comm_world();
    boxes_init(&scene->boxes, scene->comm.n_ranks);
    spheres_init(&scene->spheres);
    struct spheres all;
    spheres_init(&all);
    struct rcb_point *points = array_allocate((size_t)cloud.n, sizeof *points);
    for (int id = 0; id < cloud.n; id++) {
        cloud_add(&all, id, cloud.x[id], cloud.radius[id]);
        memcpy(points[id].place, cloud.x[id], sizeof points[id].place);
        points[id].weight = 1;
    }
    rcb_partition(&scene->boxes, &scene->comm, scene->comm.rank == 0 ? cloud.n : 0, points);
    boxes_update(&scene->boxes);
    for (int cell = 0; cell < 23; cell++) {
        for (int id = 0; id < cloud.n; id++) {
            if (all.order_cell[id] != cell ||
                boxes_owner(&scene->boxes, cloud.x[id]) != scene->comm.rank)
                continue;
            const int i = cloud_add(&scene->spheres, id, cloud.x[id], cloud.radius[id]);
            scene->spheres.allowance[i] = cloud.allowance[id];
            set_motion(&scene->spheres, i, 0);
        }
    }
    spheres_clear(&all);
    free(points);
    halo_init(&scene->halo, &scene->comm);
    halo_build(&scene->halo, &scene->comm, &scene->boxes, &scene->spheres, &materials, 0.01);
}

static void end(struct scene *scene)
{
    boxes_clear(&scene->boxes);
    spheres_clear(&scene->spheres);
    halo_clear(&scene->halo);
}

/* Storage index of every id here; -1: not here. */
static int *find_all(const struct scene *scene)
{
    int *at = array_allocate((size_t)cloud.n, sizeof *at);
    for (int id = 0; id < cloud.n; id++)
        at[id] = -1;
    for (int i = 0; i < scene->spheres.n_all; i++) {
        EXPECT(at[scene->spheres.id[i]] == -1); /* nobody twice */
        at[scene->spheres.id[i]] = i;
    }
    return at;
}

static bool may_touch(int a, int b)
{
    double distance2 = 0.0;
    for (int k = 0; k < 3; k++)
        distance2 += (cloud.x[a][k] - cloud.x[b][k]) * (cloud.x[a][k] - cloud.x[b][k]);
    const double reach =
        cloud.radius[a] + cloud.allowance[a] + cloud.radius[b] + cloud.allowance[b];
    return distance2 < reach * reach;
}

/* The reach rule by two nested loops. */
static void expect_complete(const struct scene *scene)
{
    int *at = find_all(scene);
    bool complete = true;
    for (int a = 0; a < cloud.n; a++) {
        const bool mine = boxes_owner(&scene->boxes, cloud.x[a]) == scene->comm.rank;
        EXPECT(mine == (at[a] >= 0 && at[a] < scene->spheres.n_owned));
        for (int b = 0; b < cloud.n && mine; b++)
            complete = complete && (at[b] >= 0 || !may_touch(a, b));
    }
    EXPECT(complete);
    free(at);
}

/* Is it known that the rank's spheres reach the box around a? */
static bool is_reached(const struct scene *scene, int rank, int a)
{
    const double size = cloud.radius[a] + cloud.allowance[a];
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = cloud.x[a][k] - size;
        high[k] = cloud.x[a][k] + size;
    }
    return halo_reaches(&scene->halo, rank, low, high);
}

/* Who may touch things is known to all; returns how many ranks are known not to. */
static int expect_reached(const struct scene *scene)
{
    int n_missed = 0, n_far = 0;
    for (int a = 0; a < cloud.n && scene->comm.n_ranks > 1; a++) {
        for (int b = 0; b < cloud.n; b++)
            n_missed += may_touch(a, b) &&
                        !is_reached(scene, boxes_owner(&scene->boxes, cloud.x[b]), a);
        for (int q = 0; q < scene->comm.n_ranks; q++)
            n_far += !is_reached(scene, q, a);
    }
    EXPECT(n_missed == 0);
    return n_far;
}

/* Ghosts hold what their owners hold at this time, and are in canonical order. */
static void expect_copies(const struct scene *scene, int time)
{
    const struct spheres *spheres = &scene->spheres;
    for (int g = spheres->n_owned; g < spheres->n_all; g++) {
        const int64_t id = spheres->id[g];
        struct spheres one;
        spheres_init(&one);
        cloud_add(&one, id, cloud.x[id], cloud.radius[id]);
        set_motion(&one, 0, time);
        EXPECT(memcmp(&one.motion[0], &spheres->motion[g], sizeof *one.motion) == 0);
        EXPECT(memcmp(&one.spin[0], &spheres->spin[g], sizeof *one.spin) == 0);
        EXPECT(one.order_cell[0] == spheres->order_cell[g] && spheres->material[g] == 0);
        EXPECT(spheres->force[g].lane[0] == 0.0 && spheres->dissipated_damping[g] == 0.0);
        if (g > spheres->n_owned)
            EXPECT(order_before(spheres->order_cell[g - 1], spheres->id[g - 1],
                                spheres->order_cell[g], id));
        spheres_clear(&one);
    }
}

static void expect_classes(const struct scene *scene)
{
    const struct spheres *spheres = &scene->spheres;
    int n_internal = 0;
    for (int i = 0; i < spheres->n_owned; i++) {
        bool internal = true;
        for (int k = 0; k < 3; k++) {
            const double x = sphere_position(spheres, i)[k];
            const double margin = sphere_radius(spheres, i) + 0.01;
            internal = internal && x - margin >= scene->boxes.low[scene->comm.rank][k] &&
                       x + margin <= scene->boxes.high[scene->comm.rank][k];
        }
        n_internal += internal;
    }
    EXPECT(scene->halo.n_internal == n_internal);
    EXPECT(scene->halo.n_interfacial == spheres->n_owned - n_internal);
}

/* Returns how many ghosts there are on all ranks. */
static int64_t check_scene(void)
{
    struct scene scene;
    begin(&scene);
    expect_complete(&scene);
    expect_reached(&scene);
    expect_copies(&scene, 0);
    expect_classes(&scene);
    for (int time = 1; time < 4; time++) {
        for (int i = 0; i < scene.spheres.n_owned; i++)
            set_motion(&scene.spheres, i, time);
        halo_refresh(&scene.halo, &scene.comm, &scene.spheres);
        expect_copies(&scene, time);
    }
    int64_t n = scene.spheres.n_all - scene.spheres.n_owned;
    comm_sum_int(&scene.comm, &n, 1);
    end(&scene);
    return n;
}

static void fill(int n, double sx, double sy, double sz, double radius)
{
    struct cloud_random dice = {13};
    cloud.n = n;
    for (int id = 0; id < n; id++) {
        cloud.x[id][0] = cloud_between(&dice, 0.0, sx);
        cloud.x[id][1] = cloud_between(&dice, 0.0, sy);
        cloud.x[id][2] = cloud_between(&dice, 0.0, sz);
        cloud.radius[id] = radius * cloud_between(&dice, 1.0, 1.1);
        cloud.allowance[id] = 0.1 * radius;
    }
}

TEST(ordinary_scene)
{
    const int n_ranks = comm_world().n_ranks;
    fill(N_MAX, 1.0, 1.0, 1.0, 0.03);
    const int64_t n = check_scene();
    EXPECT(n_ranks == 1 ? n == 0 : n > 50 && n < N_MAX * (n_ranks - 1) / 2);
}

/* A few spheres are larger than the subdomains, others are fast: those few reach far, and do
 * not make everybody else a ghost. */
TEST(spheres_larger_than_subdomains)
{
    const int n_ranks = comm_world().n_ranks;
    fill(N_MAX, 1.0, 1.0, 1.0, 0.02);
    cloud.radius[5] = 0.7;
    cloud.radius[300] = 0.45;
    cloud.allowance[77] = 0.9;
    const int64_t n = check_scene();
    EXPECT(n < N_MAX * n_ranks);
    fill(N_MAX, 1.0, 1.0, 1.0, 0.01);
    for (int id = 0; id < N_MAX; id++)
        cloud.radius[id] *= 1.0 + 19.0 * (double)(id % 31 == 0);
    check_scene();
}

TEST(subdomains_thinner_than_a_radius)
{
    fill(200, 0.5, 1e-3, 1e-3, 0.3);
    check_scene();
    fill(300, 5.0, 0.1, 0.1, 0.3); /* reach over several neighbours */
    check_scene();
}

/* Two spheres that just reach each other over a cut, and just not. */
TEST(at_the_limit_of_reach)
{
    const struct comm comm = comm_world();
    for (int hair = -1; hair <= 1; hair++) {
        cloud.n = 2 * comm.n_ranks;
        for (int id = 0; id < cloud.n; id++) {
            cloud.x[id][0] = id;
            cloud.x[id][1] = cloud.x[id][2] = 0.0;
            cloud.radius[id] = 0.25;
            cloud.allowance[id] = 0.25 + 1e-13 * hair;
        }
        const int64_t n = check_scene();
        if (hair > 0)
            EXPECT(n == 2 * (comm.n_ranks - 1));
    }
}

TEST(few_or_no_spheres)
{
    for (int n = 0; n < 8; n++) {
        fill(n, 1.0, 1.0, 1.0, 0.5);
        check_scene();
    }
    fill(30, 0.0, 0.0, 0.0, 0.5); /* all at one place, with one rank */
    EXPECT(check_scene() == 0);
}

/* The same halo, built again and again as spheres grow and shrink. */
TEST(built_anew)
{
    struct scene scene;
    fill(400, 1.0, 1.0, 1.0, 0.03);
    begin(&scene);
    EXPECT(expect_reached(&scene) >= 100 * (scene.comm.n_ranks - 1));
    for (int round = 0; round < 6; round++) {
        const double radius = round % 2 == 0 ? 0.01 : 0.2;
        for (int id = 0; id < cloud.n; id++)
            cloud.radius[id] = radius;
        for (int i = 0; i < scene.spheres.n_owned; i++) {
            scene.spheres.motion[i].lane[3] = radius;
            set_motion(&scene.spheres, i, 0);
        }
        halo_build(&scene.halo, &scene.comm, &scene.boxes, &scene.spheres, &materials, 0.01);
        expect_complete(&scene);
        expect_copies(&scene, 0);
        halo_refresh(&scene.halo, &scene.comm, &scene.spheres);
        expect_copies(&scene, 0);
    }
    end(&scene);
}

/* Periodic space: for each two and each way round that may bring them within reach, the owner
 * of either has a copy of the other there, exactly a period away, now and after a refresh. */

/* Is there a copy of b whose place is that of b plus the shift? */
static bool has_image(const struct scene *scene, int b, const double shift[3], int time)
{
    const struct spheres *spheres = &scene->spheres;
    for (int i = 0; i < spheres->n_all; i++) {
        const double *x = sphere_position(spheres, i);
        bool same = spheres->id[i] == b;
        for (int k = 0; k < 3; k++)
            same = same && x[k] == cloud.x[b][k] + 0x1p-10 * time * k + shift[k];
        if (same && sphere_velocity(spheres, i)[0] == motion_of(b, 0, time))
            return true;
    }
    return false;
}

static void expect_images(const struct scene *scene, int time)
{
    const struct halo *halo = &scene->halo;
    int n_missing = 0;
    for (int i = 0; i < scene->spheres.n_owned; i++) {
        const int a = (int)scene->spheres.id[i];
        for (int b = 0; b < cloud.n; b++) {
            for (int s = a == b ? 1 : 0; s < halo->n_shifts; s++) {
                double distance2 = 0.0;
                for (int k = 0; k < 3; k++) {
                    const double way = cloud.x[b][k] + halo->shifts[s][k] - cloud.x[a][k];
                    distance2 += way * way;
                }
                const double reach =
                    cloud.radius[a] + cloud.allowance[a] + cloud.radius[b] + cloud.allowance[b];
                const int owner = boxes_owner(&scene->boxes, cloud.x[b]);
                n_missing +=
                    distance2 < reach * reach && (!has_image(scene, b, halo->shifts[s], time) ||
                                                  !is_reached(scene, owner, a));
            }
        }
    }
    EXPECT(n_missing == 0);
}

static void settle(const struct periodic *periodic, double x[3])
{
    const struct vec3 place = periodic_settled(periodic, (struct vec3){x[0], x[1], x[2]});
    memcpy(x, &place.x, 3 * sizeof *x);
}

static void check_images(int directions, double width)
{
    const struct job job = {
        .domain = {true, {0.0, 0.0, 0.0}, {1.0, 1.0, width}, directions, 0}};
    struct scene scene;
    struct periodic periodic;
    periodic_init(&periodic, &job);
    for (int id = 0; id < cloud.n; id++)
        settle(&periodic, cloud.x[id]);
    begin(&scene);
    scene.spheres.periodic = periodic;
    for (int time = 0; time < 3; time++) {
        for (int i = 0; i < scene.spheres.n_owned; i++) {
            set_motion(&scene.spheres, i, time);
            for (int k = 0; k < 3; k++)
                sphere_position(&scene.spheres, i)[k] =
                    cloud.x[scene.spheres.id[i]][k] + 0x1p-10 * time * k;
        }
        if (time == 0)
            halo_build(&scene.halo, &scene.comm, &scene.boxes, &scene.spheres, &materials,
                       0.01);
        else
            halo_refresh(&scene.halo, &scene.comm, &scene.spheres);
        expect_images(&scene, time);
    }
    int64_t n = scene.spheres.n_all - scene.spheres.n_owned;
    comm_sum_int(&scene.comm, &n, 1);
    EXPECT(n > 0 && n < (cloud.n * scene.comm.n_ranks) * 26);
    end(&scene);
}

TEST(images_over_periodic_boundaries)
{
    fill(150, 1.0, 1.0, 1.0, 0.03);
    check_images(1, 1.0);
    check_images(7, 1.0);
    fill(60, 1.0, 1.0, 0.125, 0.02);
    cloud.radius[7] = 0.025; /* the period is 2.5 diameters */
    check_images(4, 0.125);
    fill(60, 1.0, 1.0, 1.0, 0.01);
    cloud.radius[11] = 0.2;
    cloud.allowance[30] = 0.125;
    check_images(3, 1.0);
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    const int status = check_run(argc, argv);
    MPI_Finalize();
    return status;
}
