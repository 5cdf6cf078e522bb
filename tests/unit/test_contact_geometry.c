/*
 * Closest points by feature, against a search for the nearest point of every facet that knows
 * nothing of regions; and the promise that regions leave no gap between them.
 */
#include "check.h"
#include "physics/contact_geometry.h"

#include <stdint.h>
#include <stdlib.h>

static uint64_t random_state = 1;

/* Uniform in [0, 1). */
static double random_number(void)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (double)(random_state >> 11) * 0x1p-53;
}

static double random_between(double low, double high)
{
    return low + (high - low) * random_number();
}

/* A sheet of n x n squares, every other one cut into triangles; `bump` shakes the inner
 * heights. */
static void build_sheet(struct mesh *mesh, int n, double spacing, double bump)
{
    struct vec3 *vertices = calloc((size_t)((n + 1) * (n + 1)), sizeof *vertices);
    int(*facets)[4] = calloc((size_t)(2 * n * n), sizeof *facets);
    for (int j = 0; j <= n; j++)
        for (int i = 0; i <= n; i++)
            vertices[j * (n + 1) + i] = (struct vec3){spacing * (double)i, spacing * (double)j,
                                                      bump * random_between(-1.0, 1.0)};
    int n_facets = 0;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            const int quad[4] = {a, b, c, d}, low[4] = {a, b, c, -1}, high[4] = {a, c, d, -1};
            if ((i + j) % 2 == 0) {
                memcpy(facets[n_facets++], quad, sizeof quad);
            } else {
                memcpy(facets[n_facets++], low, sizeof low);
                memcpy(facets[n_facets++], high, sizeof high);
            }
        }
    mesh_build(mesh, (n + 1) * (n + 1), vertices, n_facets, (const int(*)[4])facets);
    free(vertices);
    free(facets);
}

/* Distance of a point to a triangle: to its plane if the foot is inside, else to the sides. */
static double distance_to_triangle(const struct vec3 p, const struct vec3 corners[3])
{
    const struct vec3 area =
        vec3_cross(vec3_sub(corners[1], corners[0]), vec3_sub(corners[2], corners[0]));
    const struct vec3 normal = vec3_scale(1.0 / vec3_norm(area), area);
    bool inside = true;
    double nearest = (double)INFINITY;
    for (int k = 0; k < 3; k++) {
        const struct vec3 a = corners[k], side = vec3_sub(corners[(k + 1) % 3], a);
        const struct vec3 arm = vec3_sub(p, a);
        double part = vec3_dot(arm, side) / vec3_dot(side, side);
        part = part < 0.0 ? 0.0 : part > 1.0 ? 1.0 : part;
        const double distance = vec3_norm(vec3_axpy(arm, -part, side));
        nearest = distance < nearest ? distance : nearest;
        inside = inside && vec3_dot(vec3_cross(normal, side), arm) >= 0.0;
    }
    return inside ? fabs(vec3_dot(vec3_sub(p, corners[0]), normal)) : nearest;
}

static double distance_to_mesh(const struct mesh *mesh, struct vec3 p)
{
    double nearest = (double)INFINITY;
    for (int f = 0; f < mesh->n_faces; f++) {
        const int *v = mesh->faces[f].vertices;
        for (int k = 2; k < mesh->faces[f].n; k++) {
            const struct vec3 corners[3] = {mesh->place[v[0]], mesh->place[v[k - 1]],
                                            mesh->place[v[k]]};
            const double distance = distance_to_triangle(p, corners);
            nearest = distance < nearest ? distance : nearest;
        }
    }
    return nearest;
}

struct touches {
    int n, n_faces;
    double nearest;
    bool is_sound; /* unit normals, point + distance * normal = centre */
};

static struct touches touches_of(const struct mesh *mesh, struct vec3 centre, double radius)
{
    struct touches touches = {0, 0, (double)INFINITY, true};
    for (int feature = 0; feature < mesh_n_features(mesh); feature++) {
        struct contact_geometry at;
        if (!contact_geometry_touches(mesh, feature, centre, radius, &at))
            continue;
        touches.n++;
        touches.n_faces += feature < mesh->n_faces;
        touches.nearest = at.distance < touches.nearest ? at.distance : touches.nearest;
        const struct vec3 back = vec3_axpy(at.point, at.distance, at.normal);
        touches.is_sound = touches.is_sound && fabs(vec3_norm(at.normal) - 1.0) < 1e-14 &&
                           vec3_norm(vec3_sub(back, centre)) < 1e-14 &&
                           contact_geometry_reaches(mesh, feature, centre, radius);
    }
    return touches;
}

TEST(the_nearest_point_of_a_bumpy_sheet_is_always_held_by_a_feature)
{
    struct mesh mesh;
    build_sheet(&mesh, 5, 0.3, 0.1);
    for (int k = 0; k < 20000; k++) {
        const struct vec3 p = {random_between(-0.4, 1.9), random_between(-0.4, 1.9),
                               random_between(-0.4, 0.4)};
        const struct touches touches = touches_of(&mesh, p, 10.0);
        EXPECT_NEAR(touches.nearest, distance_to_mesh(&mesh, p), 1e-8);
        EXPECT(touches.is_sound);
    }
    mesh_clear(&mesh);
}

