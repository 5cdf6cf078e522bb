/* Prescribed motions against closed forms; velocities lead from place to place. */
#include "model/motion.h"

#include <math.h>

#include "check.h"
#include "job/job.h"
#include "model/body.h"

static const double TWO_PI = 6.283185307179586;
static char NAME[] = "body";

TEST(an_oscillation_is_a_sine_that_begins_where_the_body_is)
{
    const struct job_motion motion = {.oscillation = {.direction = {0.6, 0, 0.8},
                                                      .amplitude = 0.02,
                                                      .frequency = 7.0,
                                                      .phase = 0.5},
                                      .start = 0.1,
                                      .stop = 0.9};
    const double dt = 1e-4;
    for (int step = 0; step < 12000; step += 7) {
        const double time = step * dt, t = time < 0.1 ? 0.0 : (time < 0.9 ? time : 0.9) - 0.1;
        const double way = 0.02 * (sin(TWO_PI * 7.0 * t + 0.5) - sin(0.5));
        const struct motion_place place = motion_place(&motion, time);
        EXPECT_NEAR(place.shift.x, 0.6 * way, 1e-15);
        EXPECT_NEAR(place.shift.z, 0.8 * way, 1e-15);
        const struct motion_place before = motion_place(&motion, time - dt);
        const struct motion_rate rate = motion_rate(&motion, time - 0.5 * dt, dt);
        /* Difference of places: their rounding over dt. */
        EXPECT_NEAR(rate.velocity.z, (place.shift.z - before.shift.z) / dt, 1e-11);
        EXPECT(fabs(rate.velocity.z) <= motion_speed_most(&motion));
    }
}

TEST(a_swing_is_a_sine_of_the_angle)
{
    const struct job_motion motion = {
        .swing = {.pivot = {1, 0, 0}, .axis = {0, 0, 1}, .amplitude = 0.3, .frequency = 2.0},
        .stop = (double)INFINITY};
    const struct motion_place place = motion_place(&motion, 0.07);
    const double angle = 0.3 * sin(TWO_PI * 2.0 * 0.07);
    const struct vec3 x = motion_apply(&place, (struct vec3){2, 0, 5});
    EXPECT_NEAR(x.x, 1.0 + cos(angle), 1e-15);
    EXPECT_NEAR(x.y, sin(angle), 1e-15);
    EXPECT(x.z == 5.0);
    const double rate = 0.3 * TWO_PI * 2.0 * cos(TWO_PI * 2.0 * 0.07), dt = 1e-5;
    /* The mean over a step lacks (omega dt)^2 / 24 of the rate in its middle. */
    EXPECT_NEAR(motion_rate(&motion, 0.07, dt).spin.z, rate, 1e-8);
    EXPECT_NEAR(motion_spin_most(&motion), 0.3 * TWO_PI * 2.0, 1e-15);
}

static struct job_motion path_of(struct job_path_point *points, int n)
{
    return (struct job_motion){
        .path = {.given = true, .n = n, .points = points, .axis = {1, 0, 0}},
        .start = 0.5,
        .stop = (double)INFINITY};
}

TEST(a_path_goes_straight_from_point_to_point)
{
    struct job_path_point points[] = {{0.1, {5, 0, 0}, 0.0},
                                      {0.2, {5, 1, 0}, 0.4},
                                      {0.6, {5, 1, 2}, 0.4},
                                      {0.7, {4, 1, 2}, -1.0}};
    const struct job_motion motion = path_of(points, 4);
    const struct {
        double time;
        struct vec3 shift;
        double angle;
    } expected[] = {{0.0, {0, 0, 0}, 0.0},  {0.6, {0, 0, 0}, 0.0}, {0.65, {0, 0.5, 0}, 0.2},
                    {0.9, {0, 1, 1}, 0.4},  {1.1, {0, 1, 2}, 0.4}, {1.15, {-0.5, 1, 2}, -0.3},
                    {7.0, {-1, 1, 2}, -1.0}};
    for (size_t k = 0; k < sizeof expected / sizeof *expected; k++) {
        const struct motion_place place = motion_place(&motion, expected[k].time);
        EXPECT_NEAR(vec3_norm(vec3_sub(place.shift, expected[k].shift)), 0.0, 1e-14);
        EXPECT_NEAR(place.sine, sin(expected[k].angle), 1e-14);
    }
    EXPECT_NEAR(motion_speed_most(&motion), 10.0, 1e-12);
    EXPECT_NEAR(motion_spin_most(&motion), 14.0, 1e-12);
}

