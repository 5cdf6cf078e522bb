/* Regions: what is inside of them, at which distance from their surface, and their volume. */
#include "model/region.h"

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/random.h"
#include "check.h"
#include "model/body.h"

enum { POINTS = 20000 };

static const double PI = 3.14159265358979323846;

static char body_name[] = "shell";

/* A region that stands in the test's own words. */
static struct region simple(struct job_region asked)
{
    struct region region;
    char *why;
    EXPECT(region_build(&region, &asked, NULL, &why));
    return region;
}

/* The share of the bounds that is inside, against the volume: four deviations of a count. */
static void expect_volume(const struct region *region, double volume)
{
    const struct vec3 size = vec3_sub(region->high, region->low);
    const double bounds = size.x * size.y * size.z, share = volume / bounds;
    int n = 0;
    for (uint64_t k = 0; k < POINTS; k++)
        n += region_contains(region, region_point(region, 0.0, 1, 2, k), 0.0);
    EXPECT_NEAR(region->volume, volume, 1e-12 * volume);
    EXPECT_NEAR((double)n / POINTS, share, 4.0 * sqrt(share * (1.0 - share) / POINTS) + 1e-12);
}

TEST(boxes)
{
    const struct region box =
        simple((struct job_region){.kind = JOB_REGION_BOX, .min = {1, 2, 3}, .max = {2, 4, 6}});
    expect_volume(&box, 6.0);
    EXPECT(region_contains(&box, (struct vec3){1.5, 3.0, 3.5}, 0.5));
    EXPECT(!region_contains(&box, (struct vec3){1.5, 3.0, 3.4375}, 0.5));
    EXPECT(!region_contains(&box, (struct vec3){1.5, 4.1, 5.0}, 0.0));
}

TEST(cylinders)
{
    const struct region region = simple((struct job_region){
        .kind = JOB_REGION_CYLINDER, .from = {1, 1, 1}, .to = {3, 3, 2}, .radius = 0.5});
    EXPECT_NEAR(region.low.x, 1.0 - 0.5 * sqrt(5.0) / 3.0, 1e-14);
    EXPECT_NEAR(region.high.z, 2.0 + 0.5 * sqrt(8.0) / 3.0, 1e-14);
    expect_volume(&region, 0.75 * PI);
    const struct vec3 middle = {2.0, 2.0, 1.5};
    EXPECT(region_contains(&region, middle, 0.4999));
    EXPECT(!region_contains(&region, middle, 0.5001));
    EXPECT(!region_contains(&region, (struct vec3){1.0, 1.0, 1.0}, 0.01));
}

TEST(balls)
{
    const struct region region = simple(
        (struct job_region){.kind = JOB_REGION_SPHERE, .centre = {1, 2, 3}, .radius = 2.0});
    expect_volume(&region, 32.0 / 3.0 * PI);
    EXPECT(region_contains(&region, (struct vec3){2.0, 2.0, 3.0}, 1.0));
    EXPECT(!region_contains(&region, (struct vec3){2.1, 2.0, 3.0}, 1.0));
}

/* Points keep the margin; where there is no room they stay in the middle. */
TEST(points_of_the_bounds)
{
    const struct region box = simple(
        (struct job_region){.kind = JOB_REGION_BOX, .min = {0, 0, 0}, .max = {1, 1, 0.1}});
    for (uint64_t k = 0; k < 1000; k++) {
        const struct vec3 x = region_point(&box, 0.2, 1, 2, k);
        EXPECT(x.x >= 0.2 && x.x < 0.8 && x.y >= 0.2 && x.y < 0.8 && x.z == 0.05);
    }
}

/* ------------------------------------------------------------------------------- bodies */

static struct bodies bodies;

static void begin_body(struct job_body asked)
{
    static struct job_body body;
    static struct job job;
    body = asked;
    body.name = body_name;
    job = (struct job){.n_bodies = 1, .bodies = &body};
    bodies_build(&bodies, &job);
}

static bool inside(struct region *region, char **why)
{
    const struct job_region asked = {.kind = JOB_REGION_INSIDE, .body = body_name};
    return region_build(region, &asked, &bodies, why);
}

