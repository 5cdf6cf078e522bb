/* Shapes of bodies and their prescribed motion. */
#include "check.h"
#include "job/job.h"
#include "model/body.h"

static char NAME[] = "body";

static struct job_body at_rest(enum job_geometry geometry)
{
    return (struct job_body){.name = NAME, .geometry = geometry};
}

static void build(struct bodies *bodies, struct job_body *asked)
{
    const struct job job = {.n_bodies = 1, .bodies = asked};
    bodies_build(bodies, &job);
}

TEST(a_plane_is_a_square_that_faces_its_normal)
{
    struct job_body asked = at_rest(JOB_GEOMETRY_PLANE);
    asked.point = (struct vec3){1, 2, 3};
    asked.normal = (struct vec3){1, 2, -2};
    asked.extent = 4.0;
    struct bodies bodies;
    build(&bodies, &asked);
    const struct mesh *mesh = &bodies.list[0].mesh;
    EXPECT(mesh->n_faces == 1 && mesh->n_edges == 4);
    EXPECT_NEAR(vec3_dot(mesh->face_normal[0], asked.normal), 3.0, 1e-14);
    struct vec3 mean = {0, 0, 0};
    for (int v = 0; v < 4; v++)
        mean = vec3_axpy(mean, 0.25, mesh->place[v]);
    EXPECT_NEAR(vec3_norm(vec3_sub(mean, asked.point)), 0.0, 1e-14);
    EXPECT_NEAR(vec3_norm(vec3_sub(mesh->place[1], mesh->place[0])), 4.0, 1e-14);
    bodies_clear(&bodies);
}

TEST(a_plane_along_the_axes_has_exact_corners)
{
    struct job_body asked = at_rest(JOB_GEOMETRY_PLANE);
    asked.normal = (struct vec3){0, 0, 1};
    asked.extent = 2.0;
    struct bodies bodies;
    build(&bodies, &asked);
    for (int v = 0; v < 4; v++) {
        const struct vec3 corner = bodies.list[0].mesh.place[v];
        EXPECT(fabs(corner.x) == 1.0 && fabs(corner.y) == 1.0 && corner.z == 0.0);
    }
    EXPECT(bodies.list[0].mesh.face_normal[0].z == 1.0);
    bodies_clear(&bodies);
}

TEST(an_open_box_lacks_its_open_sides)
{
    struct job_body asked = at_rest(JOB_GEOMETRY_BOX);
    asked.min = (struct vec3){-3, -3, 0};
    asked.max = (struct vec3){3, 3, 3};
    asked.open = JOB_SIDE_TOP;
    struct bodies bodies;
    build(&bodies, &asked);
    const struct mesh *mesh = &bodies.list[0].mesh;
    EXPECT(mesh->n_faces == 5 && mesh->n_vertices == 8 && mesh->n_edges == 12);
    for (int f = 0; f < mesh->n_faces; f++)
        EXPECT(mesh->face_normal[f].z <= 0.0);
    EXPECT(!bodies.list[0].moves && bodies.list[0].speed_max == 0.0);
    bodies_clear(&bodies);
    asked.open = JOB_SIDE_TOP | JOB_SIDE_X_MIN | JOB_SIDE_X_MAX;
    build(&bodies, &asked);
    EXPECT(bodies.list[0].mesh.n_faces == 3);
    bodies_clear(&bodies);
}

TEST(a_hopper_has_four_sloping_quads)
{
    struct job_body asked = at_rest(JOB_GEOMETRY_HOPPER);
    asked.top[0] = asked.top[1] = 6.0;
    asked.outlet[0] = asked.outlet[1] = 1.6;
    asked.z[0] = 3.0;
    asked.z[1] = 6.0;
    struct bodies bodies;
    build(&bodies, &asked);
    const struct mesh *mesh = &bodies.list[0].mesh;
    EXPECT(mesh->n_faces == 4 && mesh->n_vertices == 8 && mesh->n_edges == 12);
    for (int f = 0; f < 4; f++) {
        EXPECT(mesh->faces[f].n == 4);
        EXPECT_NEAR(mesh->face_normal[f].z, -2.2 / sqrt(2.2 * 2.2 + 9.0), 1e-14);
    }
    bodies_clear(&bodies);
}

static struct job_body spinning_box(struct job_motion *motion)
{
    struct job_body asked = at_rest(JOB_GEOMETRY_BOX);
    asked.min = (struct vec3){1, -1, -1};
    asked.max = (struct vec3){2, 1, 1};
    *motion = (struct job_motion){
        .velocity = {0, 0, 0.5}, .axis = {0, 0, 1}, .rate = 2.0, .stop = (double)INFINITY};
    asked.n_motions = 1;
    asked.motions = motion;
    return asked;
}

