/*
 * Spheres against facets: one contact where there is one, nothing felt at seams, the same bits
 * whatever is listed, loads on bodies, energies.
 */
#include "base/array.h"
#include "check.h"
#include "contact/facet_contact.h"
#include "contact/facet_step.h"
#include "job/job.h"
#include "model/body.h"
#include "model/material.h"
#include "model/sphere.h"

#include <stdint.h>
#include <stdlib.h>

enum { BODIES_MAX = 2 };

static char NAME[] = "body";

/* Spheres that do not meet each other, and bodies. */
struct scene {
    struct materials materials;
    struct bodies bodies;
    struct spheres spheres;
    struct facet_contacts facets;
    double body_allowance[BODIES_MAX];
    struct vec3 gravity;
    double dt;
    int64_t step;
};

static uint64_t random_state = 1;

/* Uniform in [low, high). */
static double random_between(double low, double high)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(random_state >> 11) * 0x1p-53;
}

static enum isa instruction_set = ISA_AUTO; /* of scenes that are built */

static void scene_build(struct scene *scene, struct job_material material, double friction,
                        double restitution, int n_bodies, struct job_body *asked, int n_spheres,
                        double radius)
{
    struct job_pair pair = {
        .friction = friction, .static_friction = friction, .restitution = restitution};
    const struct job job = {.n_materials = 1,
                            .materials = &material,
                            .n_pairs = 1,
                            .pairs = &pair,
                            .n_bodies = n_bodies,
                            .bodies = asked};
    *scene = (struct scene){.dt = 1e-5};
    materials_build(&scene->materials, &job);
    bodies_build(&scene->bodies, &job);
    facet_contacts_init(&scene->facets, n_bodies, instruction_set);
    spheres_init(&scene->spheres);
    spheres_reserve(&scene->spheres, n_spheres);
    scene->spheres.n_owned = scene->spheres.n_all = n_spheres;
    for (int i = 0; i < n_spheres; i++) {
        scene->spheres.id[i] = 100 + 3 * i;
        scene->spheres.motion[i].lane[3] = radius;
        sphere_complete(&scene->spheres, i, &scene->materials);
    }
    spheres_pad(&scene->spheres);
}

static void scene_clear(struct scene *scene)
{
    facet_contacts_clear(&scene->facets);
    spheres_clear(&scene->spheres);
    bodies_clear(&scene->bodies);
    materials_clear(&scene->materials);
}

static void put_sphere(struct scene *scene, int i, struct vec3 x, struct vec3 v, struct vec3 w)
{
    double *motion = scene->spheres.motion[i].lane, *spin = scene->spheres.spin[i].lane;
    const double values[6] = {x.x, x.y, x.z, v.x, v.y, v.z};
    for (int k = 0; k < 3; k++) {
        motion[k] = values[k];
        motion[4 + k] = values[3 + k];
    }
    spin[4] = w.x;
    spin[5] = w.y;
    spin[6] = w.z;
    sphere_complete(&scene->spheres, i, &scene->materials);
}

static void search(struct scene *scene, bool all_pairs)
{
    facet_contacts_search(&scene->facets, &scene->spheres, &scene->bodies,
                          scene->body_allowance, all_pairs);
}

static void apply(struct scene *scene)
{
    memset(scene->spheres.force, 0,
           (size_t)scene->spheres.n_owned * sizeof *scene->spheres.force);
    facet_step_apply(&scene->facets, &scene->spheres, &scene->bodies, &scene->materials,
                     scene->dt, true);
}

/* Leapfrog: positions at the step, velocities half a step before. */
static void integrate(struct scene *scene)
{
    const double g[3] = {scene->gravity.x, scene->gravity.y, scene->gravity.z};
    for (int i = 0; i < scene->spheres.n_owned; i++) {
        double *motion = scene->spheres.motion[i].lane, *spin = scene->spheres.spin[i].lane;
        const double *force = scene->spheres.force[i].lane;
        for (int k = 0; k < 3; k++) {
            motion[4 + k] += scene->dt * (force[k] * spin[7] + g[k]);
            motion[k] += scene->dt * motion[4 + k];
            spin[4 + k] += scene->dt * 2.5 * force[4 + k] * spin[7] * spin[3] * spin[3];
        }
        sphere_complete(&scene->spheres, i, &scene->materials);
    }
    scene->step++;
    bodies_place(&scene->bodies, scene->step, scene->dt);
}

static int count_contacts(const struct scene *scene)
{
    int n = 0;
    for (int k = 0; k < scene->facets.n; k++)
        n += scene->facets.list[k].history[CONTACT_RADIUS_LANE] > 0.0;
    return n;
}

/* Contacts of a sphere of radius 1 put at rest at a place. */
static int contacts_at(struct scene *scene, double x, double y, double z)
{
    const struct vec3 zero = {0, 0, 0};
    put_sphere(scene, 0, (struct vec3){x, y, z}, zero, zero);
    facet_contacts_forget(&scene->facets);
    search(scene, false);
    apply(scene);
    return count_contacts(scene);
}

static const struct job_material STEEL = {.density = 7850, .young = 2.1e11, .poisson = 0.3};
static const struct job_material RUBBER = {.density = 1000, .young = 1e6, .poisson = 0.3};

static struct job_body mesh_body(int n_vertices, struct vec3 *vertices, int n_facets,
                                 int (*facets)[4])
{
    return (struct job_body){.name = NAME,
                             .geometry = JOB_GEOMETRY_MESH,
                             .n_vertices = n_vertices,
                             .vertices = vertices,
                             .n_facets = n_facets,
                             .facets = facets};
}

/* SLIVERS: every other column of MIXED is a millionth as wide as the next. */
enum sheet { QUADS, TRIANGLES, MIXED, SLIVERS, ONE_QUAD };

enum { SHEET_CELLS = 8, SHEET_POINTS = (SHEET_CELLS + 1) * (SHEET_CELLS + 1) };

struct sheet_store {
    struct vec3 vertices[SHEET_POINTS];
    int facets[2 * SHEET_CELLS * SHEET_CELLS][4];
};

/* A sheet over [0, size]^2, sloping by the angle whose cosine and sine are .96 and .28, or
 * flat; `bump` shakes heights. */
static struct job_body sheet_body(struct sheet_store *store, enum sheet kind, double size,
                                  bool slopes, double bump)
{
    const int n = kind == ONE_QUAD ? 1 : SHEET_CELLS;
    int n_facets = 0;
    for (int j = 0; j <= n; j++)
        for (int i = 0; i <= n; i++) {
            const double column =
                kind == SLIVERS && i % 2 == 1 ? (double)i - 1.0 + 1e-6 : (double)i;
            const double x = size * column / (double)n, y = size * (double)j / (double)n;
            store->vertices[j * (n + 1) + i] =
                (struct vec3){slopes ? 0.96 * x : x, y,
                              (slopes ? 0.28 * x : 0.0) + bump * random_between(-1.0, 1.0)};
        }
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            const bool whole =
                kind == QUADS || kind == ONE_QUAD || (kind != TRIANGLES && (i + j) % 2);
            const int quad[4] = {a, b, c, d}, low[4] = {a, b, c, -1}, high[4] = {a, c, d, -1};
            if (whole) {
                memcpy(store->facets[n_facets++], quad, sizeof quad);
            } else {
                memcpy(store->facets[n_facets++], low, sizeof low);
                memcpy(store->facets[n_facets++], high, sizeof high);
            }
        }
    return mesh_body((n + 1) * (n + 1), store->vertices, n_facets, store->facets);
}

