/*
 * Meshes of solids: shapes have the volumes and surfaces of their polygons and tend to those of
 * the round ones; neighbours share whole sides; sets are complete; files of Gmsh, written here
 * in all four formats, give back the same mesh and sets; each fault is found and told.
 */
#include "check.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/report.h"
#include "job/job.h"
#include "model/gmsh.h"
#include "model/solid_condition.h"
#include "model/solid_mesh.h"
#include "model/solid_quality.h"
#include "solid/solid_table.h"

static const double PI = 3.14159265358979323846;

static struct job_body box_of(int x, int y, int z)
{
    return (struct job_body){.model = JOB_MODEL_SOLID,
                             .min = {-1.0, 0.3, 2.0},
                             .max = {1.0, 1.2, 2.5},
                             .solid = {.kind = JOB_MESH_BOX, .cells = {x, y, z}}};
}

static struct job_body cylinder_of(int across, int rim, int along)
{
    return (struct job_body){
        .model = JOB_MODEL_SOLID,
        .from = {1.0, 2.0, 3.0},
        .to = {1.0, 2.6, 3.8}, /* of length 1 */
        .radius = 0.5,
        .solid = {.kind = JOB_MESH_CYLINDER, .cells = {across, rim, along}}};
}

static struct job_body tube_of(int around, int through, int along)
{
    return (struct job_body){
        .model = JOB_MODEL_SOLID,
        .from = {0.0, 0.0, 0.0},
        .to = {2.0, 0.0, 0.0},
        .inner = 0.4,
        .outer = 0.5,
        .solid = {.kind = JOB_MESH_TUBE, .cells = {around, through, along}}};
}

/* ---------------------------------------------------------------------------------- shapes */

/* A side that two elements share turns one way for the one, the other way for the other. */
static bool are_opposite(const int *a, const int *b, int n)
{
    for (int shift = 0; shift < n; shift++) {
        bool same = true;
        for (int k = 0; k < n; k++)
            same = same && a[k] == b[(shift + n - k) % n];
        if (same)
            return true;
    }
    return false;
}

static void expect_conforming(const struct solid_mesh *mesh)
{
    int *partners = solid_mesh_partners(mesh), n_outside = 0, n_inside = 0, n_all = 0;
    for (int number = 0; number < SOLID_MESH_SIDES * mesh->n_elements; number++) {
        const int partner = partners[number];
        int a[4], b[4];
        EXPECT(partner != SOLID_MESH_SEVERAL);
        n_outside += partner == SOLID_MESH_OUTSIDE;
        n_all += partner != SOLID_MESH_NO_SIDE;
        if (partner < 0)
            continue;
        n_inside++;
        EXPECT(partners[partner] == number && partner / SOLID_MESH_SIDES != number / 6);
        const int n = solid_mesh_side_nodes(mesh->elements[number / 6], number % 6, a);
        EXPECT(solid_mesh_side_nodes(mesh->elements[partner / 6], partner % 6, b) == n);
        EXPECT(are_opposite(a, b, n));
    }
    EXPECT(n_outside + n_inside == n_all);
    EXPECT(solid_mesh_find(mesh, "surface")->n_sides == n_outside);
    free(partners);
}

static struct vec3 side_normal(const struct solid_mesh *mesh, struct solid_mesh_side side)
{
    int n[4];
    solid_mesh_side_nodes(mesh->elements[side.element], side.side, n);
    const struct vec3 a = vec3_sub(mesh->nodes[n[1]], mesh->nodes[n[0]]);
    const struct vec3 normal = vec3_cross(a, vec3_sub(mesh->nodes[n[2]], mesh->nodes[n[0]]));
    return vec3_scale(1.0 / vec3_norm(normal), normal);
}

/* The set's nodes are those that its sides have, all on one plane, whose normal they have. */
static void expect_plane(const struct solid_mesh *mesh, const char *name, struct vec3 point,
                         struct vec3 normal, int n_nodes, int n_sides)
{
    const struct solid_mesh_set *set = solid_mesh_find(mesh, name);
    int n_on = 0;
    EXPECT(set != NULL && set->n_nodes == n_nodes && set->n_sides == n_sides);
    if (set == NULL)
        return;
    for (int k = 0; k < mesh->n_nodes; k++)
        n_on += fabs(vec3_dot(normal, vec3_sub(mesh->nodes[k], point))) < 1e-12;
    EXPECT(n_on == n_nodes);
    for (int k = 0; k < set->n_nodes; k++) {
        EXPECT_NEAR(vec3_dot(normal, vec3_sub(mesh->nodes[set->nodes[k]], point)), 0.0, 1e-12);
        EXPECT(k == 0 || set->nodes[k] > set->nodes[k - 1]);
    }
    for (int k = 0; k < set->n_sides; k++)
        EXPECT_NEAR(vec3_dot(side_normal(mesh, set->sides[k]), normal), 1.0, 1e-12);
}