TEST(motion_is_a_rotation_about_the_pivot_and_a_translation)
{
    struct job_motion motion;
    struct job_body asked = spinning_box(&motion);
    struct bodies bodies;
    build(&bodies, &asked);
    const double dt = 1e-3;
    bodies_place(&bodies, 700, dt);
    const struct body *body = &bodies.list[0];
    const double angle = 1.4;
    for (int v = 0; v < 8; v++) {
        const struct vec3 a = body->mesh.reference[v], b = body->mesh.place[v];
        EXPECT_NEAR(b.x, cos(angle) * a.x - sin(angle) * a.y, 1e-14);
        EXPECT_NEAR(b.y, sin(angle) * a.x + cos(angle) * a.y, 1e-14);
        EXPECT_NEAR(b.z, a.z + 0.35, 1e-14);
    }
    EXPECT(body->moves && body->spin_now.z == 2.0 && body->velocity_now.z == 0.5);
    EXPECT_NEAR(body->pivot_now.z, 0.35, 1e-15);
    bodies_clear(&bodies);
}

TEST(the_place_at_a_step_does_not_depend_on_the_way_there)
{
    struct job_motion motion;
    struct job_body asked = spinning_box(&motion);
    struct bodies walked, jumped;
    build(&walked, &asked);
    build(&jumped, &asked);
    for (int step = 1; step <= 777; step++)
        bodies_place(&walked, step, 1e-3);
    bodies_place(&jumped, 777, 1e-3);
    const struct mesh *a = &walked.list[0].mesh, *b = &jumped.list[0].mesh;
    EXPECT(memcmp(a->place, b->place, 8 * sizeof *a->place) == 0);
    EXPECT(memcmp(a->face_normal, b->face_normal, 6 * sizeof *a->face_normal) == 0);
    bodies_clear(&walked);
    bodies_clear(&jumped);
}

TEST(a_body_moves_only_between_start_and_stop)
{
    struct job_motion motion;
    struct job_body asked = spinning_box(&motion);
    motion.start = 0.1;
    motion.stop = 0.3;
    struct bodies bodies;
    build(&bodies, &asked);
    const struct body *body = &bodies.list[0];
    bodies_place(&bodies, 100, 1e-3);
    EXPECT(body->velocity_now.z == 0.0 && body->spin_now.z == 0.0);
    EXPECT(memcmp(body->mesh.place, body->mesh.reference, 8 * sizeof(struct vec3)) == 0);
    bodies_place(&bodies, 101, 1e-3);
    EXPECT(body->velocity_now.z == 0.5 && body->spin_now.z == 2.0);
    bodies_place(&bodies, 1000, 1e-3);
    EXPECT(body->velocity_now.z == 0.0 && body->spin_now.z == 0.0);
    EXPECT_NEAR(body->mesh.place[0].z, -0.9, 1e-14);
    bodies_clear(&bodies);
}

TEST(no_vertex_is_faster_than_speed_max)
{
    struct job_motion motion;
    struct job_body asked = spinning_box(&motion);
    struct bodies bodies;
    build(&bodies, &asked);
    const struct body *body = &bodies.list[0];
    EXPECT_NEAR(body->speed_max, 0.5 + 2.0 * sqrt(5.0), 1e-14);
    const double dt = 1e-4;
    for (int step = 1; step < 1000; step += 37) {
        struct vec3 before[8];
        bodies_place(&bodies, step - 1, dt);
        memcpy(before, body->mesh.place, sizeof before);
        bodies_place(&bodies, step, dt);
        for (int v = 0; v < 8; v++)
            EXPECT(vec3_norm(vec3_sub(body->mesh.place[v], before[v])) <= body->speed_max * dt);
    }
    bodies_clear(&bodies);
}

TEST(a_frame_moves_as_the_vertices_do)
{
    struct job_motion motions[2];
    struct job_body asked = spinning_box(&motions[0]);
    motions[1] = (struct job_motion){.velocity = {-3, 0, 1},
                                     .pivot = {0.5, 0.25, -2},
                                     .axis = {0.6, 0, 0.8},
                                     .rate = -1.5,
                                     .start = 0.2,
                                     .stop = 0.6};
    asked.n_motions = 2;
    struct bodies bodies;
    build(&bodies, &asked);
    for (int step = 0; step < 1000; step += 333) {
        bodies_place(&bodies, step, 1e-3);
        const struct body_frame frame = body_frame(&bodies.list[0], step * 1e-3);
        const struct mesh *mesh = &bodies.list[0].mesh;
        for (int v = 0; v < 8; v++) {
            const struct vec3 back = body_frame_reference(&frame, mesh->place[v]);
            EXPECT_NEAR(vec3_norm(vec3_sub(back, mesh->reference[v])), 0.0, 1e-14);
        }
    }
    bodies_clear(&bodies);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