/* Bends need not fall on steps. */
TEST(velocities_of_a_path_lead_from_place_to_place)
{
    struct job_path_point points[] = {{0.0, {0, 0, 0}, 0.0},
                                      {0.0137, {1, 1, 0}, 0.4},
                                      {0.0141, {1, 0.9, 0}, 0.3},
                                      {0.05, {0, 1, 2}, 1.0}};
    const struct job_motion motion = path_of(points, 4);
    const double dt = 1e-3;
    for (int step = 495; step < 560; step++) {
        const struct motion_place a = motion_place(&motion, (step - 1) * dt),
                                  b = motion_place(&motion, step * dt);
        const struct motion_rate rate = motion_rate(&motion, (step - 0.5) * dt, dt);
        const struct vec3 way = vec3_sub(b.shift, a.shift);
        EXPECT_NEAR(vec3_norm(vec3_sub(vec3_scale(dt, rate.velocity), way)), 0.0, 1e-13);
        EXPECT_NEAR(sin(dt * rate.spin.x), b.sine * a.cosine - b.cosine * a.sine, 1e-13);
    }
    /* Within one piece the velocity is its slope, without the rounding of places. */
    EXPECT(motion_rate(&motion, 0.5 + 30.5 * dt, dt).velocity.z == 1.0 / (0.05 - 0.0141) * 2.0);
}

/* ---- Several motions of one body ---- */

static void build(struct bodies *bodies, struct job_motion *motions, int n)
{
    struct job_body asked = {.name = NAME,
                             .geometry = JOB_GEOMETRY_BOX,
                             .min = {1, -1, -1},
                             .max = {2, 1, 1},
                             .n_motions = n,
                             .motions = motions};
    const struct job job = {
        .n_bodies = 1, .bodies = &asked, .time = {.end = 3.0, .step = 1e-3}};
    bodies_build(bodies, &job);
}

TEST(motions_act_one_after_the_other)
{
    const double quarter = 0.25 * TWO_PI, forever = (double)INFINITY;
    struct job_motion motions[] = {{.axis = {0, 0, 1}, .rate = quarter, .stop = 1.0},
                                   {.velocity = {0, 3, 0}, .start = 1.0, .stop = 2.0},
                                   {.pivot = {0, 3, 0},
                                    .axis = {0, 0, 1},
                                    .rate = quarter,
                                    .start = 2.0,
                                    .stop = forever}};
    struct bodies bodies;
    build(&bodies, motions, 3);
    bodies_place(&bodies, 3000, 1e-3);
    const struct body *body = &bodies.list[0];
    for (int v = 0; v < 8; v++) { /* half a turn about z, then 3 along y */
        const struct vec3 a = body->mesh.reference[v], b = body->mesh.place[v];
        EXPECT_NEAR(b.x, -a.x, 1e-14);
        EXPECT_NEAR(b.y, 3.0 - a.y, 1e-14);
    }
    bodies_clear(&bodies);
}

TEST(velocities_of_motions_together_are_those_of_the_vertices)
{
    const double forever = (double)INFINITY;
    struct job_path_point points[] = {{0.0, {0, 0, 0}, 0.0}, {5.0, {0, 0, 4}, 3.0}};
    struct job_motion motions[] = {
        {.pivot = {1, 0, 0}, .axis = {0, 0.6, 0.8}, .rate = 2.0, .stop = forever},
        {.oscillation = {{1, 0, 0}, 0.3, 1.5, 0.2}, .stop = forever},
        {.path = {.given = true, .n = 2, .points = points, .axis = {0, 0, 1}},
         .stop = forever}};
    struct bodies bodies;
    build(&bodies, motions, 3);
    const struct body *body = &bodies.list[0];
    const double dt = 1e-4;
    for (int step = 1; step < 20000; step += 997) {
        struct vec3 before[8];
        bodies_place(&bodies, step - 1, dt);
        memcpy(before, body->mesh.place, sizeof before);
        bodies_place(&bodies, step, dt);
        for (int v = 0; v < 8; v++) {
            const struct vec3 x = body->mesh.place[v],
                              moved = vec3_scale(1.0 / dt, vec3_sub(x, before[v]));
            const struct vec3 v_x = vec3_add(
                body->velocity_now, vec3_cross(body->spin_now, vec3_sub(x, body->pivot_now)));
            /* Velocity is that of the middle of the step at the place of its end: half a step
             * of accelerations up to 40 m/s2. */
            EXPECT(vec3_norm(vec3_sub(moved, v_x)) < 0.5 * dt * 40.0);
            EXPECT(vec3_norm(moved) <= body->speed_max);
        }
    }
    bodies_clear(&bodies);
}

TEST(a_body_comes_and_goes_at_steps)
{
    struct job_body asked = {.name = NAME,
                             .geometry = JOB_GEOMETRY_BOX,
                             .max = {1, 1, 1},
                             .comes_and_goes = true,
                             .active = {0.2, 0.3}};
    const struct job job = {
        .n_bodies = 1, .bodies = &asked, .time = {.end = 1.0, .step = 1e-3}};
    struct bodies bodies;
    bodies_build(&bodies, &job);
    EXPECT(!body_exists(&bodies.list[0], 199, 1e-3) && body_exists(&bodies.list[0], 200, 1e-3));
    EXPECT(body_exists(&bodies.list[0], 299, 1e-3) && !body_exists(&bodies.list[0], 300, 1e-3));
    bodies_clear(&bodies);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