/* ---- How many contacts
 * ------------------------------------------------------------------------ */

TEST(a_corner_of_three_walls_has_three_contacts)
{
    struct job_body box = {
        .name = NAME, .geometry = JOB_GEOMETRY_BOX, .max = {5, 5, 5}, .open = JOB_SIDE_TOP};
    struct scene scene;
    scene_build(&scene, STEEL, 0.5, 1.0, 1, &box, 1, 1.0);
    EXPECT(contacts_at(&scene, 0.999, 0.999, 0.999) == 3);
    EXPECT(contacts_at(&scene, 0.999, 2.0, 0.999) == 2);
    EXPECT(contacts_at(&scene, 2.0, 2.0, 0.999) == 1);
    EXPECT(contacts_at(&scene, 2.0, 2.0, 2.0) == 0);
    /* On the rim, seen from above: an edge, and a vertex. */
    EXPECT(contacts_at(&scene, 0.1, 2.0, 5.99) == 1);
    EXPECT(contacts_at(&scene, 0.1, 0.1, 5.98) == 2 ||
           contacts_at(&scene, 0.1, 0.1, 5.98) == 1);
    EXPECT(contacts_at(&scene, -0.1, -0.1, 5.98) == 1);
    scene_clear(&scene);
}

TEST(a_convex_edge_has_one_contact_and_turns_its_normal_smoothly)
{
    struct job_body box = {.name = NAME, .geometry = JOB_GEOMETRY_BOX, .max = {5, 5, 5}};
    struct scene scene;
    scene_build(&scene, STEEL, 0.5, 1.0, 1, &box, 1, 1.0);
    /* Along the top to the edge, around it, down the side, always as deep. */
    EXPECT(contacts_at(&scene, 4.0, 2.0, 5.999) == 1);
    const double expected = scene.spheres.force[0].lane[2];
    for (int k = 0; k <= 300; k++) {
        const double turn = k < 100 ? 0.0 : k > 200 ? 1.0 : (double)(k - 100) / 100.0;
        const double angle = 1.5707963267948966 * turn;
        const double to_edge = k < 100 ? 0.01 * (double)(100 - k) : 0.0;
        const double past_edge = k > 200 ? 0.01 * (double)(k - 200) : 0.0;
        EXPECT(contacts_at(&scene, 5.0 - to_edge + 0.999 * sin(angle), 2.0,
                           5.0 - past_edge + 0.999 * cos(angle)) == 1);
        const double *force = scene.spheres.force[0].lane;
        EXPECT_NEAR(force[0] / expected, sin(angle), 1e-9);
        EXPECT_NEAR(force[2] / expected, cos(angle), 1e-9);
    }
    scene_clear(&scene);
}

/* Two squares that meet along y at an angle, rising to both sides of x = 0. */
static struct job_body fold_body(struct vec3 vertices[6], int facets[2][4], double angle)
{
    const double c = cos(0.5 * angle), s = sin(0.5 * angle);
    for (int k = 0; k < 2; k++) {
        const double y = k == 0 ? -5.0 : 5.0;
        vertices[3 * k] = (struct vec3){-5.0 * c, y, 5.0 * s};
        vertices[3 * k + 1] = (struct vec3){0.0, y, 0.0};
        vertices[3 * k + 2] = (struct vec3){5.0 * c, y, 5.0 * s};
    }
    const int both[2][4] = {{0, 1, 4, 3}, {1, 2, 5, 4}};
    memcpy(facets, both, sizeof both);
    return mesh_body(6, vertices, 2, facets);
}

TEST(a_shallow_fold_is_one_contact_a_steep_one_two)
{
    const double degree = 0.017453292519943295;
    for (int k = 0; k < 2; k++) {
        struct vec3 vertices[6];
        int facets[2][4];
        struct job_body fold = fold_body(vertices, facets, (k == 0 ? 14.0 : 16.0) * degree);
        struct scene scene;
        scene_build(&scene, STEEL, 0.5, 1.0, 1, &fold, 1, 1.0);
        EXPECT(contacts_at(&scene, 0.0, 0.0, 1.0) == k + 1);
        scene_clear(&scene);
    }
}

TEST(a_thin_wedge_is_felt_on_its_near_side_only)
{
    /* A knife of 20 degrees, its edge along y; a soft sphere sinks into its upper side so far
     * that it reaches the lower one. */
    const double c = cos(0.34906585), s = sin(0.34906585);
    struct vec3 vertices[6] = {{0, -5, 0}, {5, -5, 0}, {5 * c, -5, -5 * s},
                               {0, 5, 0},  {5, 5, 0},  {5 * c, 5, -5 * s}};
    int facets[2][4] = {{0, 3, 4, 1}, {0, 2, 5, 3}};
    struct job_body wedge = mesh_body(6, vertices, 2, facets);
    struct scene scene;
    scene_build(&scene, RUBBER, 0.5, 1.0, 1, &wedge, 1, 1.0);
    EXPECT(contacts_at(&scene, 0.35, 0.0, 0.8) == 1);
    EXPECT(scene.spheres.force[0].lane[2] > 0.0 && scene.spheres.force[0].lane[0] == 0.0);
    scene_clear(&scene);
}

TEST(a_contact_stands_until_another_is_clearly_deeper)
{
    struct vec3 vertices[6];
    int facets[2][4];
    struct job_body fold = fold_body(vertices, facets, 0.2);
    const struct vec3 zero = {0, 0, 0};
    const double places[4] = {-0.01, 3e-4, 0.01, -3e-4}; /* across the fold [m] */
    struct scene scene;
    scene_build(&scene, RUBBER, 0.5, 1.0, 1, &fold, 1, 1.0);
    for (int k = 0; k < 4; k++) {
        put_sphere(&scene, 0, (struct vec3){places[k], 0, 0.99 / cos(0.1)}, zero, zero);
        search(&scene, true);
        apply(&scene);
        EXPECT(count_contacts(&scene) == 1);
        EXPECT(scene.facets.list[k / 2].history[CONTACT_RADIUS_LANE] > 0.0);
    }
    scene_clear(&scene);
}

