/*
 * Shells and membranes as contacts and elements find them: surfaces cut into elements that
 * share nodes where facets share sides, and skins half the thickness above and below them,
 * closed and seen from outside whatever way round elements go, also where sheets fold, meet
 * three at an edge, or come round with their other side.
 */
#include "check.h"

#include <math.h>
#include <stdlib.h>

#include "base/report.h"
#include "job/job.h"
#include "model/geometry.h"
#include "model/mesh.h"
#include "model/skin.h"
#include "model/solid_mesh.h"
#include "model/solid_quality.h"

static const double PI = 3.14159265358979323846;

static const struct vec3 SQUARE[] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
static const int ONE_QUAD[][4] = {{0, 1, 2, 3}};

/* A shell of these facets; its arrays are its own, to be freed with clear(). */
static struct job_body sheet_of(int n_vertices, const struct vec3 *vertices, int n_facets,
                                const int (*facets)[4], double cell)
{
    struct job_body body = {.name = (char[]){"it"},
                            .model = JOB_MODEL_SHELL,
                            .geometry = JOB_GEOMETRY_MESH,
                            .n_vertices = n_vertices,
                            .n_facets = n_facets,
                            .sheet = {.thickness = 0.1, .cell = cell, .layers = 3}};
    body.vertices = malloc((size_t)n_vertices * sizeof *body.vertices);
    body.facets = malloc((size_t)n_facets * sizeof *body.facets);
    memcpy(body.vertices, vertices, (size_t)n_vertices * sizeof *body.vertices);
    memcpy(body.facets, facets, (size_t)n_facets * sizeof *body.facets);
    return body;
}

static void clear(struct job_body *body)
{
    free(body->vertices);
    free(body->facets);
}

/* ------------------------------------------------------------------------------- elements */

/* How many elements have this side, whichever way round. */
static int n_elements_at(const struct solid_mesh *mesh, int a, int b)
{
    int n = 0;
    for (int e = 0; e < mesh->n_elements; e++) {
        const int *c = mesh->elements[e], m = solid_mesh_n_corners(c);
        for (int k = 0; k < m; k++)
            n += (c[k] == a && c[(k + 1) % m] == b) || (c[k] == b && c[(k + 1) % m] == a);
    }
    return n;
}

struct sides {
    int n_free, n_of_two, n_of_more;
    double longest; /* [m] */
};

static struct sides sides_of(const struct solid_mesh *mesh)
{
    struct sides sides = {0};
    for (int e = 0; e < mesh->n_elements; e++) {
        const int *c = mesh->elements[e], m = solid_mesh_n_corners(c);
        for (int k = 0; k < m; k++) {
            const int a = c[k], b = c[(k + 1) % m], n = n_elements_at(mesh, a, b);
            const double length = vec3_norm(vec3_sub(mesh->nodes[b], mesh->nodes[a]));
            sides.n_free += n == 1;
            sides.n_of_two += n == 2;
            sides.n_of_more += n > 2;
            sides.longest = length > sides.longest ? length : sides.longest;
        }
    }
    return sides;
}

static void expect_fine(const struct solid_mesh *mesh, double area)
{
    struct mistakes mistakes;
    double volume = 0.0;
    mistakes_init(&mistakes);
    solid_quality_check(mesh, "it", "f", (struct job_place){0, 0}, &mistakes);
    EXPECT(mistakes.n == 0);
    mistakes_clear(&mistakes);
    for (int e = 0; e < mesh->n_elements; e++)
        volume += solid_quality_volume(mesh, e);
    EXPECT_NEAR(volume, 0.1 * area, 1e-14);
}

TEST(a_quad_becomes_cells_no_wider_than_asked)
{
    struct job_body body = sheet_of(4, SQUARE, 1, ONE_QUAD, 0.3);
    struct solid_mesh mesh;
    solid_mesh_build(&mesh, &body);
    EXPECT(mesh.n_elements == 7 * 4 && mesh.n_nodes == 8 * 5);
    const struct sides sides = sides_of(&mesh);
    EXPECT(sides.n_free == 2 * (7 + 4) && sides.n_of_more == 0);
    EXPECT_NEAR(sides.longest, 2.0 / 7.0, 1e-15);
    EXPECT(solid_mesh_find(&mesh, "rim")->n_nodes == sides.n_free);
    EXPECT(solid_mesh_find(&mesh, "surface")->n_sides == mesh.n_elements);
    expect_fine(&mesh, 2.0);
    solid_mesh_clear(&mesh);
    body.sheet.cell = 0.0; /* each facet is one */
    solid_mesh_build(&mesh, &body);
    EXPECT(mesh.n_elements == 1 && mesh.n_nodes == 4);
    solid_mesh_clear(&mesh);
    clear(&body);
}