static void expect_fine(const struct solid_mesh *mesh)
{
    struct mistakes mistakes;
    mistakes_init(&mistakes);
    solid_quality_check(mesh, "it", "f", (struct job_place){0, 0}, &mistakes);
    if (mistakes.n > 0)
        printf("  %s\n", mistakes.list[0].text);
    EXPECT(mistakes.n == 0);
    mistakes_clear(&mistakes);
    expect_conforming(mesh);
}

TEST(boxes_of_hexahedra_and_tetrahedra)
{
    for (int cut = 0; cut < 2; cut++) {
        struct job_body body = box_of(4, 3, 2);
        struct solid_mesh mesh;
        body.solid.elements = cut ? JOB_ELEMENTS_TETRAHEDRA : JOB_ELEMENTS_HEXAHEDRA;
        solid_mesh_build(&mesh, &body);
        const int f = cut ? 2 : 1; /* triangles a cell */
        EXPECT(mesh.n_nodes == 60 && mesh.n_elements == (cut ? 144 : 24));
        expect_fine(&mesh);
        expect_plane(&mesh, "x_min", body.min, (struct vec3){-1, 0, 0}, 12, 6 * f);
        expect_plane(&mesh, "x_max", body.max, (struct vec3){1, 0, 0}, 12, 6 * f);
        expect_plane(&mesh, "y_min", body.min, (struct vec3){0, -1, 0}, 15, 8 * f);
        expect_plane(&mesh, "y_max", body.max, (struct vec3){0, 1, 0}, 15, 8 * f);
        expect_plane(&mesh, "z_min", body.min, (struct vec3){0, 0, -1}, 20, 12 * f);
        expect_plane(&mesh, "z_max", body.max, (struct vec3){0, 0, 1}, 20, 12 * f);
        expect_plane(&mesh, "bottom", body.min, (struct vec3){0, 0, -1}, 20, 12 * f);
        EXPECT(solid_mesh_find(&mesh, "side")->n_sides == 28 * f);
        EXPECT(solid_mesh_find(&mesh, "side")->n_nodes == 42);
        EXPECT(solid_mesh_find(&mesh, "all")->n_nodes == 60);
        EXPECT(solid_mesh_find(&mesh, "all")->n_elements == mesh.n_elements);
        EXPECT(solid_mesh_find(&mesh, "inside") == NULL);
        const struct solid_quality q = solid_quality_of(&mesh);
        EXPECT_NEAR(q.volume, 2.0 * 0.9 * 0.5, 1e-14);
        EXPECT_NEAR(q.area, 2.0 * (2.0 * 0.9 + 2.0 * 0.5 + 0.9 * 0.5), 1e-14);
        EXPECT(q.low.x == -1.0 && q.high.y == 1.2 && q.high.z == 2.5 && q.n_parts == 1);
        solid_mesh_clear(&mesh);
    }
}

/* Whoever borrows the mesh that is kept gets that one; without one, another as good. */
TEST(a_mesh_is_built_once_and_kept)
{
    struct job_body body = box_of(4, 3, 2);
    struct job job = {.n_bodies = 1, .bodies = &body};
    struct solid_mesh own;
    const struct solid_mesh *kept = solid_mesh_keep(&body);
    EXPECT(solid_mesh_keep(&body) == kept);
    EXPECT(solid_mesh_borrow(&body, &own) == kept && own.n_nodes == 0);
    solid_mesh_clear(&own);
    EXPECT(kept->n_nodes == 60 && kept->n_elements == 24);
    solid_mesh_release(&job);
    EXPECT(body.solid.mesh == NULL);
    EXPECT(solid_mesh_borrow(&body, &own) == &own && own.n_nodes == 60);
    solid_mesh_clear(&own);
}

TEST(sides_are_counted_by_corners)
{
    int corners[4];
    EXPECT(solid_mesh_side_corners(8, 5, corners) == 4 && corners[0] == 3 && corners[3] == 7);
    EXPECT(solid_mesh_side_corners(4, 3, corners) == 3 && corners[0] == 2 && corners[2] == 3);
    EXPECT(solid_mesh_side_corners(8, 6, corners) == 0);
    EXPECT(solid_mesh_side_corners(4, 4, corners) == 0);
    EXPECT(solid_mesh_side_corners(8, -1, corners) == 0);
}

TEST(a_plate_one_cell_thick_keeps_its_sides_apart)
{
    struct job_body body = {.model = JOB_MODEL_SOLID,
                            .solid = {.kind = JOB_MESH_PLATE,
                                      .elements = JOB_ELEMENTS_TETRAHEDRA,
                                      .size = {0.3, 0.1},
                                      .thickness = 0.02,
                                      .cell = 0.1}};
    struct solid_mesh mesh;
    solid_mesh_build(&mesh, &body);
    EXPECT(mesh.n_elements == 18 && mesh.n_nodes == 16); /* no cell more for rounding */
    expect_fine(&mesh);
    EXPECT(solid_mesh_find(&mesh, "side")->n_sides == 16);
    EXPECT(solid_mesh_find(&mesh, "top")->n_sides == 6);
    EXPECT_NEAR(solid_quality_of(&mesh).volume, 6e-4, 1e-18);
    solid_mesh_clear(&mesh);
}