TEST(patches_that_overlap_are_one_contact)
{
    /* A fold of 20 degrees, a sphere above its middle: patches meet where their radius,
     * sqrt(R overlap), is the distance of a foot to the middle, (R - overlap) sin(10 deg). */
    struct vec3 vertices[6];
    int facets[2][4];
    struct job_body fold = fold_body(vertices, facets, 0.34906585);
    const double meet = 0.0284; /* the smaller root for R = 1 */
    const struct vec3 zero = {0, 0, 0};
    /* Down from where they are apart and up again: one contact from 9/10 of the distance down,
     * two from the whole distance up. */
    const double overlaps[6] = {0.5 * meet, 1.1 * meet, 1.4 * meet,
                                1.1 * meet, 0.9 * meet, 0.5 * meet};
    const int expected[6] = {2, 2, 1, 1, 2, 2};
    struct scene scene;
    scene_build(&scene, RUBBER, 0.5, 1.0, 1, &fold, 1, 1.0);
    for (int k = 0; k < 6; k++) {
        put_sphere(&scene, 0, (struct vec3){0, 0, (1.0 - overlaps[k]) / cos(0.174532925)}, zero,
                   zero);
        search(&scene, true);
        apply(&scene);
        EXPECT(count_contacts(&scene) == expected[k]);
        EXPECT_NEAR(scene.spheres.force[0].lane[0], 0.0, 1e-6 * scene.spheres.force[0].lane[2]);
    }
    scene_clear(&scene);
}

/* Past the bottom of a fold of 11 degrees, as deep in it all the while: the force keeps its
 * size and turns by and by, not at once. */
TEST(a_shallow_fold_is_as_stiff_as_its_sides_and_turns_the_force_smoothly)
{
    enum { STEPS = 4000 };
    struct vec3 vertices[6];
    int facets[2][4];
    struct job_body fold = fold_body(vertices, facets, 0.2);
    struct scene scene;
    scene_build(&scene, STEEL, 0.0, 1.0, 1, &fold, 1, 1.0);
    struct vec3 before = {0, 0, 0};
    for (int k = 0; k <= STEPS; k++) {
        const double x = 4e-3 * ((double)k / (double)STEPS - 0.5);
        const double z = ((x < 0.0 ? -x : x) * sin(0.1) + 0.999) / cos(0.1);
        EXPECT(contacts_at(&scene, x, 0.0, z) == 1);
        const double *force = scene.spheres.force[0].lane;
        const struct vec3 now = {force[0], force[1], force[2]};
        const double size = vec3_norm(now);
        if (k > 0) {
            EXPECT_NEAR(size / vec3_norm(before), 1.0, 1e-9);
            /* Over BLEND x overlap / angle to each side of the middle: 1000 steps. */
            EXPECT(vec3_norm(vec3_sub(now, before)) < 4e-4 * size);
        }
        before = now;
    }
    EXPECT_NEAR(before.x / before.z, -0.1, 1e-3);
    scene_clear(&scene);
}

/* ---- Seams
 * ------------------------------------------------------------------------------------ */

/* How a sheet lies and moves while a sphere crosses it. */
struct crossing {
    double size; /* of the sheet, of 8 x 8 cells [m] */
    bool slopes;
    double overlap; /* [m] */
    struct vec3 drift;
    double rate; /* of turning about its normal [rad/s] */
    bool deforms;
};

/* Makes a sheet the surface of a body that deforms, at rest. */
static void make_skin(struct body *body, const struct job_body *asked)
{
    mesh_clear(&body->mesh);
    mesh_build_skin(&body->mesh, asked->n_vertices, asked->vertices, asked->n_facets,
                    (const int(*)[4])asked->facets);
    body->skin = body_skin_build(&body->mesh);
    body->moves = true;
}

/* Takes a sphere of radius 1 across a sheet and across one large quad in the same plane,
 * spinning so that it nearly rolls, from a place on the sheet, in cells; returns how much the
 * two force rows ever differ, relative to the force. */
static double worst_difference(enum sheet kind, const struct crossing *crossing,
                               struct vec3 from, struct vec3 towards)
{
    enum { STEPS = 400 };
    static struct sheet_store stores[2];
    const bool slopes = crossing->slopes;
    const struct vec3 drift = crossing->drift;
    const double cell = crossing->size / 8.0;
    struct job_body bodies[2] = {sheet_body(&stores[0], kind, crossing->size, slopes, 0.0),
                                 sheet_body(&stores[1], ONE_QUAD, crossing->size, slopes, 0.0)};
    struct scene scenes[2];
    const struct vec3 normal =
        slopes ? (struct vec3){-0.28, 0.0, 0.96} : (struct vec3){0, 0, 1};
    double worst = 0.0;
    struct job_motion motion = {
        .velocity = drift, .axis = normal, .rate = crossing->rate, .stop = (double)INFINITY};
    for (int s = 0; s < 2; s++) {
        bodies[s].n_motions = 1;
        bodies[s].motions = &motion;
        scene_build(&scenes[s], RUBBER, 20.0, 0.5, 1, &bodies[s], 1, 1.0);
    }
    if (crossing->deforms)
        make_skin(&scenes[0].bodies.list[0], &bodies[0]);
    for (int k = 1; k <= STEPS; k++) {
        for (int s = 0; s < 2; s++) {
            const double time = (double)k * scenes[s].dt;
            const struct vec3 way = vec3_scale(cell / ((double)STEPS * scenes[s].dt), towards);
            struct vec3 x = vec3_axpy(vec3_scale(cell, from), time, way);
            if (slopes)
                x = (struct vec3){0.96 * x.x, x.y, 0.28 * x.x};
            x = vec3_axpy(vec3_axpy(x, 1.0 - crossing->overlap, normal), time, drift);
            const struct vec3 v =
                slopes ? (struct vec3){0.96 * way.x, way.y, 0.28 * way.x} : way;
            const struct vec3 w = vec3_scale(0.99, vec3_cross(normal, v));
            bodies_place(&scenes[s].bodies, k, scenes[s].dt);
            put_sphere(&scenes[s], 0, x, vec3_add(v, drift), w);
            search(&scenes[s], false);
            apply(&scenes[s]);
            if (count_contacts(&scenes[s]) != 1)
                return (double)INFINITY;
        }
        const double *a = scenes[0].spheres.force[0].lane, *b = scenes[1].spheres.force[0].lane;
        for (int lane = 0; lane < 8; lane++) {
            const double size = sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
            const double difference = fabs(a[lane] - b[lane]) / size;
            worst = difference <= worst ? worst : difference;
        }
    }
    scene_clear(&scenes[0]);
    scene_clear(&scenes[1]);
    return worst;
}

static void expect_no_seam(enum sheet kind, const struct crossing *crossing)
{
    /* Anyhow; along a seam; along a diagonal, from vertex to vertex; standing on a vertex. */
    const struct vec3 ways[4][2] = {{{1.3, 1.7, 0}, {5.1, 3.3, 0}},
                                    {{1.0, 3.0, 0}, {6.0, 0.0, 0}},
                                    {{1.0, 1.0, 0}, {6.0, 6.0, 0}},
                                    {{3.0, 3.0, 0}, {1e-9, 1e-9, 0}}};
    for (int k = 0; k < 4; k++)
        EXPECT(worst_difference(kind, crossing, ways[k][0], ways[k][1]) < 1e-6);
}