/* A quad beside a triangle, with vertices of their own at the side that they share. */
TEST(facets_that_share_a_side_share_its_nodes)
{
    const struct vec3 vertices[] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0},
                                    {2, 1, 0}, {2, 0, 0}, {3, 0, 1}};
    const int facets[][4] = {{0, 1, 2, 3}, {4, 5, 6, -1}};
    struct job_body body = sheet_of(7, vertices, 2, facets, 0.3);
    struct solid_mesh mesh;
    solid_mesh_build(&mesh, &body);
    /* the longest side of the triangle, sqrt 3, wants 6 pieces, and so have all of its sides;
     * the quad's side that it shares, too, and the one opposite */
    EXPECT(mesh.n_elements == 7 * 6 + 36 && mesh.n_nodes == 8 * 7 + 7 * 8 / 2 - 7);
    const struct sides sides = sides_of(&mesh);
    EXPECT(sides.n_free == 7 + 7 + 6 + 6 + 6 && sides.n_of_more == 0);
    EXPECT(sides.longest <= 0.3);
    EXPECT(solid_mesh_find(&mesh, "rim")->n_nodes == sides.n_free);
    expect_fine(&mesh, 2.0 + 0.5 * sqrt(2.0));
    solid_mesh_clear(&mesh);
    clear(&body);
}

/* Pieces go on through quads: a long strip has the pieces of its widest cell all along. */
TEST(pieces_go_on_through_opposite_sides)
{
    const struct vec3 vertices[] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0},
                                    {1, 3, 0}, {2, 0, 0}, {2, 1, 0}};
    const int facets[][4] = {{0, 2, 3, 1}, {2, 4, 5, 3}};
    struct job_body body = sheet_of(6, vertices, 2, facets, 1.0);
    struct solid_mesh mesh;
    solid_mesh_build(&mesh, &body);
    /* 3 pieces upwards; sides along the strip are 1 and sqrt 5 long: 3 pieces, too */
    EXPECT(mesh.n_elements == 2 * 9 && mesh.n_nodes == 4 * 7);
    EXPECT(sides_of(&mesh).longest <= 1.0);
    expect_fine(&mesh, 4.0);
    solid_mesh_clear(&mesh);
    clear(&body);
}

TEST(closed_bodies_have_no_rim)
{
    struct job_body body = {.name = (char[]){"it"},
                            .model = JOB_MODEL_SHELL,
                            .geometry = JOB_GEOMETRY_TUBE,
                            .from = {0, 0, 0},
                            .to = {0, 0, 1},
                            .inner = 0.4,
                            .outer = 0.5,
                            .segments = 12,
                            .sheet = {.thickness = 0.1, .cell = 0.25, .layers = 3}};
    struct solid_mesh mesh;
    solid_mesh_build(&mesh, &body);
    const struct sides sides = sides_of(&mesh);
    EXPECT(sides.n_free == 0 && sides.n_of_more == 0 && sides.n_of_two == 4 * mesh.n_elements);
    EXPECT(solid_mesh_find(&mesh, "rim")->n_nodes == 0);
    solid_mesh_clear(&mesh);
}

/* ----------------------------------------------------------------------------------- skin */

static int root_of(const int *parents, int k)
{
    while (parents[k] != k)
        k = parents[k];
    return k;
}

/* Pieces of a surface that have no vertex in common; the volume of each must be positive. */
static int count_parts(const struct mesh *mesh)
{
    int *parents = malloc((size_t)mesh->n_vertices * sizeof *parents), n = 0;
    double *volume = calloc((size_t)mesh->n_vertices, sizeof *volume);
    for (int v = 0; v < mesh->n_vertices; v++)
        parents[v] = v;
    for (int f = 0; f < mesh->n_faces; f++)
        for (int k = 1; k < 3; k++) {
            const int a = root_of(parents, mesh->faces[f].vertices[0]);
            const int b = root_of(parents, mesh->faces[f].vertices[k]);
            parents[a > b ? a : b] = a > b ? b : a;
        }
    for (int f = 0; f < mesh->n_faces; f++) {
        const int *v = mesh->faces[f].vertices;
        volume[root_of(parents, v[0])] +=
            vec3_dot(mesh->place[v[0]], vec3_cross(mesh->place[v[1]], mesh->place[v[2]])) / 6.0;
    }
    for (int v = 0; v < mesh->n_vertices; v++) {
        n += parents[v] == v;
        EXPECT(parents[v] != v || volume[v] > 0.0);
    }
    free(parents);
    free(volume);
    return n;
}