/* Area of a regular polygon in a circle. */
static double polygon(int n, double radius)
{
    return 0.5 * (double)n * sin(2.0 * PI / (double)n) * radius * radius;
}

TEST(cylinders_have_the_volume_of_their_polygon)
{
    double last = 0.0;
    for (int n = 1; n <= 8; n *= 2)
        for (int cut = 0; cut < 2; cut++) {
            struct job_body body = cylinder_of(n, n, n);
            struct solid_mesh mesh;
            body.solid.elements = cut ? JOB_ELEMENTS_TETRAHEDRA : JOB_ELEMENTS_HEXAHEDRA;
            solid_mesh_build(&mesh, &body);
            expect_fine(&mesh);
            EXPECT(mesh.n_elements == (cut ? 6 : 1) * 5 * n * n * n);
            const struct solid_quality q = solid_quality_of(&mesh);
            EXPECT_NEAR(q.volume, polygon(4 * n, 0.5), 1e-13);
            const double error = 0.25 * PI - q.volume;
            if (n > 2 && cut) /* of second order */
                EXPECT_NEAR(last / error, 4.0, 0.1);
            last = cut ? error : last;
            EXPECT(q.jacobian_least > (cut ? 0.06 : 0.7));
            solid_mesh_clear(&mesh);
        }
}

TEST(sets_of_cylinders_and_tubes)
{
    struct job_body body = cylinder_of(3, 2, 5);
    const struct vec3 axis = {0.0, 0.6, 0.8};
    struct solid_mesh mesh;
    solid_mesh_build(&mesh, &body);
    expect_plane(&mesh, "bottom", body.from, vec3_scale(-1.0, axis), 40, 33);
    expect_plane(&mesh, "top", body.to, axis, 40, 33);
    const struct solid_mesh_set *side = solid_mesh_find(&mesh, "side");
    EXPECT(side->n_nodes == 72 && side->n_sides == 60);
    int n_out = 0;
    for (int k = 0; k < mesh.n_nodes; k++) {
        const struct vec3 r = vec3_sub(mesh.nodes[k], body.from);
        n_out += vec3_norm(vec3_cross(axis, r)) > 0.5 - 1e-12;
    }
    EXPECT(n_out == side->n_nodes);
    EXPECT(solid_mesh_find(&mesh, "surface")->n_sides == 60 + 66);
    solid_mesh_clear(&mesh);
    for (int cut = 0; cut < 2; cut++) {
        body = tube_of(12, 2, 4);
        body.solid.elements = cut ? JOB_ELEMENTS_TETRAHEDRA : JOB_ELEMENTS_HEXAHEDRA;
        solid_mesh_build(&mesh, &body);
        expect_fine(&mesh);
        const struct solid_quality q = solid_quality_of(&mesh);
        EXPECT_NEAR(q.volume, 2.0 * (polygon(12, 0.5) - polygon(12, 0.4)), 1e-14);
        const int f = cut ? 2 : 1;
        EXPECT(solid_mesh_find(&mesh, "inside")->n_sides == 48 * f);
        EXPECT(solid_mesh_find(&mesh, "outside")->n_nodes == 60);
        EXPECT(solid_mesh_find(&mesh, "side") == NULL);
        for (int k = 0; k < 60; k++) {
            const struct vec3 x = mesh.nodes[solid_mesh_find(&mesh, "inside")->nodes[k]];
            EXPECT_NEAR(sqrt(x.y * x.y + x.z * x.z), 0.4, 1e-14);
        }
        solid_mesh_clear(&mesh);
    }
}

TEST(shapes_are_scaled_turned_and_moved_and_sets_taken_there)
{
    struct job_set sets[2] = {
        {.name = (char[]){"corner"},
         .region = {.kind = JOB_REGION_BOX,
                    .min = {4.7, -0.2, 7.0 / 3.0},
                    .max = {5.5, 1.2, 3.0}}},
        {.name = (char[]){"ball"},
         .region = {.kind = JOB_REGION_SPHERE, .centre = {5.0, 1.0, 3.0}, .radius = 0.7}}};
    struct job_body body = {
        .model = JOB_MODEL_SOLID,
        .max = {3.0, 1.0, 1.0},
        .scale = 0.5,
        .turn_axis = {0.0, 0.0, 1.0},
        .turn_angle = 0.5 * PI,
        .move = {5.0, 0.0, 2.0},
        .solid = {.kind = JOB_MESH_BOX, .cells = {3, 2, 3}, .n_sets = 2, .sets = sets}};
    struct solid_mesh mesh;
    solid_mesh_build(&mesh, &body);
    const struct solid_quality q = solid_quality_of(&mesh);
    EXPECT_NEAR(q.volume, 3.0 / 8.0, 1e-15);
    EXPECT_NEAR(q.low.x, 4.5, 1e-14);
    EXPECT_NEAR(q.high.y, 1.5, 1e-14);
    expect_plane(&mesh, "x_min", (struct vec3){5, 0, 2}, (struct vec3){0, -1, 0}, 12, 6);
    /* x 4.75 and 5, y 0, 0.5 and 1, z 2.33 and 2.5; of the box's top, one side on the right and
     * two on the top for each of two rows. */
    const struct solid_mesh_set *corner = solid_mesh_find(&mesh, "corner");
    EXPECT(corner->n_nodes == 12 && corner->n_sides == 5);
    const struct solid_mesh_set *ball = solid_mesh_find(&mesh, "ball");
    int n = 0;
    for (int k = 0; k < mesh.n_nodes; k++)
        n += vec3_norm(vec3_sub(mesh.nodes[k], (struct vec3){5, 1, 3})) <= 0.7;
    EXPECT(n > 0 && ball->n_nodes == n);
    solid_mesh_clear(&mesh);
}