TEST(a_sphere_that_rolls_over_coplanar_facets_feels_no_seam)
{
    for (int kind = QUADS; kind <= SLIVERS; kind++)
        for (int slopes = 0; slopes < 2; slopes++) {
            struct crossing crossing = {.size = 8.0, .slopes = slopes == 1, .overlap = 1e-5};
            expect_no_seam((enum sheet)kind, &crossing);
            crossing.overlap = 1e-2;
            expect_no_seam((enum sheet)kind, &crossing);
            crossing.drift = (struct vec3){0.3, -0.2, 0.1};
            crossing.rate = 10.0;
            expect_no_seam((enum sheet)kind, &crossing);
        }
}

TEST(facets_much_smaller_and_larger_than_spheres_have_no_seams_either)
{
    const double sizes[3] = {0.08, 0.8, 8e4};
    for (int k = 0; k < 3; k++)
        for (int kind = QUADS; kind <= SLIVERS; kind++) {
            const struct crossing crossing = {.size = sizes[k], .overlap = 1e-2};
            expect_no_seam((enum sheet)kind, &crossing);
        }
}

TEST(nor_has_a_plane_that_may_deform)
{
    const double sizes[3] = {0.8, 8.0, 8e4};
    for (int k = 0; k < 3; k++)
        for (int kind = QUADS; kind <= SLIVERS; kind++)
            for (int slopes = 0; slopes < (k < 2 ? 2 : 1); slopes++) {
                const struct crossing crossing = {
                    .size = sizes[k], .slopes = slopes == 1, .overlap = 1e-3, .deforms = true};
                expect_no_seam((enum sheet)kind, &crossing);
            }
}

TEST(facets_that_do_not_share_vertices_feel_like_one_plane)
{
    /* One square beside two, without a vertex in the middle of its side; soft, so that the seam
     * lies deep within the contact patch. */
    struct vec3 vertices[11] = {{0, 0, 0}, {4, 0, 0}, {4, 8, 0}, {0, 8, 0},
                                {4, 0, 0}, {8, 0, 0}, {8, 3, 0}, {4, 3, 0},
                                {8, 8, 0}, {4, 8, 0}, {4, 3, 0}};
    int facets[3][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}, {10, 6, 8, 9}};
    struct job_body body = mesh_body(11, vertices, 3, facets);
    struct scene scene;
    scene_build(&scene, RUBBER, 0.5, 1.0, 1, &body, 1, 1.0);
    EXPECT(contacts_at(&scene, 2.0, 2.0, 0.8) == 1);
    const double expected = scene.spheres.force[0].lane[2];
    for (int k = 0; k <= 300; k++) {
        const double part = (double)k / 300.0;
        EXPECT(contacts_at(&scene, 3.0 + 2.0 * part, 2.5 + part, 0.8) == 1);
        EXPECT_NEAR(scene.spheres.force[0].lane[2] / expected, 1.0, 1e-6);
        EXPECT_NEAR(scene.spheres.force[0].lane[0] / expected, 0.0, 1e-6);
    }
    scene_clear(&scene);
}

TEST(a_shallow_fold_passes_the_spring_on)
{
    struct vec3 vertices[6];
    int facets[2][4];
    struct job_body fold = fold_body(vertices, facets, 0.17);
    struct scene scene;
    scene_build(&scene, RUBBER, 20.0, 1.0, 1, &fold, 1, 1.0);
    /* Down the left side and up the right one at a constant height above the deeper of the
     * two. */
    double spring_before = 0.0, force_before = 0.0;
    for (int k = 0; k <= 400; k++) {
        const double x = 0.001 * (double)(k - 200), c = cos(0.085), s = sin(0.085);
        const double z = ((x < 0.0 ? -x : x) * s + 0.99) / c;
        put_sphere(&scene, 0, (struct vec3){x, 0, z}, (struct vec3){0, 0.5, 0},
                   (struct vec3){0, 0, 0});
        search(&scene, false);
        apply(&scene);
        EXPECT(count_contacts(&scene) == 1);
        const double *force = scene.spheres.force[0].lane;
        const double up = sqrt(force[0] * force[0] + force[2] * force[2]), along = -force[1];
        if (k > 0) {
            EXPECT_NEAR(up / force_before, 1.0, 1e-9);
            EXPECT(along > spring_before && along < spring_before + 0.02 * up);
        }
        force_before = up;
        spring_before = along;
    }
    scene_clear(&scene);
}

TEST(the_spring_keeps_its_size_when_it_turns)
{
    struct vec3 vertices[6];
    int facets[2][4];
    struct job_body fold = fold_body(vertices, facets, 0.2);
    const struct vec3 zero = {0, 0, 0};
    struct scene scene;
    scene_build(&scene, RUBBER, 20.0, 1.0, 1, &fold, 1, 1.0);
    scene.dt = 1e-12;
    double size[2];
    for (int k = 0; k < 2; k++) {
        /* Deeper in the left side, then in the right one. */
        const double x = k == 0 ? -0.01 : 0.01;
        put_sphere(&scene, 0, (struct vec3){x, 0, (0.01 * sin(0.1) + 0.99) / cos(0.1)}, zero,
                   zero);
        search(&scene, true);
        apply(&scene);
        if (k == 0) {
            scene.facets.list[0].history[0] = 3.0 * cos(0.1);
            scene.facets.list[0].history[2] = -3.0 * sin(0.1);
        }
        EXPECT(scene.facets.list[k].history[CONTACT_RADIUS_LANE] > 0.0);
        const double *h = scene.facets.list[k].history;
        size[k] = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    }
    EXPECT_NEAR(size[0], 3.0, 1e-12);
    EXPECT_NEAR(size[1], 3.0, 1e-8);
    EXPECT(scene.facets.list[1].history[2] > 0.0);
    scene_clear(&scene);
}

/* ---- The same bits
 * ---------------------------------------------------------------------------- */

/* A rough sheet, or a large block, in a box that moves. */
static void start_rough_scene(struct scene *scene, struct sheet_store *store, bool flat, int n)
{
    random_state = 7;
    struct job_motion motion = {.velocity = {0.2, 0.0, 0.1},
                                .pivot = {4.0, 4.0, 0.5},
                                .axis = {0.6, 0.0, 0.8},
                                .rate = 0.3,
                                .stop = 0.9};
    struct job_body bodies[2] = {sheet_body(store, MIXED, 8.0, false, 0.25),
                                 {.name = NAME,
                                  .geometry = JOB_GEOMETRY_BOX,
                                  .min = {-0.5, -0.5, -2.0},
                                  .max = {8.5, 8.5, 3.0},
                                  .n_motions = 1,
                                  .motions = &motion}};
    if (flat)
        bodies[0] = (struct job_body){.name = NAME,
                                      .geometry = JOB_GEOMETRY_BOX,
                                      .min = {-20.0, -20.0, -1.0},
                                      .max = {30.0, 30.0, 0.25}};
    scene_build(scene, RUBBER, 0.8, 0.6, 2, bodies, n, 0.4);
    scene->dt = 2e-3;
    scene->gravity = (struct vec3){0, 0, -9.81};
    for (int i = 0; i < n; i++)
        put_sphere(
            scene, i,
            (struct vec3){random_between(0.5, 7.5), random_between(0.5, 7.5),
                          random_between(0.7, 2.0)},
            (struct vec3){random_between(-3, 3), random_between(-3, 3), random_between(-3, 0)},
            (struct vec3){random_between(-9, 9), random_between(-9, 9), random_between(-9, 9)});
}

