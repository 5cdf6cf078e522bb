/* Bodies that forces move, without spheres: answers from mechanics. */
#include "model/rigid.h"

#include <math.h>

#include "check.h"
#include "job/job.h"
#include "model/body.h"

static char NAME[] = "body";

static struct job_body box(struct vec3 min, struct vec3 max, int open)
{
    return (struct job_body){
        .name = NAME, .geometry = JOB_GEOMETRY_BOX, .min = min, .max = max, .open = open};
}

static void build(struct bodies *bodies, struct job_body *asked)
{
    const struct job job = {.n_bodies = 1, .bodies = asked, .time = {.end = 1.0, .step = 1e-3}};
    bodies_build(bodies, &job);
}

static void advance(struct rigid *rigid, int n, double dt, const struct rigid_load *load)
{
    for (int k = 0; k < n; k++) {
        rigid_plan(rigid, load, k * dt, dt);
        rigid_move(rigid);
    }
}

/* ---- Mass ---- */

TEST(a_box_has_the_inertia_of_a_box)
{
    struct job_body asked = box((struct vec3){10, 20, 30}, (struct vec3){11, 22, 34}, 0);
    struct bodies bodies;
    asked.free.given = true;
    asked.free.density = 3.0;
    build(&bodies, &asked);
    const struct rigid *rigid = bodies.list[0].rigid;
    EXPECT(rigid_fault(&asked, &bodies.list[0].mesh) == NULL);
    EXPECT_NEAR(rigid->mass, 24.0, 1e-13);
    EXPECT_NEAR(vec3_norm(vec3_sub(rigid->centre, (struct vec3){10.5, 21, 32})), 0.0, 1e-13);
    const double expected[6] = {2.0 * (4 + 16), 2.0 * (1 + 16), 2.0 * (1 + 4), 0, 0, 0};
    for (int k = 0; k < 6; k++)
        EXPECT_NEAR(rigid->tensor[k], expected[k], 1e-12);
    bodies_clear(&bodies);
}