TEST(volumes_and_jacobians_of_known_elements)
{
    struct vec3 cube[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                           {0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2}};
    int hexahedron[1][8] = {{0, 1, 2, 3, 4, 5, 6, 7}};
    struct solid_mesh mesh = {
        .n_nodes = 8, .n_elements = 1, .nodes = cube, .elements = hexahedron};
    struct solid_quality q = solid_quality_of(&mesh);
    EXPECT_NEAR(q.volume, 2.0, 1e-15);
    EXPECT_NEAR(q.jacobian_least, 1.0, 1e-15);
    EXPECT_NEAR(q.aspect, 2.0, 1e-15);
    cube[6].x = 1.5; /* warps sides; the trilinear shape gains 2/3 of half a box's edge */
    q = solid_quality_of(&mesh);
    EXPECT_NEAR(q.volume, 2.0 + 0.5 * 2.0 / 4.0, 1e-14);
    struct vec3 regular[4] = {{0, 0, 0}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}};
    int tetrahedron[1][8] = {{0, 1, 2, 3, -1, -1, -1, -1}};
    mesh = (struct solid_mesh){
        .n_nodes = 4, .n_elements = 1, .nodes = regular, .elements = tetrahedron};
    q = solid_quality_of(&mesh);
    EXPECT_NEAR(q.volume, 1.0 / 3.0, 1e-15);
    EXPECT_NEAR(q.jacobian_least, 1.0, 1e-15);
}

/* ------------------------------------------------------------------------------ conditions */

static double value_at(const struct solid_condition *condition, double time)
{
    struct solid_table table = solid_table_of(condition);
    const double value = solid_table_value(&table, time);
    solid_table_clear(&table);
    return value;
}

/* How far nodes have gone that are held so. */
static double travel(const struct solid_condition *condition, double time)
{
    struct solid_table table = solid_table_of(condition);
    const double way = condition->kind == SOLID_CONDITION_VELOCITY
                           ? solid_table_integral(&table, time)
                           : solid_table_value(&table, time);
    solid_table_clear(&table);
    return way;
}

TEST(conditions_are_functions_of_time)
{
    struct job_value rows[3] = {{1.0, 2.0}, {2.0, -4.0}, {4.0, 0.5}};
    struct job_body body = box_of(1, 1, 1);
    struct solid_mesh mesh;
    solid_mesh_build(&mesh, &body);
    const struct job_boundary asked = {
        .set = (char[]){"x_max"}, .direction = 1, .n_velocities = 3, .velocities = rows};
    const struct solid_condition moving = solid_condition_of(&asked, &mesh);
    EXPECT(moving.kind == SOLID_CONDITION_VELOCITY && moving.directions == JOB_DIRECTION_Y);
    EXPECT(moving.set == solid_mesh_find(&mesh, "x_max"));
    EXPECT(value_at(&moving, 0.0) == 2.0 && value_at(&moving, 9.0) == 0.5);
    EXPECT(value_at(&moving, 1.5) == -1.0 && value_at(&moving, 2.0) == -4.0);
    double sum = 0.0; /* Simpson's rule is exact between the rows */
    for (int k = 0; k < 64; k++) {
        const double t = (double)k / 8.0, h = 0.125;
        EXPECT_NEAR(travel(&moving, t), sum, 1e-13);
        sum += h / 6.0 *
               (value_at(&moving, t) + 4.0 * value_at(&moving, t + 0.5 * h) +
                value_at(&moving, t + h));
    }
    const struct job_boundary others[4] = {
        {.set = asked.set, .fixed = JOB_DIRECTION_X | JOB_DIRECTION_Z},
        {.set = asked.set, .direction = 2, .n_displacements = 3, .displacements = rows},
        {.set = asked.set, .direction = 2, .has_velocity = true, .velocity = -3.0},
        {.set = asked.set, .has_pressure = true, .pressure = 7.0}};
    const double travels[3] = {0.0, 2.0, -3.0};
    for (int k = 0; k < 3; k++) {
        const struct solid_condition held = solid_condition_of(&others[k], &mesh);
        EXPECT(held.directions == (k == 0 ? 5 : 4));
        EXPECT(travel(&held, 1.0) == travels[k]);
    }
    const struct solid_condition pressed = solid_condition_of(&others[3], &mesh);
    EXPECT(pressed.kind == SOLID_CONDITION_PRESSURE && value_at(&pressed, 3.0) == 7.0);
    solid_mesh_clear(&mesh);
}