static bool is_same_state(const struct scene *a, const struct scene *b)
{
    const size_t n = (size_t)a->spheres.n_owned;
    struct facet_contact_record *records[2] = {NULL, NULL};
    const int n_a = facet_contacts_records(&a->facets, &a->spheres, 0, INT64_MAX, &records[0]);
    const int n_b = facet_contacts_records(&b->facets, &b->spheres, 0, INT64_MAX, &records[1]);
    bool same = n_a == n_b && memcmp(a->spheres.motion, b->spheres.motion, n * 64) == 0 &&
                memcmp(a->spheres.spin, b->spheres.spin, n * 64) == 0 &&
                memcmp(a->spheres.force, b->spheres.force, n * 64) == 0;
    for (int k = 0; k < n_a && same; k++)
        same = records[0][k].id == records[1][k].id &&
               records[0][k].body == records[1][k].body &&
               records[0][k].feature == records[1][k].feature &&
               memcmp(records[0][k].history, records[1][k].history,
                      sizeof records[0][k].history) == 0;
    for (int body = 0; body < a->bodies.n && same; body++) {
        struct body_load p = a->facets.loads[body], q = b->facets.loads[body];
        for (int x = 0; x < 3; x++) {
            exact_sum_normalise(&p.force[x]);
            exact_sum_normalise(&q.force[x]);
            exact_sum_normalise(&p.torque[x]);
            exact_sum_normalise(&q.torque[x]);
        }
        exact_sum_normalise(&p.work);
        exact_sum_normalise(&q.work);
        exact_sum_normalise(&p.wound);
        exact_sum_normalise(&q.wound);
        same = memcmp(&p, &q, sizeof p) == 0;
    }
    free(records[0]);
    free(records[1]);
    return same;
}

/* Out of memory and in again, as after a migration or a restart. */
static void carry_through_records(struct scene *scene)
{
    struct facet_contact_record *records = NULL;
    const int n =
        facet_contacts_records(&scene->facets, &scene->spheres, 0, INT64_MAX, &records);
    int *sphere = calloc((size_t)n + 1, sizeof *sphere);
    for (int k = 0; k < n; k++)
        sphere[k] = (int)(records[k].id - 100) / 3;
    facet_contacts_forget(&scene->facets);
    if (random_between(0.0, 1.0) < 0.5)
        search(scene, false);
    facet_contacts_restore(&scene->facets, n, records, sphere);
    search(scene, false);
    free(records);
    free(sphere);
}

/* All pairs, whose contacts are looked at one by one, against lists, which the kernel takes
 * face by face where it can. */
static void compare_lists(enum isa isa, bool flat)
{
    enum { N = 40, STEPS = 1500 };
    static struct sheet_store stores[2];
    struct scene all, listed;
    instruction_set = ISA_AUTO;
    start_rough_scene(&all, &stores[0], flat, N);
    instruction_set = isa;
    start_rough_scene(&listed, &stores[1], flat, N);
    instruction_set = ISA_AUTO;
    int wait = 0, most = 0;
    bool same = true;
    search(&all, true);
    for (int k = 0; k < STEPS && same; k++) {
        if (wait-- == 0) {
            wait = (int)random_between(0.0, 12.0);
            /* Nothing is faster than 60 m/s here. */
            for (int i = 0; i < N; i++)
                listed.spheres.allowance[i] = 60.0 * listed.dt * (double)wait;
            for (int b = 0; b < 2; b++)
                listed.body_allowance[b] =
                    listed.bodies.list[b].speed_max * listed.dt * (double)wait;
            if (k % 5 == 0)
                carry_through_records(&listed);
            else
                search(&listed, false);
        }
        apply(&all);
        apply(&listed);
        same = is_same_state(&all, &listed);
        const int n = count_contacts(&all);
        most = n > most ? n : most;
        integrate(&all);
        integrate(&listed);
    }
    EXPECT(same);
    EXPECT(most >= N);
    EXPECT(flat || listed.facets.n < all.facets.n / 4);
    for (int i = 0; i < N; i++)
        EXPECT(fabs(sphere_velocity(&all.spheres, i)[2]) < 60.0);
    scene_clear(&all);
    scene_clear(&listed);
}

TEST(lists_made_at_any_moment_give_the_same_bits)
{
    for (enum isa isa = ISA_GENERIC; isa < ISA_N; isa++) {
        if (!isa_runs(isa))
            continue;
        compare_lists(isa, false);
        compare_lists(isa, true);
    }
}

static double energy_in_springs(const struct scene *scene)
{
    struct exact_sum normal = {{0}, 0, 0}, springs = {{0}, 0, 0};
    facet_contacts_elastic_energy(&scene->facets, &scene->spheres, &scene->bodies,
                                  &scene->materials, &normal, &springs);
    return exact_sum_value(&springs);
}

static double wound_so_far(const struct scene *scene)
{
    return exact_sum_value(&scene->facets.loads[0].wound);
}

TEST(a_search_keeps_what_touches_even_out_of_reach)
{
    struct job_body plane = {
        .name = NAME, .geometry = JOB_GEOMETRY_PLANE, .normal = {0, 0, 1}, .extent = 8.0};
    struct scene scene;
    scene_build(&scene, RUBBER, 0.5, 1.0, 1, &plane, 2, 1.0);
    for (int last = 0; last < 2; last++) { /* in the middle of the list, and at its end */
        const int gone = last == 1 ? 1 : 0;
        const struct vec3 zero = {0, 0, 0};
        put_sphere(&scene, 1, (struct vec3){2.5, 0.0, 0.99}, zero, zero);
        EXPECT(contacts_at(&scene, 0.0, 0.0, 0.99) == 2);
        scene.facets.list[gone].history[0] = 3.0;
        const double held = energy_in_springs(&scene), wound = wound_so_far(&scene);
        scene.spheres.motion[gone].lane[2] = 5.0;
        search(&scene, false);
        EXPECT(scene.facets.n == 2 && count_contacts(&scene) == 2);
        apply(&scene);
        EXPECT(count_contacts(&scene) == 1);
        /* The spring went with it, but the work that wound it did not. */
        EXPECT(energy_in_springs(&scene) < 1e-6 * held && wound_so_far(&scene) == wound);
        search(&scene, false);
        EXPECT(scene.facets.n == 1);
    }
    scene_clear(&scene);
}

/* ---- Loads and energies
 * ------------------------------------------------------------------------ */