static void end_body(struct region *region)
{
    region_clear(region);
    bodies_clear(&bodies);
}

/* A box of a body is a box: also for points in line with its edges, corners and diagonals. */
/* A region that reaches further by `more` on all sides. */
static struct job_region grown(struct job_region asked, double more)
{
    const struct vec3 all = {more, more, more}, along = vec3_sub(asked.to, asked.from);
    const double length = vec3_norm(along), share = length > 0.0 ? more / length : 0.0;
    asked.min = vec3_sub(asked.min, all);
    asked.max = vec3_add(asked.max, all);
    asked.from = vec3_axpy(asked.from, -share, along);
    asked.to = vec3_axpy(asked.to, share, along);
    asked.radius += more;
    return asked;
}

/* Of random ways those that pass through the region, beside points along them. */
static void expect_met(struct job_region asked)
{
    enum { WAYS = 2000, PARTS = 500 };
    const double longest = 4.0;
    const struct region region = simple(asked), more = simple(grown(asked, longest / PARTS));
    const struct region around = simple(
        (struct job_region){.kind = JOB_REGION_BOX, .min = {-1, -1, -1}, .max = {1, 1, 1}});
    int n_through = 0;
    for (uint64_t k = 0; k < WAYS; k++) {
        const struct vec3 x = region_point(&around, 0.0, 3, 4, 2 * k),
                          from = region_point(&around, 0.0, 3, 4, 2 * k + 1),
                          way = vec3_sub(x, from);
        bool within = false, near = false;
        for (int p = 0; p <= PARTS; p++) {
            const struct vec3 at = vec3_axpy(from, (double)p / PARTS, way);
            within = within || region_contains(&region, at, 0.0);
            near = near || region_contains(&more, at, 0.0);
        }
        const bool met = region_is_met(&region, x, way);
        EXPECT(met || !within);
        EXPECT(!met || near);
        n_through += met && !region_contains(&region, x, 0.0);
    }
    EXPECT(n_through > WAYS / 50 && n_through < WAYS / 2);
}

TEST(ways_through)
{
    expect_met((struct job_region){
        .kind = JOB_REGION_BOX, .min = {-0.5, -0.4, 0.1}, .max = {0.3, 0.6, 0.1001}});
    expect_met((struct job_region){
        .kind = JOB_REGION_BOX, .min = {-0.2, -0.3, -0.1}, .max = {0.4, 0.1, 0.5}});
    expect_met((struct job_region){.kind = JOB_REGION_CYLINDER,
                                   .from = {0, 0.1, 0},
                                   .to = {0.001, 0.102, 0.003},
                                   .radius = 0.6});
    expect_met((struct job_region){.kind = JOB_REGION_CYLINDER,
                                   .from = {-0.8, -0.5, 0},
                                   .to = {0.6, 0.6, 0.4},
                                   .radius = 0.1});
    expect_met((struct job_region){
        .kind = JOB_REGION_SPHERE, .centre = {0.1, 0.2, -0.1}, .radius = 0.3});
    /* Along a side, on it and beside it; and no way at all. */
    const struct region box =
        simple((struct job_region){.kind = JOB_REGION_BOX, .min = {0, 0, 0}, .max = {1, 1, 1}});
    const struct vec3 along = {9.0, 0.0, 0.0}, none = {0.0, 0.0, 0.0};
    EXPECT(region_is_met(&box, (struct vec3){5.0, 1.0, 0.5}, along));
    EXPECT(!region_is_met(&box, (struct vec3){5.0, 1.0000001, 0.5}, along));
    EXPECT(region_is_met(&box, (struct vec3){0.5, 0.5, 0.5}, none));
    EXPECT(!region_is_met(&box, (struct vec3){1.5, 0.5, 0.5}, none));
}