/* ---------------------------------------------------------------------------------- faults */

/* Whatever is wrong, its first message begins so. */
static void expect_fault(const struct solid_mesh *mesh, int n, const char *begin)
{
    struct mistakes mistakes;
    mistakes_init(&mistakes);
    solid_quality_check(mesh, "it", "f", (struct job_place){3, 5}, &mistakes);
    EXPECT(mistakes.n == n);
    if (mistakes.n > 0) {
        char first[400];
        snprintf(first, sizeof first, "%.*s", (int)strlen(begin), mistakes.list[0].text);
        EXPECT_STRING(first, begin);
        EXPECT(mistakes.list[0].line == 3 && mistakes.list[0].column == 5);
    } else {
        printf("  nothing where '%s'\n", begin);
    }
    mistakes_clear(&mistakes);
}

TEST(faults_are_found_and_told)
{
    struct job_body body = box_of(2, 2, 2);
    struct solid_mesh mesh;
    solid_mesh_build(&mesh, &body);
    int(*e)[8] = mesh.elements, whole[8][8];
    memcpy(whole, e, sizeof whole);
    for (int c = 0; c < 4; c++) { /* top and bottom change places */
        e[7][c] = whole[7][4 + c];
        e[7][4 + c] = whole[7][c];
    }
    expect_fault(&mesh, 1,
                 "body 'it': element 8 at (0.5, 0.975, 2.375) m is flipped, its "
                 "volume is -0.113 m3; nodes the other way round are expected");
    memcpy(e, whole, sizeof whole);
    e[0][6] = e[0][7];
    expect_fault(&mesh, 1, "body 'it': element 1 at (-0.625, 0.525, 2.125) m has a node twice");
    memcpy(e, whole, sizeof whole);
    int nine[9][8];
    memcpy(nine, whole, sizeof whole);
    memcpy(nine[8], whole[2], sizeof nine[8]);
    mesh.elements = nine;
    mesh.n_elements = 9;
    expect_fault(&mesh, 1,
                 "body 'it': element 9 at (-0.5, 0.975, 2.125) m has the nodes of "
                 "element 3; each element once is expected");
    mesh.elements = e;
    mesh.n_elements = 7;
    expect_fault(&mesh, 1, "body 'it': node 27 at (1, 1.2, 2.5) m belongs to no element");
    mesh.n_elements = 8;
    const struct vec3 was = mesh.nodes[13];
    mesh.nodes[13].z =
        2.0; /* the middle goes down: lower cells become flat in one corner alone */
    expect_fine(&mesh);
    mesh.nodes[13].z = 1.8; /* and are folded there */
    expect_fault(&mesh, 4,
                 "body 'it': element 1 at (-0.5, 0.525, 2.069) m is folded, at a corner its "
                 "scaled Jacobian is");
    mesh.nodes[13] = was;
    for (int k = 18; k < 27; k++)
        mesh.nodes[k].z = 2.25;
    expect_fault(&mesh, 4, "body 'it': element 5 at (-0.5, 0.525, 2.25) m is flat, its volume");
    solid_mesh_clear(&mesh);
}

TEST(joints_that_are_none_are_found)
{
    struct solid_mesh mesh;
    /* Two cells that have an edge in common, and no side. */
    struct vec3 places[14];
    int cells[2][8];
    for (int c = 0; c < 2; c++)
        for (int k = 0; k < 8; k++) {
            const int shared = c == 1 && (k == 0 || k == 4);
            cells[c][k] = c == 0 ? k : k == 0 ? 2 : k == 4 ? 6 : 7 + k - (k > 4);
            if (!shared)
                places[cells[c][k]] = (struct vec3){(double)c + (k % 4 == 1 || k % 4 == 2),
                                                    (double)c + (k % 4 >= 2), k / 4};
        }
    mesh =
        (struct solid_mesh){.n_nodes = 14, .n_elements = 2, .nodes = places, .elements = cells};
    expect_fault(&mesh, 1,
                 "body 'it': the edge of nodes 3 and 7 at (1, 1, 0.5) m is one of 4 "
                 "sides of the surface, which meets itself there");
    /* A tetrahedron on a quad. */
    struct vec3 roof[9] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},    {0, 0, 1},
                           {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0.5, 0.5, 2}};
    int mixed[3][8] = {
        {0, 1, 2, 3, 4, 5, 6, 7}, {4, 5, 6, 8, -1, -1, -1, -1}, {4, 6, 7, 8, -1, -1, -1, -1}};
    mesh = (struct solid_mesh){.n_nodes = 9, .n_elements = 3, .nodes = roof, .elements = mixed};
    expect_fault(&mesh, 4,
                 "body 'it': element 2 at (0.625, 0.375, 1.25) m meets another "
                 "in a part of a side");
    /* Three tetrahedra on one triangle. */
    struct vec3 fan[6] = {{0, 0, 0}, {1, 0, 0},     {0, 1, 0},
                          {0, 0, 1}, {0.1, 0.1, 2}, {0, 0, -1}};
    int three[3][8] = {{0, 1, 2, 3, -1, -1, -1, -1},
                       {0, 1, 2, 4, -1, -1, -1, -1},
                       {0, 2, 1, 5, -1, -1, -1, -1}};
    mesh = (struct solid_mesh){.n_nodes = 6, .n_elements = 3, .nodes = fan, .elements = three};
    expect_fault(&mesh, 3,
                 "body 'it': element 1 at (0.25, 0.25, 0.25) m shares a side with more "
                 "than one element");
}

