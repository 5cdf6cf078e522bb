/*
 * What a ball covers of faces and how much of it lies behind them: against a half-space, which
 * faces together make up, and against what the volume changes by when a vertex moves.
 */
#include <stdlib.h>

#include "check.h"
#include "physics/contact_patch.h"
#include "random_cloud.h"

static const double PI = 3.14159265358979323846;

/* Squares of 1 m about the origin, n a side, each four triangles about its mean; inner vertices
 * are moved at random, by `across` within the plane and by `up` across it. */
static void build_floor(struct mesh *mesh, int n, double across, double up,
                        struct cloud_random *random)
{
    struct vec3 *vertices = calloc((size_t)((n + 1) * (n + 1)), sizeof *vertices);
    int(*facets)[4] = calloc((size_t)(n * n), sizeof *facets);
    for (int j = 0; j <= n; j++)
        for (int i = 0; i <= n; i++) {
            const bool moves = i > 0 && j > 0 && i < n && j < n;
            struct vec3 *v = &vertices[j * (n + 1) + i];
            *v = (struct vec3){(double)i - 0.5 * n, (double)j - 0.5 * n, 0.0};
            if (!moves)
                continue;
            v->x += across * (2.0 * cloud_unit(random) - 1.0);
            v->y += across * (2.0 * cloud_unit(random) - 1.0);
            v->z += up * (2.0 * cloud_unit(random) - 1.0);
        }
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            const int a = j * (n + 1) + i;
            const int quad[4] = {a, a + 1, a + n + 2, a + n + 1};
            memcpy(facets[j * n + i], quad, sizeof quad);
        }
    mesh_build_skin(mesh, (n + 1) * (n + 1), vertices, n * n, (const int(*)[4])facets);
    free(vertices);
    free(facets);
}

struct covered {
    double area, volume;
    struct vec3 moment, facing;
};

static struct covered cover(const struct mesh *mesh, struct vec3 centre, double radius)
{
    struct covered all = {0};
    for (int f = 0; f < mesh->n_faces; f++) {
        struct contact_patch patch;
        if (!contact_patch_cut(mesh, f, centre, radius, &patch))
            continue;
        struct vec3 middle = {0, 0, 0};
        double sum = 0.0;
        for (int k = 0; k < 3; k++) {
            const struct vec3 place = mesh->place[mesh->faces[f].vertices[k]];
            EXPECT(patch.weights[k] > -1e-12);
            middle = vec3_axpy(middle, patch.weights[k] / patch.area, place);
            sum += patch.weights[k];
        }
        EXPECT_NEAR(sum, patch.area, 1e-12 * patch.area);
        EXPECT_NEAR(vec3_norm(vec3_sub(middle, patch.middle)), 0.0, 1e-9);
        all.area += patch.area;
        all.volume += patch.volume;
        all.moment = vec3_axpy(all.moment, patch.area, patch.middle);
        all.facing = vec3_axpy(all.facing, patch.area, mesh->face_normal[f]);
    }
    return all;
}

/* However the plane is cut up, and wherever the ball is: area, middle and volume are a cap's,
 * and so is the depth that follows. */
TEST(faces_in_a_plane_are_a_plane)
{
    struct cloud_random random = {3};
    for (int k = 0; k < 4000; k++) {
        struct mesh mesh;
        build_floor(&mesh, 6, 0.4, 0.0, &random);
        const double radius = 0.1 + 2.0 * cloud_unit(&random);
        const double share = cloud_unit(&random), deep = radius * share * share * share;
        const double height = radius - deep;
        const struct vec3 centre = {cloud_unit(&random) - 0.5, cloud_unit(&random) - 0.5,
                                    height};
        const struct covered got = cover(&mesh, centre, radius);
        const double square = deep * (2.0 * radius - deep);
        const double cap = PI * deep * deep * (radius - deep / 3.0);
        const double off = 1e-14 * radius * radius * radius / cap;
        if (off < 1e-3) {
            EXPECT_NEAR(got.area, PI * square, 1e-13 * PI * radius * radius);
            EXPECT_NEAR(got.volume, cap, (1e-13 + off) * cap);
            EXPECT_NEAR(contact_patch_depth(got.volume, radius), deep, (1e-12 + off) * deep);
            EXPECT_NEAR(got.moment.x, got.area * centre.x, 1e-13);
            EXPECT_NEAR(got.moment.y, got.area * centre.y, 1e-13);
        }
        mesh_clear(&mesh);
    }
}

TEST(depth_is_that_of_the_volume)
{
    for (int k = 1; k <= 1000; k++) {
        const double radius = 0.7, deep = radius * (double)k / 1000.0;
        const double volume = PI * deep * deep * (radius - deep / 3.0);
        EXPECT_NEAR(contact_patch_depth(volume, radius), deep, 1e-14 * radius);
        EXPECT_NEAR(contact_patch_depth(1e-18 * volume, radius),
                    sqrt(1e-18 * volume / (PI * radius)), 1e-8 * 1e-9 * radius);
    }
    EXPECT_NEAR(contact_patch_depth(3.0, 1.0), 1.0, 0.0);
}

/* What vertex v, and the mean points that go with it, have of area times normal. */
static struct vec3 pushed(const struct mesh *mesh, int v, struct vec3 centre, double radius)
{
    struct vec3 sum = {0, 0, 0};
    for (int f = 0; f < mesh->n_faces; f++) {
        struct contact_patch patch;
        if (!contact_patch_cut(mesh, f, centre, radius, &patch))
            continue;
        for (int k = 0; k < 3; k++) {
            const int vertex = mesh->faces[f].vertices[k];
            double part = vertex == v ? 1.0 : 0.0;
            for (int m = 0; m < 4 && vertex >= mesh->n_corners; m++)
                part += mesh->mean_of[vertex - mesh->n_corners][m] == v ? 0.25 : 0.0;
            sum = vec3_axpy(sum, part * patch.weights[k], mesh->face_normal[f]);
        }
    }
    return sum;
}