TEST(inside_of_a_box)
{
    struct region region, box;
    char *why;
    begin_body(
        (struct job_body){.geometry = JOB_GEOMETRY_BOX, .min = {-1, -1, -1}, .max = {1, 1, 2}});
    EXPECT(inside(&region, &why));
    box = simple(
        (struct job_region){.kind = JOB_REGION_BOX, .min = {-1, -1, -1}, .max = {1, 1, 2}});
    expect_volume(&region, 12.0);
    for (int i = -6; i <= 6; i++) {
        for (int j = -6; j <= 6; j++) {
            for (int k = -6; k <= 10; k++) {
                const struct vec3 x = {0.25 * i, 0.25 * j, 0.25 * k};
                EXPECT(region_contains(&region, x, 0.125) == region_contains(&box, x, 0.125));
                EXPECT(region_contains(&region, x, 0.25) == region_contains(&box, x, 0.25));
            }
        }
    }
    end_body(&region);
}

/* A ball of many slender triangles: rings of latitude, turned so that nothing is aligned. */
static void begin_ball(int n, double radius, bool open, bool turned)
{
    const int n_vertices = 2 + (n - 1) * 2 * n;
    struct vec3 *x = array_allocate((size_t)n_vertices, sizeof *x);
    int(*facets)[4] = array_allocate((size_t)(2 * n * n), sizeof *facets), n_facets = 0;
    x[0] = (struct vec3){0.0, 0.0, radius};
    x[1] = (struct vec3){0.0, 0.0, -radius};
    for (int i = 1; i < n; i++)
        for (int j = 0; j < 2 * n; j++)
            x[2 + (i - 1) * 2 * n + j] = (struct vec3){
                radius * sin(PI * i / n) * cos(PI * j / n),
                radius * sin(PI * i / n) * sin(PI * j / n), radius * cos(PI * i / n)};
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < 2 * n; j++) {
            const int above = 2 + (i - 1) * 2 * n, here = above + 2 * n;
            const int next = (j + 1) % (2 * n);
            const int a = i == 0 ? 0 : above + j, b = i == n - 1 ? 1 : here + j;
            const int c = i == n - 1 ? -1 : here + next, d = i == 0 ? -1 : above + next;
            const int full[4] = {a, b, c < 0 ? d : c, c < 0 ? -1 : d};
            memcpy(facets[n_facets++], full, sizeof full);
        }
    }
    if (turned) {
        const int swapped = facets[5][0];
        facets[5][0] = facets[5][1];
        facets[5][1] = swapped;
    }
    begin_body((struct job_body){.geometry = JOB_GEOMETRY_MESH,
                                 .n_vertices = n_vertices,
                                 .vertices = x,
                                 .n_facets = open ? n_facets - 1 : n_facets,
                                 .facets = facets});
    free(x);
    free(facets);
}

/* Inside by the surface is inside by the distance, up to the facets' sagitta, and the poles and
 * the meridians, where the lines up pass through vertices, are no exception. */
TEST(inside_of_a_ball_of_triangles)
{
    const int n = 24;
    const double flat = cos(PI / n) * cos(0.5 * PI / n);
    struct region region;
    char *why;
    begin_ball(n, 1.0, false, false);
    EXPECT(inside(&region, &why));
    EXPECT(region.volume < 4.0 / 3.0 * PI && region.volume > 4.0 / 3.0 * PI * 0.97);
    for (uint64_t k = 0; k < POINTS; k++) {
        struct vec3 x = region_point(&region, 0.0, 1, 2, k);
        if (k % 4 == 1)
            x.y = 0.0;
        if (k % 4 == 2)
            x = (struct vec3){0.0, 0.0, x.z};
        if (k % 4 == 3) /* right above or below a vertex */
            x = (struct vec3){sin(PI * 5 / n) * cos(PI * 7 / n),
                              sin(PI * 5 / n) * sin(PI * 7 / n), x.z};
        const double r = vec3_norm(x);
        const double margin = 0.2 * random_unit(3, 3, k);
        if (r < flat - margin)
            EXPECT(region_contains(&region, x, margin));
        if (r > 1.0 - margin + 1e-12)
            EXPECT(!region_contains(&region, x, margin));
    }
    end_body(&region);
}