TEST(a_body_feels_the_opposite_of_what_its_spheres_feel)
{
    enum { N = 40 };
    static struct sheet_store store;
    struct scene scene;
    start_rough_scene(&scene, &store, false, N);
    struct exact_sum total[3] = {{{0}, 0, 0}};
    for (int k = 0; k < 300; k++) {
        search(&scene, true);
        apply(&scene);
        integrate(&scene);
    }
    memset(scene.facets.loads, 0, 2 * sizeof *scene.facets.loads);
    apply(&scene);
    struct vec3 torque = {0, 0, 0};
    for (int i = 0; i < N; i++) {
        const double *f = scene.spheres.force[i].lane, *x = sphere_position(&scene.spheres, i);
        for (int k = 0; k < 3; k++)
            exact_sum_add(&total[k], -f[k]);
        /* About the origin, the sphere's own part and its lever's. */
        torque = vec3_sub(torque, (struct vec3){f[4], f[5], f[6]});
        torque = vec3_sub(torque, vec3_cross((struct vec3){x[0], x[1], x[2]},
                                             (struct vec3){f[0], f[1], f[2]}));
    }
    struct vec3 on_bodies = {0, 0, 0};
    for (int b = 0; b < 2; b++) {
        const struct body_load *load = &scene.facets.loads[b];
        on_bodies = vec3_add(on_bodies, (struct vec3){exact_sum_value(&load->torque[0]),
                                                      exact_sum_value(&load->torque[1]),
                                                      exact_sum_value(&load->torque[2])});
        for (int k = 0; k < 3; k++) {
            struct exact_sum minus = load->force[k];
            for (int limb = 0; limb < 3; limb++)
                minus.limb[limb] = -minus.limb[limb];
            exact_sum_merge(&total[k], &minus);
        }
    }
    for (int k = 0; k < 3; k++)
        EXPECT_NEAR(exact_sum_value(&total[k]), 0.0, 1e-12);
    /* The law acts at the undeformed surface, the body's torque at the facet: apart by the
     * overlap. */
    EXPECT_NEAR(vec3_norm(vec3_sub(torque, on_bodies)) / vec3_norm(on_bodies), 0.0, 0.05);
    EXPECT(vec3_norm(on_bodies) > 1.0);
    scene_clear(&scene);
}

TEST(a_moving_wall_is_a_moving_sphere_seen_from_the_wall)
{
    struct job_body planes[2] = {
        {.name = NAME, .geometry = JOB_GEOMETRY_PLANE, .normal = {0, 0, 1}, .extent = 8.0}};
    planes[1] = planes[0];
    struct job_motion motion = {.velocity = {-0.3, 0.1, 0.2}, .stop = (double)INFINITY};
    planes[1].n_motions = 1;
    planes[1].motions = &motion;
    struct scene scenes[2];
    for (int s = 0; s < 2; s++) {
        scene_build(&scenes[s], RUBBER, 0.5, 0.7, 1, &planes[s], 1, 1.0);
        bodies_place(&scenes[s].bodies, 1, scenes[s].dt);
        const struct vec3 v = s == 0 ? (struct vec3){0.3, -0.1, -0.2} : (struct vec3){0, 0, 0};
        const struct vec3 x = {0.0, 0.0,
                               0.99 + scenes[s].dt * (s == 0 ? 0.0 : motion.velocity.z)};
        put_sphere(&scenes[s], 0, x, v, (struct vec3){0, 0, 0});
        search(&scenes[s], false);
        apply(&scenes[s]);
    }
    const double *a = scenes[0].spheres.force[0].lane, *b = scenes[1].spheres.force[0].lane;
    for (int lane = 0; lane < 8; lane++)
        EXPECT_NEAR(a[lane], b[lane], 1e-10 * a[2]);
    const double power = -0.3 * b[0] + 0.1 * b[1] + 0.2 * b[2];
    EXPECT_NEAR(exact_sum_value(&scenes[1].facets.loads[0].work), power * scenes[1].dt,
                1e-15 * a[2]);
    EXPECT(exact_sum_value(&scenes[0].facets.loads[0].work) == 0.0);
    scene_clear(&scenes[0]);
    scene_clear(&scenes[1]);
}

/* A belt whose surface runs is, at an instant, a plane that moves in its own plane; what points
 * out of the plane does nothing. */
TEST(a_surface_that_runs_is_a_plane_that_moves)
{
    struct job_motion motion = {.velocity = {-0.3, 0.1, 0.0}, .stop = (double)INFINITY};
    struct job_body planes[2] = {
        {.name = NAME, .geometry = JOB_GEOMETRY_PLANE, .normal = {0, 0, 1}, .extent = 8.0}};
    planes[1] = planes[0];
    planes[0].n_motions = 1;
    planes[0].motions = &motion;
    planes[1].surface.given = true;
    planes[1].surface.motion = motion;
    planes[1].surface.motion.velocity.z = 7.0;
    struct scene scenes[2];
    for (int s = 0; s < 2; s++) {
        scene_build(&scenes[s], RUBBER, 0.5, 0.7, 1, &planes[s], 1, 1.0);
        bodies_place(&scenes[s].bodies, 1, scenes[s].dt);
        put_sphere(&scenes[s], 0, (struct vec3){0.0, 0.0, 0.99}, (struct vec3){0, 0, -0.2},
                   (struct vec3){0, 1, 0});
        search(&scenes[s], false);
        apply(&scenes[s]);
    }
    EXPECT(memcmp(scenes[0].spheres.force, scenes[1].spheres.force, 64) == 0);
    EXPECT(exact_sum_value(&scenes[0].facets.loads[0].work) ==
           exact_sum_value(&scenes[1].facets.loads[0].work));
    EXPECT(exact_sum_value(&scenes[1].facets.loads[0].work) != 0.0);
    EXPECT(!scenes[1].bodies.list[0].moves && scenes[1].bodies.list[0].speed_max == 0.0);
    EXPECT_NEAR(scenes[1].bodies.list[0].surface_speed_max, sqrt(49.1), 1e-12);
    scene_clear(&scenes[0]);
    scene_clear(&scenes[1]);
}

TEST(a_roller_whose_surface_runs_is_a_roller_that_turns)
{
    struct job_motion motion = {.axis = {0, 1, 0}, .rate = 3.0, .stop = (double)INFINITY};
    struct job_body rollers[2] = {{.name = NAME,
                                   .geometry = JOB_GEOMETRY_CYLINDER,
                                   .from = {0, -4, 0},
                                   .to = {0, 4, 0},
                                   .radius = 2.0}};
    rollers[1] = rollers[0];
    rollers[0].n_motions = 1;
    rollers[0].motions = &motion;
    rollers[1].surface.given = true;
    rollers[1].surface.motion = motion;
    struct scene scenes[2];
    for (int s = 0; s < 2; s++) {
        scene_build(&scenes[s], RUBBER, 0.5, 0.7, 1, &rollers[s], 1, 1.0);
        bodies_place(&scenes[s].bodies, 1, scenes[s].dt);
        put_sphere(&scenes[s], 0, (struct vec3){0.6 * 2.99, 0.3, 0.8 * 2.99},
                   (struct vec3){0, 0, -0.2}, (struct vec3){0, 1, 0});
        search(&scenes[s], false);
        apply(&scenes[s]);
        EXPECT(count_contacts(&scenes[s]) == 1);
    }
    const double *a = scenes[0].spheres.force[0].lane, *b = scenes[1].spheres.force[0].lane;
    for (int lane = 0; lane < 8; lane++)
        EXPECT_NEAR(a[lane], b[lane], 1e-10 * a[2]);
    const struct vec3 p = body_spin(&scenes[0].bodies.list[0]);
    const struct vec3 q = body_spin(&scenes[1].bodies.list[0]);
    EXPECT(p.x == q.x && p.y == q.y && p.z == q.z && p.y == 3.0);
    EXPECT_NEAR(scenes[1].bodies.list[0].surface_speed_max, 6.0, 1e-12);
    scene_clear(&scenes[0]);
    scene_clear(&scenes[1]);
}