/* ----------------------------------------------------------------------------------- files */

enum { ROOM = 1 << 17 };

struct file {
    size_t n;
    char bytes[ROOM];
    bool binary;
    int version; /* 22 or 41 */
};

static void put_bytes(struct file *file, const void *bytes, size_t n)
{
    EXPECT(file->n + n < ROOM);
    memcpy(file->bytes + file->n, bytes, n);
    file->n += n;
    file->bytes[file->n] = '\0';
}

static void put_text(struct file *file, const char *text)
{
    put_bytes(file, text, strlen(text));
}

static void put_short(struct file *file, int64_t value)
{
    char text[32];
    const int32_t narrow = (int32_t)value;
    snprintf(text, sizeof text, "%lld ", (long long)value);
    if (file->binary)
        put_bytes(file, &narrow, sizeof narrow);
    else
        put_text(file, text);
}

/* A count or a tag of a node or an element: longer in 4.1. */
static void put_long(struct file *file, int64_t value)
{
    if (file->binary && file->version == 41)
        put_bytes(file, &value, sizeof value);
    else
        put_short(file, value);
}

static void put_double(struct file *file, double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.17g ", value);
    if (file->binary)
        put_bytes(file, &value, sizeof value);
    else
        put_text(file, text);
}

static void end_line(struct file *file)
{
    if (!file->binary)
        put_text(file, "\n");
}

static void put_head(struct file *file)
{
    const int32_t one = 1;
    char text[64];
    snprintf(text, sizeof text, "$MeshFormat\n%s %d 8\n", file->version == 22 ? "2.2" : "4.1",
             file->binary);
    put_text(file, text);
    if (file->binary) {
        put_bytes(file, &one, sizeof one);
        put_text(file, "\n");
    }
    put_text(file, "$EndMeshFormat\n$PhysicalNames\n5\n0 1 \"tip\"\n1 2 \"a crease\"\n"
                   "2 3 \"x_min\"\n3 4 \"left\"\n3 5 \"right\"\n$EndPhysicalNames\n");
}

/* What the writer puts: elements with their physical group, which is an entity of its own. */
struct written {
    int type, n, physical, corners[8];
};

static const int DIMENSIONS[6] = {0, 0, 1, 2, 3, 3}; /* of the physical groups from 1 on */

static int64_t node_tag(int node)
{
    return 1000 - 3 * node; /* descending, with gaps: to be sorted */
}

static void put_entities(struct file *file)
{
    put_text(file, "$Entities\n");
    put_long(file, 1);
    put_long(file, 1);
    put_long(file, 1);
    put_long(file, 2);
    end_line(file);
    for (int physical = 1; physical <= 5; physical++) {
        put_short(file, 10 + physical);
        for (int k = 0; k < (physical == 1 ? 3 : 6); k++)
            put_double(file, 0.0);
        put_long(file, 1);
        put_short(file, physical);
        if (physical > 1)
            put_long(file, 0);
        end_line(file);
    }
    put_text(file, file->binary ? "\n$EndEntities\n" : "$EndEntities\n");
}

static void put_nodes(struct file *file, const struct solid_mesh *mesh)
{
    const int n = mesh->n_nodes;
    char text[32];
    put_text(file, "$Nodes\n");
    if (file->version == 41) {
        put_long(file, 1);
        put_long(file, n);
        put_long(file, node_tag(n - 1));
        put_long(file, node_tag(0));
        end_line(file);
        put_short(file, 3);
        put_short(file, 14);
        put_short(file, 0);
        put_long(file, n);
        end_line(file);
        for (int k = 0; k < n; k++)
            put_long(file, node_tag(k));
        end_line(file);
    } else {
        snprintf(text, sizeof text, "%d\n", n);
        put_text(file, text);
    }
    for (int k = 0; k < n; k++) {
        if (file->version == 22)
            put_long(file, node_tag(k));
        put_double(file, mesh->nodes[k].x);
        put_double(file, mesh->nodes[k].y);
        put_double(file, mesh->nodes[k].z);
        end_line(file);
    }
    put_text(file, file->binary ? "\n$EndNodes\n" : "$EndNodes\n");
}

static void put_corners(struct file *file, const struct written *element)
{
    for (int k = 0; k < element->n; k++)
        put_long(file, node_tag(element->corners[k]));
    end_line(file);
}