TEST(outside_a_convex_body_there_is_one_contact)
{
    const struct vec3 vertices[4] = {{0, 0, 0}, {1, 0, 0}, {0.2, 0.9, 0}, {0.4, 0.3, 0.8}};
    const int facets[4][4] = {{0, 2, 1, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {2, 0, 3, -1}};
    struct mesh mesh;
    mesh_build(&mesh, 4, vertices, 4, facets);
    for (int k = 0; k < 20000; k++) {
        const struct vec3 p = {random_between(-1.0, 2.0), random_between(-1.0, 2.0),
                               random_between(-1.0, 2.0)};
        bool outside = false;
        for (int f = 0; f < 4; f++) {
            const struct vec3 on = mesh.place[mesh.faces[f].vertices[0]];
            outside |= vec3_dot(vec3_sub(p, on), mesh.face_normal[f]) > 0.0;
        }
        if (!outside)
            continue;
        /* The far side's faces are within reach too: what counts is what is nearest. */
        const double nearest = distance_to_mesh(&mesh, p);
        EXPECT(touches_of(&mesh, p, nearest * (1.0 + 1e-9)).n == 1);
    }
    mesh_clear(&mesh);
}

TEST(in_a_concave_corner_every_wall_has_its_contact)
{
    const struct vec3 vertices[7] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                     {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    const int facets[3][4] = {{0, 1, 3, 2}, {0, 4, 5, 1}, {0, 2, 6, 4}};
    struct mesh mesh;
    mesh_build(&mesh, 7, vertices, 3, facets);
    const struct touches corner = touches_of(&mesh, (struct vec3){0.1, 0.1, 0.1}, 0.11);
    EXPECT(corner.n == 3 && corner.n_faces == 3);
    const struct touches groove = touches_of(&mesh, (struct vec3){0.5, 0.1, 0.1}, 0.11);
    EXPECT(groove.n == 2 && groove.n_faces == 2);
    mesh_clear(&mesh);
}

/* Centres over vertices, over seams and a rounding error beside them, far from the origin
 * too. */
TEST(a_flat_seam_has_no_gap)
{
    const double spacings[3] = {0.25, 0.1, 1.0 / 3.0}, radius = 0.1;
    for (int s = 0; s < 3; s++) {
        struct mesh mesh;
        build_sheet(&mesh, 6, spacings[s], 0.0);
        for (int v = 0; v < mesh.n_vertices; v++) {
            const double shift = s == 1 ? 1e4 : 0.0;
            mesh.place[v] = (struct vec3){mesh.place[v].x + shift,
                                          0.6 * mesh.place[v].y - shift, 0.8 * mesh.place[v].y};
        }
        mesh_update(&mesh);
        for (int k = 0; k < 20000; k++) {
            const int f = (int)(random_number() * (double)mesh.n_faces);
            const struct mesh_face *face = &mesh.faces[f];
            const int a = (int)(random_number() * (double)face->n);
            const struct vec3 from = mesh.place[face->vertices[a]];
            const struct vec3 side =
                vec3_sub(mesh.place[face->vertices[(a + 1) % face->n]], from);
            const double part = k % 3 == 0 ? 0.0 : random_number();
            struct vec3 p = vec3_axpy(from, part, side);
            p = vec3_axpy(p, 0.099, mesh.face_normal[f]);
            p.x += k % 2 == 0 ? 0.0 : random_between(-1e-16, 1e-16) * (1.0 + fabs(p.x));
            const struct touches touches = touches_of(&mesh, p, radius);
            EXPECT(touches.n >= 1);
            EXPECT_NEAR(touches.nearest, 0.099, 1e-11);
        }
        mesh_clear(&mesh);
    }
}

TEST(a_facet_has_two_sides)
{
    struct mesh mesh;
    build_sheet(&mesh, 1, 1.0, 0.0);
    struct contact_geometry at;
    EXPECT(contact_geometry_touches(&mesh, 0, (struct vec3){0.5, 0.5, 0.05}, 0.1, &at));
    EXPECT(at.normal.z == 1.0);
    EXPECT(contact_geometry_touches(&mesh, 0, (struct vec3){0.5, 0.5, -0.05}, 0.1, &at));
    EXPECT(at.normal.z == -1.0);
    EXPECT(!contact_geometry_touches(&mesh, 0, (struct vec3){0.5, 0.5, (double)NAN}, 0.1, &at));
    /* A centre exactly on an edge still gets a normal. */
    EXPECT(
        contact_geometry_touches(&mesh, mesh.n_faces, (struct vec3){0.0, 0.5, 0.0}, 0.1, &at) ||
        contact_geometry_touches(&mesh, mesh.n_faces + 1, (struct vec3){0.0, 0.5, 0.0}, 0.1,
                                 &at));
    EXPECT_NEAR(vec3_norm(at.normal), 1.0, 1e-15);
    mesh_clear(&mesh);
}

TEST(what_is_within_reach_is_never_missed)
{
    struct mesh mesh;
    build_sheet(&mesh, 4, 0.3, 0.1);
    for (int k = 0; k < 20000; k++) {
        const struct vec3 p = {random_between(-0.4, 1.6), random_between(-0.4, 1.6),
                               random_between(-0.4, 0.4)};
        const double reach = random_between(0.05, 0.3);
        for (int feature = 0; feature < mesh_n_features(&mesh); feature++) {
            struct contact_geometry at;
            if (contact_geometry_touches(&mesh, feature, p, reach, &at))
                EXPECT(contact_geometry_reaches(&mesh, feature, p, reach * (1.0 + 1e-6)));
        }
    }
    mesh_clear(&mesh);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