static void move_vertex(struct mesh *mesh, int v, double dx, double dy, double dz)
{
    mesh->place[v] = vec3_add(mesh->place[v], (struct vec3){dx, dy, dz});
    for (int w = mesh->n_corners; w < mesh->n_vertices; w++) {
        struct vec3 mean = {0, 0, 0};
        for (int m = 0; m < 4; m++)
            mean = vec3_axpy(mean, 0.25, mesh->place[mesh->mean_of[w - mesh->n_corners][m]]);
        mesh->place[w] = mean;
    }
    mesh_update(mesh);
}

/* In dents and on humps the volume changes by what vertices have of areas and normals, however
 * they move, and by all of it where the ball moves: so the force is that of a potential. */
TEST(the_volume_changes_by_areas)
{
    enum { N = 5 };
    const double step = 1e-5;
    struct cloud_random random = {11};
    for (int k = 0; k < 300; k++) {
        struct mesh mesh;
        build_floor(&mesh, N, 0.3, 0.25, &random);
        const double radius = 0.6 + cloud_unit(&random);
        const struct vec3 centre = {0.6 * cloud_unit(&random) - 0.3,
                                    0.6 * cloud_unit(&random) - 0.3, 0.75 * radius};
        const double size = radius * radius;
        for (int v = 0; v < mesh.n_corners; v++) {
            const struct vec3 push = pushed(&mesh, v, centre, radius);
            for (int x = 0; x < 3; x++) {
                const double d[3] = {x == 0 ? step : 0.0, x == 1 ? step : 0.0,
                                     x == 2 ? step : 0.0};
                move_vertex(&mesh, v, d[0], d[1], d[2]);
                const double more = cover(&mesh, centre, radius).volume;
                move_vertex(&mesh, v, -2.0 * d[0], -2.0 * d[1], -2.0 * d[2]);
                const double less = cover(&mesh, centre, radius).volume;
                move_vertex(&mesh, v, d[0], d[1], d[2]);
                const double across = x == 0 ? push.x : x == 1 ? push.y : push.z;
                EXPECT_NEAR((more - less) / (2.0 * step), across, 3e-8 * size);
            }
        }
        const struct vec3 up = {0.0, 0.0, step}, facing = cover(&mesh, centre, radius).facing;
        const double higher = cover(&mesh, vec3_add(centre, up), radius).volume;
        const double lower = cover(&mesh, vec3_sub(centre, up), radius).volume;
        EXPECT_NEAR((higher - lower) / (2.0 * step), -facing.z, 3e-8 * size);
        mesh_clear(&mesh);
    }
}

/* A ball on an edge, a corner or a side of a cube, against points thrown into it; and the area
 * of a closed surface's piece in it. */
TEST(the_volume_is_what_ball_and_body_share)
{
    const struct vec3 corners[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                    {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    const int facets[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                              {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    struct cloud_random random = {7};
    struct mesh mesh;
    mesh_build_skin(&mesh, 8, corners, 6, facets);
    for (int k = 0; k < 40; k++) {
        const double radius = 0.4 + 0.3 * cloud_unit(&random);
        struct vec3 centre = {cloud_between(&random, -0.5, 1.5),
                              cloud_between(&random, -0.5, 1.5), 1.0};
        centre.z += k % 2 == 0 ? 0.6 * radius : 0.02; /* above the top, or beside it */
        if (k % 2 != 0)
            centre.x = 1.0 + 0.5 * radius;
        int inside = 0;
        enum { POINTS = 40000 };
        for (int p = 0; p < POINTS;) {
            double d[3];
            for (int x = 0; x < 3; x++)
                d[x] = cloud_between(&random, -1.0, 1.0);
            if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] > 1.0)
                continue;
            const struct vec3 at = vec3_axpy(centre, radius, (struct vec3){d[0], d[1], d[2]});
            inside += at.x > 0 && at.x < 1 && at.y > 0 && at.y < 1 && at.z > 0 && at.z < 1;
            p++;
        }
        const double ball = 4.0 / 3.0 * PI * radius * radius * radius;
        EXPECT_NEAR(cover(&mesh, centre, radius).volume, ball * inside / POINTS, 0.01 * ball);
    }
    mesh_clear(&mesh);
}

TEST(a_face_out_of_reach_is_not_covered)
{
    struct mesh mesh;
    struct cloud_random random = {1};
    struct contact_patch patch;
    build_floor(&mesh, 1, 0.0, 0.0, &random);
    EXPECT(contact_patch_cut(&mesh, 0, (struct vec3){0.0, -0.1, 0.9}, 1.0, &patch));
    EXPECT(patch.volume > 0.0);
    EXPECT(contact_patch_cut(&mesh, 0, (struct vec3){0.0, -0.1, -0.9}, 1.0, &patch));
    EXPECT(patch.volume < 0.0);
    EXPECT(!contact_patch_cut(&mesh, 0, (struct vec3){0.0, -0.1, 1.0}, 1.0, &patch));
    EXPECT(!contact_patch_cut(&mesh, 0, (struct vec3){0.0, -2.0, 0.9}, 1.0, &patch));
    EXPECT(!contact_patch_cut(&mesh, 0, (struct vec3){0.0, (double)NAN, 0.9}, 1.0, &patch));
    mesh_clear(&mesh);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