/* (3.7): a sphere laid on a belt slides until it rolls at 2/7 of its speed; the belt has then
 * given it 2/7 m v^2, and half of that is heat.  The belt begins to run at step 100.  Until the
 * spring is wound up, by 3 um after 5 us, friction is less: that is the tolerance while it
 * slides; afterwards the spring swings until damping has ended that. */
TEST(a_sphere_laid_on_a_belt_rolls_at_two_sevenths_of_its_speed)
{
    enum { BEGINS = 100 };
    const double mu = 0.3, g = 9.81, v_belt = 0.5, radius = 0.1;
    struct job_body belt = {
        .name = NAME, .geometry = JOB_GEOMETRY_PLANE, .normal = {0, 0, 1}, .extent = 8.0};
    belt.surface.given = true;
    belt.surface.motion = (struct job_motion){
        .velocity = {v_belt, 0, 0}, .start = BEGINS * 1e-5, .stop = (double)INFINITY};
    struct scene scene;
    scene_build(&scene, STEEL, mu, 0.5, 1, &belt, 1, radius);
    scene.gravity = (struct vec3){0, 0, -g};
    const double mass = 1.0 / sphere_inverse_mass(&scene.spheres, 0);
    const double stiffness = scene.materials.pairs[0].normal * sqrt(radius);
    put_sphere(&scene, 0, (struct vec3){0, 0, radius - pow(mass * g / stiffness, 2.0 / 3.0)},
               (struct vec3){0, 0, 0}, (struct vec3){0, 0, 0});
    search(&scene, false);
    const double slip = 2.0 / 7.0 * v_belt / (mu * g);
    const int n_slip = (int)(slip / scene.dt), half = n_slip / 2, n = BEGINS + 2 * n_slip;
    double heat = 0.0;
    const double *v = scene.spheres.motion[0].lane + 4, *w = scene.spheres.spin[0].lane + 4;
    for (int k = 0; k < n; k++) {
        if (k == BEGINS)
            EXPECT(v[0] == 0.0 && w[1] == 0.0);
        if (k == BEGINS + half) {
            /* The spring winds up first: late by the deflection over the belt's speed. */
            const double spent = half * scene.dt;
            EXPECT_NEAR(v[0], mu * g * spent, 0.01 * mu * g * spent);
            EXPECT_NEAR(-radius * w[1], 2.5 * v[0], 1e-9);
            EXPECT_NEAR(exact_sum_value(&scene.facets.loads[0].work), mass * v[0] * v_belt,
                        1e-3 * mass * v[0] * v_belt);
        }
        apply(&scene);
        for (int lane = 3; lane < 8; lane += 4)
            heat += scene.spheres.force[0].lane[lane];
        integrate(&scene);
    }
    heat += wound_so_far(&scene) - energy_in_springs(&scene);
    EXPECT_NEAR(v[0], 2.0 / 7.0 * v_belt, 1e-6 * v_belt);
    EXPECT_NEAR(v[0] - radius * w[1], v_belt, 1e-6 * v_belt);
    const double given = 2.0 / 7.0 * mass * v_belt * v_belt;
    EXPECT_NEAR(exact_sum_value(&scene.facets.loads[0].work), given, 1e-6 * given);
    EXPECT_NEAR(heat, 0.5 * given, 1e-4 * given);
    scene_clear(&scene);
}

/* An elastic sphere on a rigid plane: greatest overlap, force and duration (VERIFICATION: the
 * rigid plane is 1e6 times as stiff). */
TEST(an_elastic_impact_on_a_plane_is_hertz)
{
    struct job_body plane = {
        .name = NAME, .geometry = JOB_GEOMETRY_PLANE, .normal = {0, 0, 1}, .extent = 8.0};
    const struct job_material aluminium = {.density = 2699, .young = 70e9, .poisson = 0.3};
    struct scene scene;
    scene_build(&scene, aluminium, 0.0, 1.0, 1, &plane, 1, 0.1);
    scene.materials.pairs[0].normal = 4.0 / 3.0 * 70e9 / (1.0 - 0.3 * 0.3);
    scene.dt = 731.66e-6 / 2000.0;
    put_sphere(&scene, 0, (struct vec3){0, 0, 0.1}, (struct vec3){0, 0, -0.2},
               (struct vec3){0, 0, 0});
    double overlap_most = 0.0, force_most = 0.0, energy_most = 0.0;
    int steps = 0;
    const double mass = 1.0 / sphere_inverse_mass(&scene.spheres, 0);
    for (int k = 0; k < 3000; k++) {
        search(&scene, false);
        apply(&scene);
        struct exact_sum energy = {{0}, 0, 0}, springs = {{0}, 0, 0};
        facet_contacts_elastic_energy(&scene.facets, &scene.spheres, &scene.bodies,
                                      &scene.materials, &energy, &springs);
        const double force = scene.spheres.force[0].lane[2], stored = exact_sum_value(&energy);
        const double overlap = 0.1 * scene.facets.overlap_max;
        overlap_most = overlap > overlap_most ? overlap : overlap_most;
        force_most = force > force_most ? force : force_most;
        energy_most = stored > energy_most ? stored : energy_most;
        steps += force > 0.0;
        integrate(&scene);
    }
    EXPECT_NEAR(overlap_most, 49.717e-6, 1e-3 * 49.717e-6);
    EXPECT_NEAR(force_most, 11370.0, 1e-3 * 11370.0);
    EXPECT_NEAR((double)steps * scene.dt, 731.66e-6, 2e-3 * 731.66e-6);
    EXPECT_NEAR(energy_most, 0.5 * mass * 0.04, 1e-3 * 0.5 * mass * 0.04);
    EXPECT_NEAR(sphere_velocity(&scene.spheres, 0)[2], 0.2, 1e-4);
    scene_clear(&scene);
}

/* ---- Surfaces that deform
 * --------------------------------------------------------------------- */

/* The corners of a warped square together feel the opposite of the sphere's force, to the last
 * bit, and its moment, but for friction's lever: it acts on the surface, which is not all where
 * the sphere's own half-space would be. */