/* Closed, seen from outside, in so many parts, of this volume. */
static void expect_skin(const struct job_body *body, int n_parts, double volume,
                        double tolerance)
{
    struct mesh mesh;
    geometry_build_mesh(&mesh, body);
    const struct mesh_survey survey = mesh_survey(&mesh);
    EXPECT(survey.closed && survey.n_open == 0 && survey.n_shared == 0 && survey.n_turned == 0);
    EXPECT(mesh.n_degenerate == 0 && mesh.n_duplicates == 0);
    EXPECT_NEAR(survey.volume, volume, tolerance);
    EXPECT(count_parts(&mesh) == n_parts);
    mesh_clear(&mesh);
}

TEST(the_skin_of_a_plane_holds_area_times_thickness)
{
    struct job_body body = sheet_of(4, SQUARE, 1, ONE_QUAD, 0.3);
    struct mesh mesh;
    expect_skin(&body, 1, 0.2, 1e-15);
    geometry_build_mesh(&mesh, &body);
    for (int v = 0; v < mesh.n_vertices; v++)
        EXPECT(mesh.place[v].z == 0.05 || mesh.place[v].z == -0.05 || v >= mesh.n_corners);
    mesh_clear(&mesh);
    clear(&body);
    const int triangles[][4] = {{0, 1, 2, -1}, {0, 2, 3, -1}};
    body = sheet_of(4, SQUARE, 2, triangles, 0.3);
    expect_skin(&body, 1, 0.2, 1e-15);
    clear(&body);
}

/* Whatever way round facets go, the skin is seen from outside. */
TEST(the_skin_looks_outwards_though_facets_go_round_differently)
{
    const struct vec3 vertices[] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0},
                                    {0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {3, 1, 0}};
    for (int turned = 0; turned < 16; turned++) {
        int facets[4][4] = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, -1}, {2, 7, 6, -1}};
        for (int f = 0; f < 4; f++)
            for (int k = 0; k < 2 && (turned >> f & 1) != 0; k++) {
                const int last = facets[f][3] < 0 ? 2 : 3, swap = facets[f][k];
                if (k < last - k) {
                    facets[f][k] = facets[f][last - k];
                    facets[f][last - k] = swap;
                }
            }
        struct job_body body = sheet_of(8, vertices, 4, (const int(*)[4])facets, 0.5);
        expect_skin(&body, 1, 0.3, 1e-14);
        clear(&body);
    }
}

/* A strip bent by this at x = 0 [degrees]. */
static struct job_body fold_of(double angle)
{
    const double c = cos(angle * PI / 180.0), s = sin(angle * PI / 180.0);
    const struct vec3 vertices[] = {{-1, 0, 0}, {0, 0, 0}, {c, 0, s},
                                    {-1, 1, 0}, {0, 1, 0}, {c, 1, s}};
    const int facets[][4] = {{0, 1, 4, 3}, {1, 2, 5, 4}};
    return sheet_of(6, vertices, 2, facets, 0.4);
}

TEST(a_gentle_fold_goes_on_and_a_sharp_one_is_two_parts)
{
    struct job_body body = fold_of(35.0);
    /* Arms at the fold lie between both normals, so what is cut off inside is added outside;
     * the thickness there is along them, less by the cosine of half the angle. */
    const double half = cos(17.5 * PI / 180.0), cell = 1.0 / 3.0;
    expect_skin(&body, 1, 0.2 - 2.0 * cell * 0.1 * 0.5 * (1.0 - half), 1e-14);
    clear(&body);
    body = fold_of(45.0);
    expect_skin(&body, 2, 0.2, 1e-14);
    clear(&body);
    body = fold_of(120.0);
    expect_skin(&body, 2, 0.2, 1e-14);
    clear(&body);
}