/* A tetrahedron at the origin: V = 1/6, and with density 1 about its centre xx = 1/80 + ... */
TEST(a_tetrahedron_has_products_of_inertia)
{
    struct vec3 vertices[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    int facets[4][4] = {{0, 2, 1, -1}, {0, 1, 3, -1}, {0, 3, 2, -1}, {1, 2, 3, -1}};
    for (int way = 0; way < 2; way++) { /* also inside out */
        struct job_body asked = {.name = NAME,
                                 .geometry = JOB_GEOMETRY_MESH,
                                 .n_vertices = 4,
                                 .vertices = vertices,
                                 .n_facets = 4,
                                 .facets = facets,
                                 .free = {.given = true, .density = 1.0}};
        struct bodies bodies;
        build(&bodies, &asked);
        const struct rigid *rigid = bodies.list[0].rigid;
        EXPECT(rigid_fault(&asked, &bodies.list[0].mesh) == NULL);
        EXPECT_NEAR(rigid->mass, 1.0 / 6.0, 1e-15);
        EXPECT_NEAR(rigid->centre.z, 0.25, 1e-15);
        /* Integral of x^2 is 1/60, of x y 1/120; less V/16 each. */
        EXPECT_NEAR(rigid->tensor[0], 2.0 * (1.0 / 60.0 - 1.0 / 96.0), 1e-15);
        EXPECT_NEAR(rigid->tensor[4], -(1.0 / 120.0 - 1.0 / 96.0), 1e-15);
        bodies_clear(&bodies);
        for (int f = 0; f < 4; f++) {
            const int swap = facets[f][0];
            facets[f][0] = facets[f][1];
            facets[f][1] = swap;
        }
    }
    facets[0][0] = 2;
    facets[0][1] = 0;
    facets[1][0] = 0;
    facets[1][1] = 1;
}

TEST(an_open_surface_has_no_inside)
{
    struct job_body asked = box((struct vec3){0, 0, 0}, (struct vec3){1, 1, 1}, JOB_SIDE_TOP);
    struct bodies bodies;
    asked.free = (struct job_free){.given = true, .mass = 1.0, .inertia = {1, 1, 1, 0, 0, 0}};
    build(&bodies, &asked);
    EXPECT(rigid_fault(&asked, &bodies.list[0].mesh) == NULL);
    asked.free.density = 1.0;
    EXPECT(rigid_fault(&asked, &bodies.list[0].mesh) != NULL);
    bodies_clear(&bodies);
}

/* ---- One axis ---- */

static struct rigid *drum(struct bodies *bodies, struct job_body *asked)
{
    *asked = box((struct vec3){-1, -1, -1}, (struct vec3){1, 1, 1}, 0);
    asked->driven = (struct job_driven){.given = true,
                                        .kind = JOB_DRIVE_TURN,
                                        .axis = {0, 0, 1},
                                        .point = {5, 0, 0},
                                        .inertia = 2.0,
                                        .torque = 3.0};
    build(bodies, asked);
    return bodies->list[0].rigid;
}

TEST(a_torque_spins_a_drum)
{
    struct job_body asked;
    struct bodies bodies;
    struct rigid *rigid = drum(&bodies, &asked);
    const double dt = 1e-3, force = 4.0; /* along y, through x = 7: 2 m from the axis */
    const struct rigid_load load = {.force = {0, force, 0}, .torque = {0, 0, 7.0 * force}};
    advance(rigid, 500, dt, &load);
    const double acceleration = (3.0 + 2.0 * force) / 2.0;
    EXPECT_NEAR(rigid->state.speed, acceleration * 500 * dt, 1e-13);
    EXPECT_NEAR(rigid->state.way, 0.5 * acceleration * dt * dt * 500 * 501, 1e-13);
    const struct vec3 x = rigid_place(rigid, (struct vec3){6, 0, 0});
    EXPECT_NEAR(x.x, 5.0 + cos(rigid->state.way), 1e-14);
    EXPECT_NEAR(x.y, sin(rigid->state.way), 1e-14);
    /* Work of the torque and of the force, as the step counts it: what is kinetic. */
    EXPECT_NEAR(rigid->state.work / 3.0 * (3.0 + 2.0 * force),
                0.5 * 2.0 * rigid->state.speed * rigid->state.speed, 1e-11);
    EXPECT_NEAR(rigid_yield(rigid, (struct vec3){7, 0, 9}, (struct vec3){0, 1, 0}), 2.0, 1e-15);
    EXPECT(rigid_yield(rigid, (struct vec3){7, 0, 9}, (struct vec3){1, 0, 0}) == 0.0);
    bodies_clear(&bodies);
}

TEST(dry_friction_holds_and_stops_take_all_speed)
{
    struct job_body asked;
    struct bodies bodies;
    struct rigid *rigid = drum(&bodies, &asked);
    const struct rigid_load none = {.gravity = {0, 0, -10}};
    rigid->friction = 3.0;
    advance(rigid, 100, 1e-3, &none);
    EXPECT(rigid->state.speed == 0.0 && rigid->state.way == 0.0);
    rigid->friction = 1.0;
    rigid->limited = true;
    rigid->limits[1] = 0.125;
    advance(rigid, 1000, 1e-3, &none);
    EXPECT(rigid->state.speed == 0.0 && rigid->state.way == 0.125);
    /* All of the torque's work went to friction and the stop. */
    EXPECT_NEAR(rigid->state.work, 3.0 * 0.125, 2e-3);
    EXPECT_NEAR(rigid->state.rubbed, rigid->state.work, 1e-12);
    bodies_clear(&bodies);
}

TEST(damping_brings_a_slide_to_its_end_speed)
{
    struct job_body asked = box((struct vec3){-1, -1, -1}, (struct vec3){1, 1, 1}, 0);
    asked.driven = (struct job_driven){.given = true,
                                       .kind = JOB_DRIVE_SLIDE,
                                       .axis = {0, 0, -1},
                                       .mass = 0.5,
                                       .force = 2.0,
                                       .damping = 20.0,
                                       .start = 0.1};
    struct bodies bodies;
    build(&bodies, &asked);
    struct rigid *rigid = bodies.list[0].rigid;
    const struct rigid_load load = {.gravity = {0, 0, -10}};
    advance(rigid, 100, 1e-3, &load);
    EXPECT(rigid->state.speed == 0.0);
    for (int k = 100; k < 3000; k++) {
        rigid_plan(rigid, &load, k * 1e-3, 1e-3);
        rigid_move(rigid);
    }
    EXPECT_NEAR(rigid->state.speed, (2.0 / 0.5 + 10.0) / 20.0, 1e-14);
    bodies_clear(&bodies);
}

/* ---- Free ---- */

static struct rigid *top(struct bodies *bodies, struct job_body *asked)
{
    *asked = box((struct vec3){-1, -1, -1}, (struct vec3){1, 1, 1}, 0);
    /* Turns over and over: spun about the axis of the middle moment, nearly. */
    asked->free = (struct job_free){.given = true,
                                    .mass = 2.0,
                                    .inertia = {1.0, 2.0, 2.5, 0.1, 0, 0.05},
                                    .velocity = {1, 0, 0},
                                    .spin = {0.3, 10, 0.2}};
    build(bodies, asked);
    return bodies->list[0].rigid;
}

/* Where a corner is after a second; the largest error of the energy on the way. */
static struct vec3 spin_top(int n, double *off)
{
    struct job_body asked;
    struct bodies bodies;
    struct rigid *rigid = top(&bodies, &asked);
    const struct rigid_load none = {.gravity = {0, 0, 0}};
    const struct vec3 momentum = rigid->state.momentum;
    double energy = 0.0;
    *off = 0.0;
    for (int k = 0; k < n; k++) {
        rigid_plan(rigid, &none, (double)k / n, 1.0 / n);
        if (k == 0)
            energy = rigid->energies.kinetic_rotation;
        const double error = fabs(rigid->energies.kinetic_rotation / energy - 1.0);
        *off = error > *off ? error : *off;
        rigid_move(rigid);
    }
    EXPECT(memcmp(&momentum, &rigid->state.momentum, sizeof momentum) == 0);
    EXPECT_NEAR(rigid->state.centre.x, 1.0, 1e-16 * n);
    double size = 0.0;
    for (int k = 0; k < 4; k++)
        size += rigid->state.turn[k] * rigid->state.turn[k];
    EXPECT_NEAR(size, 1.0, 1e-15);
    const struct vec3 corner = rigid_place(rigid, (struct vec3){1, 1, 1});
    bodies_clear(&bodies);
    return corner;
}

TEST(an_asymmetric_top_keeps_momentum_and_energy)
{
    double off[3], none;
    const struct vec3 fine = spin_top(256000, &none);
    struct vec3 corner[3];
    double away[3];
    for (int k = 0; k < 3; k++) {
        corner[k] = spin_top(500 << (2 * k), &off[k]);
        away[k] = vec3_norm(vec3_sub(corner[k], fine));
    }
    /* Second order: a sixteenth at a quarter of the step. */
    EXPECT(away[0] < 0.02 && away[1] < away[0] / 14.0 && away[2] < away[1] / 14.0);
    EXPECT(off[0] < 1e-4 && off[1] < off[0] / 14.0);
}

TEST(energy_does_not_drift)
{
    struct job_body asked;
    struct bodies bodies;
    struct rigid *rigid = top(&bodies, &asked);
    const struct rigid_load none = {.gravity = {0, 0, 0}};
    const double dt = 1e-3;
    double most[2] = {0.0, 0.0}, energy = 0.0; /* in the first and the last tenth */
    enum { STEPS = 400000 };
    for (int k = 0; k < STEPS; k++) {
        rigid_plan(rigid, &none, k * dt, dt);
        energy = k == 0 ? rigid->energies.kinetic_rotation : energy;
        const double error = fabs(rigid->energies.kinetic_rotation / energy - 1.0);
        const int part = k < STEPS / 10 ? 0 : 1;
        most[part] = error > most[part] ? error : most[part];
        rigid_move(rigid);
    }
    EXPECT(most[0] < 1e-4 && most[1] < 1.05 * most[0]);
    bodies_clear(&bodies);
}

/* A force off the centre: its effect on the point where it acts is the yield. */
TEST(the_yield_is_what_a_force_does_to_its_point)
{
    struct job_body asked;
    struct bodies bodies;
    struct rigid *rigid = top(&bodies, &asked);
    rigid->state.velocity = rigid->state.momentum = rigid->state.spin = (struct vec3){0, 0, 0};
    rigid->state.turn[0] = 0.5;
    rigid->state.turn[1] = rigid->state.turn[2] = rigid->state.turn[3] = 0.5;
    rigid_refresh(rigid);
    const struct vec3 point = {0.7, -0.4, 0.9}, along = {0.48, 0.6, 0.64};
    const double dt = 1e-9;
    const struct rigid_load load = {.force = along, .torque = vec3_cross(point, along)};
    rigid_plan(rigid, &load, 0.0, dt);
    rigid_move(rigid);
    const struct vec3 velocity =
        vec3_add(rigid->state.velocity, vec3_cross(rigid->state.spin, point));
    const double yield = rigid_yield(rigid, point, along);
    EXPECT_NEAR(vec3_dot(velocity, along) / dt, yield, 1e-6);
    EXPECT(yield <= rigid_yield_most(rigid, point));
    bodies_clear(&bodies);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