TEST(a_skin_takes_what_the_sphere_gives)
{
    struct vec3 vertices[] = {{-3, -3, 0}, {3, -3, 0.2}, {3, 3, 0}, {-3, 3, 0.3}};
    int facets[1][4] = {{0, 1, 2, 3}};
    struct job_body square = mesh_body(4, vertices, 1, facets);
    struct scene scene;
    scene_build(&scene, RUBBER, 0.5, 0.7, 1, &square, 1, 1.0);
    struct body *body = &scene.bodies.list[0];
    make_skin(body, &square);
    struct body_skin *skin = body->skin;
    EXPECT(body->mesh.n_corners == 4 && body->mesh.n_vertices == 5);
    for (int v = 0; v < 4; v++) {
        skin->velocity[v] = (struct vec3){0.3 * v, -0.1 * v, 0.5};
        skin->inverse_mass[v] = 1e-3 / (1.0 + v);
    }
    for (int k = 0; k < 20; k++) {
        const struct vec3 centre = {0.1 * k - 1.0, 0.7 - 0.05 * k, 1.05};
        put_sphere(&scene, 0, centre, (struct vec3){1, 2, -3}, (struct vec3){4, 5, 6});
        for (int v = 0; v < 4; v++)
            skin->force[v] = (struct exact_vector){{{0}}};
        search(&scene, false);
        apply(&scene);
        struct exact_vector sum = {{{0}}};
        struct vec3 moment = {0, 0, 0};
        double total[3];
        for (int v = 0; v < 4; v++) {
            double f[3];
            exact_vector_merge(&sum, &skin->force[v]);
            exact_vector_value(&skin->force[v], f);
            moment = vec3_add(moment, vec3_cross(vertices[v], (struct vec3){f[0], f[1], f[2]}));
        }
        exact_vector_value(&sum, total);
        const struct body_load *load = &scene.facets.loads[0];
        const double *force = scene.spheres.force[0].lane;
        EXPECT(force[2] > 0.0);
        for (int x = 0; x < 3; x++)
            EXPECT_NEAR(total[x], -force[x], 1e-15 * force[2]);
        const double torque[3] = {moment.x, moment.y, moment.z};
        for (int x = 0; x < 3; x++) {
            EXPECT_NEAR(torque[x], exact_sum_value(&load->torque[x]), 1e-4 * force[2]);
            scene.facets.loads[0].torque[x] = (struct exact_sum){{0}, 0, 0};
        }
    }
    scene_clear(&scene);
}

/* Where corners move as the sphere does nothing slips, and as a rigid body nothing is
 * different. */
TEST(a_skin_that_turns_is_a_body_that_turns)
{
    struct vec3 vertices[] = {{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}};
    int facets[2][4] = {{0, 1, 2, -1}, {0, 2, 3, -1}};
    double forces[2][8];
    for (int deforms = 0; deforms < 2; deforms++) {
        struct job_body plate = mesh_body(4, vertices, 2, facets);
        struct scene scene;
        scene_build(&scene, RUBBER, 0.5, 0.7, 1, &plate, 1, 1.0);
        struct body *body = &scene.bodies.list[0];
        const struct vec3 spin = {0.2, -0.1, 0.7}, drift = {1.0, 0.5, -0.2};
        body->moves = true;
        body->velocity_now = drift;
        body->spin_now = spin;
        if (deforms) {
            make_skin(body, &plate);
            for (int v = 0; v < 4; v++)
                body->skin->velocity[v] = vec3_add(drift, vec3_cross(spin, vertices[v]));
        }
        put_sphere(&scene, 0, (struct vec3){1.0, -0.4, 0.99}, (struct vec3){1, 2, -3},
                   (struct vec3){4, 5, 6});
        search(&scene, false);
        apply(&scene);
        memcpy(forces[deforms], scene.spheres.force[0].lane, sizeof forces[0]);
        scene_clear(&scene);
    }
    EXPECT(forces[0][2] > 0.0 && forces[0][0] != 0.0);
    for (int k = 0; k < 8; k++)
        EXPECT_NEAR(forces[1][k], forces[0][k], 1e-12 * forces[0][2]);
}

/* ---- Curved surfaces
 * -------------------------------------------------------------------------- */

static const double PI = 3.14159265358979323846;
static const double DRUM = 1.0, BALL = 0.1, DEPTH = 0.002; /* [m] */

/* Rolls a sphere once around inside a drum, at a fixed distance from the axis; *least and *most
 * become the extremes of the force towards the axis, *slip the largest along the wall. */
static void roll_around(int segments, double *least, double *most, double *slip)
{
    const struct job_material ore = {.density = 2400.0, .young = 5e7, .poisson = 0.25};
    struct job_body drum = {.name = NAME,
                            .geometry = JOB_GEOMETRY_CYLINDER,
                            .from = {0.0, 0.0, -1.0},
                            .to = {0.0, 0.0, 1.0},
                            .radius = DRUM,
                            .segments = segments};
    struct scene scene;
    scene_build(&scene, ore, 0.5, 1.0, 1, &drum, 1, BALL);
    const double out = DRUM - BALL + DEPTH, speed = 1.0; /* [m], [m/s] */
    const int n = 20011;
    scene.dt = 2.0 * PI * out / speed / (double)n;
    *least = 1e300;
    *most = *slip = 0.0;
    for (int k = 0; k < n; k++) {
        const double angle = 2.0 * PI * ((double)k + 0.3) / (double)n;
        const struct vec3 arm = {cos(angle), sin(angle), 0.0}, along = {-arm.y, arm.x, 0.0};
        /* Rolls without slip. */
        put_sphere(&scene, 0, vec3_scale(out, arm), vec3_scale(speed, along),
                   (struct vec3){0.0, 0.0, -speed / BALL});
        if (k % 50 == 0) {
            scene.spheres.allowance[0] = 0.1;
            search(&scene, false);
        }
        apply(&scene);
        const double *force = scene.spheres.force[0].lane;
        const struct vec3 f = {force[0], force[1], force[2]};
        const double size = -vec3_dot(f, arm),
                     grip = vec3_norm(vec3_axpy(f, -vec3_dot(f, arm), arm));
        *least = size < *least ? size : *least;
        *most = size > *most ? size : *most;
        *slip = grip > *slip ? grip : *slip;
    }
    EXPECT(scene.facets.n >= 1);
    scene_clear(&scene);
}

TEST(a_sphere_rolls_in_a_curved_drum_without_a_ripple_and_in_facets_with_that_of_their_sagitta)
{
    const double effective = 5e7 / (1.0 - 0.25 * 0.25) / 2.0; /* both are of ore */
    const double hertz = 4.0 / 3.0 * effective * sqrt(BALL) * DEPTH * sqrt(DEPTH);
    double least, most, slip;
    roll_around(0, &least, &most, &slip);
    EXPECT_NEAR(least, hertz, 1e-9 * hertz);
    EXPECT_NEAR(most, hertz, 1e-9 * hertz);
    EXPECT(slip < 1e-9 * hertz); /* nothing drags at it: friction could hold half of hertz */
    for (int n = 64; n <= 1024; n *= 4) {
        roll_around(n, &least, &most, &slip);
        /* From the circle of corners to the middle of a facet (THEORY.md 2.8). */
        const double sagitta = DRUM * (1.0 - cos(PI / (double)n));
        const double deepest = (DEPTH + sagitta) / DEPTH;
        EXPECT_NEAR(most, hertz * deepest * sqrt(deepest), 0.02 * (most - hertz));
        EXPECT(least > hertz * (1.0 - 1e-9) && least < hertz + 0.25 * (most - hertz));
    }
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