TEST(three_sheets_at_an_edge_are_three_parts)
{
    const struct vec3 vertices[] = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1},
                                    {-1, 1, 0}, {0, 1, 0}, {1, 1, 0}, {0, 1, 1}};
    const int facets[][4] = {{0, 1, 5, 4}, {1, 2, 6, 5}, {1, 3, 7, 5}};
    struct job_body body = sheet_of(8, vertices, 3, facets, 0.3);
    struct solid_mesh mesh;
    solid_mesh_build(&mesh, &body);
    EXPECT(sides_of(&mesh).n_of_more == 3 * 4);
    solid_mesh_clear(&mesh);
    expect_skin(&body, 3, 0.3, 1e-14);
    clear(&body);
}

/* A smooth sheet that meets itself at one sharp edge, as a wing's does: apart there alone. */
TEST(a_sheet_that_comes_round_to_a_sharp_edge_is_one_part)
{
    enum { N = 32 };
    struct vec3 vertices[2 * N];
    int facets[N][4];
    for (int k = 0; k < N; k++) {
        /* both sides leave the edge at x = 1 along x */
        const double phi = 2.0 * PI * k / N, up = sin(0.5 * phi);
        vertices[k] = (struct vec3){cos(phi), 0, sin(phi) * up * up};
        vertices[N + k] = vec3_add(vertices[k], (struct vec3){0, 1, 0});
        const int next = (k + 1) % N;
        const int facet[4] = {k, next, N + next, N + k};
        memcpy(facets[k], facet, sizeof facet);
    }
    struct job_body body = sheet_of(2 * N, vertices, N, (const int(*)[4])facets, 0.0);
    struct solid_mesh mesh;
    body.sheet.thickness = 0.01;
    solid_mesh_build(&mesh, &body);
    struct skin skin;
    skin_build(&skin, &mesh);
    EXPECT(skin.n_rings == 2 * N + 2); /* the edge's two nodes have two */
    double area = 0.0;
    for (int e = 0; e < mesh.n_elements; e++)
        area += solid_quality_volume(&mesh, e) / 0.01;
    skin_clear(&skin);
    solid_mesh_clear(&mesh);
    expect_skin(&body, 1, 0.01 * area, 0.1 * 0.01 * area);
    clear(&body);
}

/* A band with a single side has a border all the same. */
TEST(a_band_with_one_side_has_a_closed_skin)
{
    enum { N = 24 };
    struct vec3 vertices[2 * N];
    int facets[N][4];
    for (int k = 0; k < N; k++) {
        const double phi = 2.0 * PI * k / N, c = cos(0.5 * phi), s = sin(0.5 * phi);
        for (int side = 0; side < 2; side++) {
            const double w = side == 0 ? -0.2 : 0.2, r = 1.0 + w * c;
            vertices[2 * k + side] = (struct vec3){r * cos(phi), r * sin(phi), w * s};
        }
        const int a = 2 * k, b = 2 * ((k + 1) % N), twist = k + 1 == N;
        const int facet[4] = {a, b + twist, b + 1 - twist, a + 1};
        memcpy(facets[k], facet, sizeof facet);
    }
    struct job_body body = sheet_of(2 * N, vertices, N, (const int(*)[4])facets, 0.0);
    body.sheet.thickness = 0.01;
    expect_skin(&body, 1, 0.01 * 0.4 * 2.0 * PI, 0.02 * 0.01 * 0.4 * 2.0 * PI);
    clear(&body);
}

/* Vertices stand half the thickness off along the mean of the normals around a node. */
TEST(arms_lie_along_mean_normals)
{
    struct job_body body = fold_of(30.0);
    struct solid_mesh mesh;
    struct skin skin;
    solid_mesh_build(&mesh, &body);
    skin_build(&skin, &mesh);
    struct vec3 normals[64], vertices[128];
    EXPECT(skin.n_sheets <= 64 && skin.n_vertices <= 128 && skin.n_plain == 0);
    for (int s = 0; s < skin.n_sheets; s++)
        normals[s] = skin_normal(&skin.sheets[s], &mesh.nodes->x, 3);
    skin_place(&skin, mesh.nodes, vertices);
    const double tilt[3] = {0.0, -sin(15.0 * PI / 180.0), -sin(30.0 * PI / 180.0)};
    for (int r = 0; r < skin.n_rings; r++) {
        const struct vec3 at = mesh.nodes[skin.rings[r].node],
                          arm = skin_arm(&skin, r, normals);
        const int where = at.x < -1e-9 ? 0 : at.x < 1e-9 ? 1 : 2;
        EXPECT_NEAR(vec3_norm(arm), 0.05, 1e-16);
        EXPECT_NEAR(arm.x, 0.05 * tilt[where], 1e-15);
        EXPECT_NEAR(arm.y, 0.0, 1e-16);
        const struct vec3 above = vec3_add(at, arm), below = vec3_sub(at, arm);
        EXPECT(memcmp(&vertices[2 * r], &above, sizeof above) == 0);
        EXPECT(memcmp(&vertices[2 * r + 1], &below, sizeof below) == 0);
    }
    skin_clear(&skin);
    solid_mesh_clear(&mesh);
    clear(&body);
}