/* A block of one element each, as both formats allow. */
static void put_elements(struct file *file, int n, const struct written *elements)
{
    char text[32];
    put_text(file, "$Elements\n");
    if (file->version == 41) {
        put_long(file, n);
        put_long(file, n);
        put_long(file, 1);
        put_long(file, n);
        end_line(file);
    } else {
        snprintf(text, sizeof text, "%d\n", n);
        put_text(file, text);
    }
    for (int k = 0; k < n; k++) {
        const struct written *e = &elements[k];
        if (file->version == 41) {
            put_short(file, DIMENSIONS[e->physical]);
            put_short(file, 10 + e->physical);
            put_short(file, e->type);
            put_long(file, 1);
            end_line(file);
            put_long(file, 501 + k);
        } else if (file->binary) {
            put_short(file, e->type);
            put_short(file, 1);
            put_short(file, 2);
            put_short(file, 501 + k);
            put_short(file, e->physical);
            put_short(file, 10 + e->physical);
        } else {
            put_short(file, 501 + k);
            put_short(file, e->type);
            put_short(file, 2);
            put_short(file, e->physical);
            put_short(file, 10 + e->physical);
        }
        put_corners(file, e);
    }
    put_text(file, file->binary ? "\n$EndElements\n" : "$EndElements\n");
}

static struct written written_of(int type, int n, int physical, const int *corners)
{
    struct written w = {.type = type, .n = n, .physical = physical};
    memcpy(w.corners, corners, (size_t)n * sizeof *corners);
    return w;
}

/* The mesh with a point, two lines along an edge, its side x_min, and its elements: those of
 * even number are "left", others "right". */
static void write_mesh(struct file *file, const struct solid_mesh *mesh)
{
    const struct solid_mesh_set *side = solid_mesh_find(mesh, "x_min");
    static struct written elements[500];
    int n = 0;
    elements[n++] = written_of(15, 1, 1, (int[]){mesh->n_nodes - 1});
    elements[n++] = written_of(1, 2, 2, (int[]){0, 1});
    elements[n++] = written_of(1, 2, 2, (int[]){1, 2});
    for (int k = 0; k < side->n_sides; k++) {
        int c[4];
        const int m = solid_mesh_side_nodes(mesh->elements[side->sides[k].element],
                                            side->sides[k].side, c);
        const int turned[4] = {c[2], c[1], c[0], c[3]}; /* whichever way it looks */
        elements[n++] = written_of(m == 3 ? 2 : 3, m, 3, turned);
    }
    for (int e = 0; e < mesh->n_elements; e++) {
        const int m = solid_mesh_n_corners(mesh->elements[e]);
        elements[n++] = written_of(m == 4 ? 4 : 5, m, 4 + e % 2, mesh->elements[e]);
    }
    put_head(file);
    if (file->version == 41)
        put_entities(file);
    put_nodes(file, mesh);
    put_elements(file, n, elements);
}

/* A body whose mesh the file is. */
static bool read_body(struct job_body *body, const struct file *file, char **why)
{
    *body = (struct job_body){.model = JOB_MODEL_SOLID, .solid = {.kind = JOB_MESH_GMSH}};
    return gmsh_read_solid(&body->solid.volume, "f", file->bytes, file->n, why);
}

/* Sets with the same nodes and sides, where those of `b` are numbered from the other end. */
static void expect_same_set(const struct solid_mesh *a, const char *name,
                            const struct solid_mesh *b, const char *other)
{
    const struct solid_mesh_set *p = solid_mesh_find(a, name), *q = solid_mesh_find(b, other);
    EXPECT(p != NULL && q != NULL);
    if (p == NULL || q == NULL)
        return;
    EXPECT(p->n_nodes == q->n_nodes && p->n_sides == q->n_sides && q->n_strays == 0);
    for (int k = 0; k < p->n_nodes && k < q->n_nodes; k++)
        EXPECT(p->nodes[k] == b->n_nodes - 1 - q->nodes[q->n_nodes - 1 - k]);
    for (int k = 0; k < p->n_sides && k < q->n_sides; k++)
        EXPECT(p->sides[k].element == q->sides[k].element &&
               p->sides[k].side == q->sides[k].side);
}

static void expect_read(const struct solid_mesh *mesh, const struct file *file)
{
    struct job_body body;
    struct solid_mesh read;
    char *why = NULL;
    EXPECT(read_body(&body, file, &why));
    EXPECT_STRING(why != NULL ? why : "", "");
    solid_mesh_build(&read, &body);
    const int n = mesh->n_nodes;
    EXPECT(read.n_nodes == n && read.n_elements == mesh->n_elements);
    expect_fine(&read);
    for (int k = 0; k < n && k < read.n_nodes; k++) {
        const struct vec3 x = mesh->nodes[k], y = read.nodes[n - 1 - k];
        EXPECT(x.x == y.x && x.y == y.y && x.z == y.z);
        EXPECT(read.node_numbers[n - 1 - k] == node_tag(k));
    }
    expect_same_set(mesh, "x_min", &read, "x_min");
    expect_same_set(mesh, "surface", &read, "surface");
    expect_same_set(mesh, "all", &read, "all");
    const struct solid_mesh_set *left = solid_mesh_find(&read, "left");
    EXPECT(left->n_elements == (mesh->n_elements + 1) / 2 && left->elements[1] == 2);
    EXPECT(solid_mesh_find(&read, "tip")->n_nodes == 1 &&
           solid_mesh_find(&read, "tip")->nodes[0] == 0);
    EXPECT(solid_mesh_find(&read, "a crease")->n_nodes == 3 &&
           solid_mesh_find(&read, "a crease")->nodes[0] == n - 3);
    solid_mesh_clear(&read);
    body.group = (char[]){"left"}; /* every other cell: nodes that it does not have are gone */
    solid_mesh_build(&read, &body);
    EXPECT(read.n_elements == (mesh->n_elements + 1) / 2 && read.n_nodes <= n);
    EXPECT(read.element_numbers[1] == read.element_numbers[0] + 2);
    EXPECT(solid_mesh_find(&read, "right")->n_elements == 0);
    solid_mesh_clear(&read);
    job_volume_clear(&body.solid.volume);
    free(why);
}