TEST(surfaces_that_are_not_closed)
{
    struct region region;
    char *why;
    begin_ball(6, 1.0, true, false);
    EXPECT(!inside(&region, &why));
    EXPECT(strstr(why, "'shell' is not closed: 3 of its edges are open, one at [") != NULL);
    free(why);
    end_body(&region);
    begin_ball(6, 1.0, false, true);
    EXPECT(!inside(&region, &why));
    EXPECT(strstr(why, "has facets that face each other's backs at 3 edges") != NULL);
    free(why);
    end_body(&region);
    begin_body((struct job_body){.geometry = JOB_GEOMETRY_BOX,
                                 .min = {0, 0, 0},
                                 .max = {1, 1, 1},
                                 .open = JOB_SIDE_TOP});
    EXPECT(!inside(&region, &why));
    EXPECT(strstr(why, "'shell' is not closed: 4 of its edges are open") != NULL);
    free(why);
    end_body(&region);
}

/* A hollow box: within the walls is inside, the hollow is not. */
TEST(walls_of_a_hollow_body)
{
    static const int outer[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    struct vec3 x[16];
    int facets[12][4];
    struct region region;
    char *why;
    for (int k = 0; k < 16; k++) {
        const double half = k < 8 ? 2.0 : 1.0;
        x[k] = (struct vec3){k & 1 ? half : -half, k & 2 ? half : -half, k & 4 ? half : -half};
    }
    for (int f = 0; f < 6; f++)
        for (int c = 0; c < 4; c++) {
            facets[f][c] = outer[f][c];
            facets[6 + f][c] = 8 + outer[f][3 - c];
        }
    begin_body((struct job_body){.geometry = JOB_GEOMETRY_MESH,
                                 .n_vertices = 16,
                                 .vertices = x,
                                 .n_facets = 12,
                                 .facets = facets});
    EXPECT(inside(&region, &why));
    EXPECT_NEAR(region.volume, 56.0, 1e-12);
    EXPECT(!region_contains(&region, (struct vec3){0.0, 0.0, 0.0}, 0.0));
    EXPECT(region_contains(&region, (struct vec3){1.5, 1.5, 0.0}, 0.5));
    EXPECT(!region_contains(&region, (struct vec3){1.4, 0.0, 0.0}, 0.45));
    EXPECT(!region_contains(&region, (struct vec3){2.5, 0.0, 0.0}, 0.0));
    end_body(&region);
}

/* A curved body is what the region of the same shape is, also slantwise. */
TEST(inside_of_a_round_body)
{
    const struct vec3 from = {1, 1, 1}, to = {3, 3, 2};
    struct region region, cylinder;
    char *why;
    begin_body((struct job_body){
        .geometry = JOB_GEOMETRY_CYLINDER, .from = from, .to = to, .radius = 0.5, .caps = 3});
    EXPECT(inside(&region, &why));
    cylinder = simple((struct job_region){
        .kind = JOB_REGION_CYLINDER, .from = from, .to = to, .radius = 0.5});
    expect_volume(&region, 0.75 * PI);
    for (uint64_t k = 0; k < POINTS; k++) {
        const struct vec3 x = region_point(&cylinder, -0.1, 1, 2, k);
        const double margin = 0.2 * random_unit(3, 3, k);
        EXPECT(region_contains(&region, x, margin) == region_contains(&cylinder, x, margin));
    }
    end_body(&region);
    begin_body((struct job_body){
        .geometry = JOB_GEOMETRY_CYLINDER, .from = from, .to = to, .radius = 0.5, .caps = 1});
    EXPECT(!inside(&region, &why));
    EXPECT(strstr(why, "'shell' is not closed: it has 1 open rim;") != NULL);
    free(why);
    end_body(&region);
}

TEST(bodies_that_are_not_there)
{
    const struct job_region asked = {.kind = JOB_REGION_INSIDE, .body = body_name};
    struct region region;
    char *why;
    EXPECT(!region_build(&region, &asked, NULL, &why));
    EXPECT_STRING(why, "there is no body 'shell'; the name of a body is expected");
    free(why);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