/* Where sheets of two thicknesses meet, the surface goes over from one to the other. */
TEST(thickness_goes_over_where_it_changes)
{
    const struct vec3 vertices[] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0},
                                    {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
    const int facets[][4] = {{0, 1, 4, 3}, {1, 2, 5, 4}};
    struct job_body body = sheet_of(6, vertices, 2, facets, 0.0);
    struct job_set right = {
        .name = (char[]){"right"},
        .region = {.kind = JOB_REGION_BOX, .min = {0.9, -1, -1}, .max = {3, 2, 1}}};
    struct job_thickness thick = {.set = right.name, .thickness = 0.3};
    body.solid.n_sets = body.solid.n_thicknesses = 1;
    body.solid.sets = &right;
    body.solid.thicknesses = &thick;
    expect_skin(&body, 1, 0.5 * (0.1 + 0.2) + 0.5 * (0.2 + 0.3), 1e-14);
    clear(&body);
}

/* ------------------------------------------------------------------------- sheets on solids */

/* A block of 2 m x 1 m x 1 m with sheets on these sets. */
static struct job_body block_of(int n_shells, struct job_shell *shells)
{
    return (struct job_body){
        .name = (char[]){"it"},
        .model = JOB_MODEL_SOLID,
        .max = {2.0, 1.0, 1.0},
        .sheet.layers = 3,
        .solid = {
            .kind = JOB_MESH_BOX, .cells = {4, 2, 2}, .n_shells = n_shells, .shells = shells}};
}

TEST(sheets_on_a_solid_make_it_higher_by_half_their_thickness)
{
    struct job_shell shells[] = {
        {.set = (char[]){"z_max"}, .thickness = 0.1},
        {.set = (char[]){"x_min"}, .thickness = 0.2, .model = JOB_SHELL_MEMBRANE}};
    struct job_body body = block_of(2, shells);
    struct solid_mesh mesh;
    solid_mesh_build(&mesh, &body);
    EXPECT(mesh.n_elements == 16 + 8 + 4 && mesh.n_nodes == 5 * 3 * 3);
    EXPECT(solid_mesh_find(&mesh, "z_max")->n_elements == 8);
    EXPECT(solid_mesh_find(&mesh, "all")->n_elements == mesh.n_elements);
    EXPECT(mesh.sheets[15].thickness == 0.0 && mesh.sheets[16].thickness == 0.1);
    EXPECT(mesh.sheets[27].membrane && !mesh.sheets[16].membrane);
    solid_mesh_clear(&mesh);
    expect_skin(&body, 1, 2.0 + 2.0 * 0.05 + 1.0 * 0.1, 1e-14);
}

TEST(sheets_all_over_a_solid)
{
    struct job_shell shell = {.set = (char[]){"surface"}, .thickness = 0.1};
    struct job_body body = block_of(1, &shell);
    struct solid_mesh mesh;
    struct skin skin;
    expect_skin(&body, 1, 2.0 + 10.0 * 0.05, 1e-14);
    solid_mesh_build(&mesh, &body);
    skin_build(&skin, &mesh);
    EXPECT(skin.n_both == 0 && skin.n_sheets == 40); /* rims come down to edges alone */
    EXPECT(skin.n_plain == 4 * 5 + 8 * 3 - 2 * 8);
    skin_clear(&skin);
    solid_mesh_clear(&mesh);
}

/* A set of sides in the middle: rims within a flat face. */
TEST(a_sheet_on_a_part_of_a_side)
{
    struct job_shell shell = {.set = (char[]){"some"}, .thickness = 0.1};
    struct job_set some = {
        .name = (char[]){"some"},
        .region = {.kind = JOB_REGION_BOX, .min = {0.4, -1, 0.9}, .max = {1.1, 2, 1.1}}};
    struct job_body body = block_of(1, &shell);
    body.solid.n_sets = 1;
    body.solid.sets = &some;
    expect_skin(&body, 1, 2.0 + 0.5 * 0.05, 1e-14);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