TEST(gmsh_files_give_back_meshes_and_groups)
{
    static struct file file;
    for (int k = 0; k < 8; k++) {
        struct job_body body = box_of(3, 2, 2);
        struct solid_mesh mesh;
        body.solid.elements = k % 2 == 1 ? JOB_ELEMENTS_TETRAHEDRA : JOB_ELEMENTS_HEXAHEDRA;
        solid_mesh_build(&mesh, &body);
        file = (struct file){.binary = k / 2 % 2 == 1, .version = k / 4 == 1 ? 41 : 22};
        write_mesh(&file, &mesh);
        expect_read(&mesh, &file);
        solid_mesh_clear(&mesh);
    }
}

/* The text of a small file with one piece of it replaced. */
static void expect_refused(const char *piece, const char *other, const char *expected)
{
    static const char SMALL[] = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n"
                                "1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
                                "$Elements\n2\n1 2 2 7 1 1 3 2\n2 4 2 8 1 1 2 3 4\n"
                                "$EndElements\n";
    static struct file file;
    struct job_body body;
    char *why = NULL;
    const char *at = strstr(SMALL, piece);
    file = (struct file){.n = 0};
    put_bytes(&file, SMALL, (size_t)(at - SMALL));
    put_text(&file, other);
    put_text(&file, at + strlen(piece));
    const bool fine = read_body(&body, &file, &why);
    EXPECT(fine == (expected == NULL));
    EXPECT_STRING(why != NULL ? why : "", expected != NULL ? expected : "");
    job_volume_clear(&body.solid.volume);
    free(why);
}

TEST(damaged_files_of_solids_say_where_and_what)
{
    expect_refused("2 4 2 8", "2 4 2 8", NULL);
    expect_refused("2 4 2 8", "2 6 2 8",
                   "f:14:3: elements of type 6, prisms; a mesh of hexahedra with 8 and "
                   "tetrahedra with 4 nodes (gmsh -order 1) is expected");
    expect_refused(
        "2 4 2 8", "2 11 2 8",
        "f:14:3: elements of type 11, which are curved or of higher order; a mesh of "
        "hexahedra with 8 and tetrahedra with 4 nodes (gmsh -order 1) is expected");
    expect_refused("1 2 3 4\n$E", "1 2 3 5\n$E",
                   "f:14:17: there is no node 5; one of the section $Nodes before it is "
                   "expected");
    expect_refused(
        "2 4 2 8 1 1 2 3 4", "2 2 2 7 1 2 3 4",
        "f:16:1: there are no hexahedra or tetrahedra in it; a mesh of volumes (gmsh "
        "-3) is expected");
}

static uint64_t random_state = 1;

static size_t random_below(size_t n)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (size_t)(random_state >> 33) % n;
}

/* Files changed at random are read or refused, and what is read can be built and looked at. */
TEST(files_of_solids_changed_at_random)
{
    static struct file files[4], file;
    struct job_body body = box_of(1, 2, 1);
    struct solid_mesh mesh;
    const char *count = getenv("MUTATIONS");
    const int n = count != NULL ? atoi(count) : 2000;
    solid_mesh_build(&mesh, &body);
    for (int k = 0; k < 4; k++) {
        files[k] = (struct file){.binary = k % 2 == 1, .version = k / 2 == 1 ? 41 : 22};
        write_mesh(&files[k], &mesh);
    }
    solid_mesh_clear(&mesh);
    for (int k = 0; k < n; k++) {
        struct mistakes mistakes;
        char *why = NULL;
        file = files[k % 4];
        for (size_t changes = 1 + random_below(3); changes > 0; changes--) {
            const size_t at = random_below(file.n);
            file.bytes[at] = random_below(2) == 0
                                 ? "0123456789-+. \n"[random_below(15)]
                                 : (char)(file.bytes[at] ^ (1 << random_below(8)));
        }
        const bool fine = read_body(&body, &file, &why);
        EXPECT(fine == (why == NULL));
        if (fine) {
            mistakes_init(&mistakes);
            solid_mesh_build(&mesh, &body);
            solid_quality_check(&mesh, "it", "f", (struct job_place){0, 0}, &mistakes);
            solid_quality_of(&mesh);
            solid_mesh_clear(&mesh);
            mistakes_clear(&mistakes);
        }
        job_volume_clear(&body.solid.volume);
        free(why);
    }
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
