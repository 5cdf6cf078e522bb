/* Random packings: how many, of which sizes, where, and what is said when there is no room. */
#include "model/packings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/report.h"
#include "check.h"
#include "job/job.h"
#include "model/body.h"

static char ore[] = "ore", fill_name[] = "fill", more_name[] = "more", path[] = "job.yaml";
static struct job_material materials[1] = {{.name = ore, .density = 2000.0}};
static struct job_spheres groups[2];
static struct job_body body;
static struct job job;
static struct packings packings;
static struct mistakes mistakes;

static void begin(int n_groups)
{
    job = (struct job){.path = path,
                       .seed = 3,
                       .n_materials = 1,
                       .materials = materials,
                       .n_spheres = n_groups,
                       .spheres = groups};
    for (int g = 0; g < 2; g++)
        groups[g] = (struct job_spheres){
            .name = g == 0 ? fill_name : more_name,
            .radius = 0.05,
            .packing = JOB_PACKING_RANDOM,
            .region = {.given = true, .kind = JOB_REGION_BOX, .max = {1.0, 1.0, 1.0}},
            .attempts = 10000,
            .avoid_bodies = true};
}

static bool open_all(void)
{
    struct bodies bodies;
    const struct packing nothing = {.n = 0};
    mistakes_init(&mistakes);
    bodies_build(&bodies, &job);
    const bool fine = packings_open(&packings, &job, &bodies, &nothing, NULL, &mistakes);
    bodies_clear(&bodies);
    return fine;
}

static void close_all(void)
{
    mistakes_clear(&mistakes);
    packings_close(&packings);
}

/* The least distance between surfaces, of all groups, across periodic boundaries too [m]. */
static double least_gap(void)
{
    double least = HUGE_VAL;
    for (int g = 0; g < packings.n; g++)
        for (int64_t k = 0; k < packings.groups[g].n; k++)
            for (int h = 0; h <= g; h++)
                for (int64_t l = 0; l < (h < g ? packings.groups[h].n : k); l++) {
                    const struct packing_sphere a = packing_get(&packings.groups[g], k);
                    const struct packing_sphere b = packing_get(&packings.groups[h], l);
                    struct vec3 d = vec3_sub(a.position, b.position);
                    if ((job.domain.periodic & JOB_DIRECTION_X) != 0)
                        d.x -= rint(d.x);
                    if ((job.domain.periodic & JOB_DIRECTION_Y) != 0)
                        d.y -= rint(d.y);
                    least = fmin(least, vec3_norm(d) - a.radius - b.radius);
                }
    return least;
}

static bool is_within(struct packing_sphere s, double low, double high)
{
    const double x[3] = {s.position.x, s.position.y, s.position.z};
    for (int c = 0; c < 3; c++)
        if (x[c] - s.radius < low - 1e-12 || x[c] + s.radius > high + 1e-12)
            return false;
    return true;
}

static double volume(const struct packing *packing)
{
    double sum = 0.0;
    for (int64_t k = 0; k < packing->n; k++)
        sum += 4.0 / 3.0 * acos(-1.0) * pow(packing->rows[k].radius, 3);
    return sum;
}

TEST(a_share_of_the_volume)
{
    begin(1);
    groups[0].fraction = 0.25;
    EXPECT(open_all());
    EXPECT(packings.groups[0].n == 477); /* 0.25 over 4/3 pi 0.05^3 is 477.46 */
    EXPECT(least_gap() >= -1e-15);
    for (int64_t k = 0; k < packings.groups[0].n; k++)
        EXPECT(is_within(packings.groups[0].rows[k], 0.0, 1.0));
    close_all();
}

TEST(a_mass_and_a_gap)
{
    begin(1);
    groups[0].mass = 200.0;
    groups[0].gap = 0.01;
    EXPECT(open_all());
    EXPECT_NEAR(2000.0 * volume(&packings.groups[0]), 200.0,
                0.5 * 2000.0 * 4.0 / 3.0 * acos(-1.0) * 1.25e-4);
    EXPECT(least_gap() >= 0.01 - 1e-15);
    close_all();
}

/* Sizes are those asked for, though small ones find room more easily: Kolmogorov and Smirnov
 * as in test_sizes.  Ten to one. */
static int compare(const void *a, const void *b)
{
    const struct packing_sphere *p = a, *q = b;
    return (p->radius > q->radius) - (p->radius < q->radius);
}

TEST(sizes_as_asked_for_and_no_overlap)
{
    struct sizes sizes;
    double worst = 0.0;
    begin(1);
    groups[0].sizes =
        (struct job_sizes){.given = true, .kind = JOB_SIZES_UNIFORM, .min = 0.006, .max = 0.06};
    groups[0].fraction = 0.35;
    EXPECT(open_all());
    struct packing *packing = &packings.groups[0];
    EXPECT_NEAR(volume(packing), 0.35, 0.00046); /* half of the largest */
    EXPECT(least_gap() >= -1e-15);
    sizes_build(&sizes, &groups[0].sizes, 0.0);
    qsort(packing->rows, (size_t)packing->n, sizeof *packing->rows, compare);
    const double n = (double)packing->n;
    for (int64_t k = 0; k < packing->n; k++) {
        const double f = sizes_share_below(&sizes, packing->rows[k].radius);
        worst = fmax(worst, fmax(f - (double)k / n, (double)(k + 1) / n - f));
    }
    EXPECT(n > 1000.0);
    EXPECT(worst * sqrt(n) < 1.95);
    sizes_clear(&sizes);
    close_all();
}

/* Places are even: chi-square of 27 cells of centres (26 degrees of freedom, 54.05 once in
 * 1000) for a packing so thin that spheres hardly know of each other. */
TEST(places_are_even)
{
    int counts[27] = {0};
    double square = 0.0;
    begin(1);
    groups[0].radius = 0.002;
    groups[0].count = 5400;
    EXPECT(open_all());
    for (int64_t k = 0; k < 5400; k++) {
        const struct vec3 x = packings.groups[0].rows[k].position;
        counts[(int)(3.0 * x.x) + 3 * (int)(3.0 * x.y) + 9 * (int)(3.0 * x.z)]++;
    }
    for (int c = 0; c < 27; c++)
        square += (counts[c] - 200.0) * (counts[c] - 200.0) / 200.0;
    EXPECT(square < 54.05);
    close_all();
}

TEST(clear_of_other_groups_and_of_bodies)
{
    begin(2);
    groups[0].packing = JOB_PACKING_LATTICE;
    groups[0].count = 100;
    groups[0].spacing = 0.11;
    groups[0].size[0] = groups[0].size[1] = 1.0;
    groups[1].count = 150;
    groups[1].radius = 0.03;
    body = (struct job_body){.name = fill_name,
                             .geometry = JOB_GEOMETRY_CYLINDER,
                             .from = {0.5, 0.5, 0.2},
                             .to = {0.5, 0.5, 0.9},
                             .radius = 0.3};
    job.n_bodies = 1;
    job.bodies = &body;
    EXPECT(open_all());
    EXPECT(least_gap() >= -1e-15);
    for (int64_t k = 0; k < 150; k++) {
        const struct vec3 x = packings.groups[1].rows[k].position;
        const double r = sqrt((x.x - 0.5) * (x.x - 0.5) + (x.y - 0.5) * (x.y - 0.5));
        EXPECT(fabs(r - 0.3) >= 0.03 - 1e-12 || x.z < 0.2 || x.z > 0.9);
    }
    close_all();
}

TEST(across_periodic_boundaries)
{
    begin(1);
    groups[0].fraction = 0.22;
    groups[0].region.min.x = -0.05;
    groups[0].region.max.x = 1.05;
    job.domain.given = true;
    job.domain.periodic = 1;
    job.domain.max = (struct vec3){1.0, 1.0, 1.0};
    EXPECT(open_all());
    EXPECT(least_gap() >= -1e-12);
    close_all();
}

/* A region that spans the period has no walls there: within a radius of the boundary there are
 * as many centres as within a radius of the middle, up to four deviations of what counts differ
 * by that know nothing of each other (they differ by less), and the pair across the boundary
 * keeps its distance. */
TEST(as_dense_at_a_periodic_boundary_as_elsewhere)
{
    for (int kind = 0; kind < 2; kind++) {
        int n_edge = 0, n_middle = 0;
        begin(1);
        groups[0].radius = 0.02;
        groups[0].fraction = kind == 0 ? 0.33 : 0.3;
        if (kind == 1)
            groups[0].region = (struct job_region){.given = true,
                                                   .kind = JOB_REGION_CYLINDER,
                                                   .from = {-0.2, 0.5, 0.5},
                                                   .to = {1.2, 0.5, 0.5},
                                                   .radius = 0.4};
        job.domain.given = true;
        job.domain.periodic = JOB_DIRECTION_X | (kind == 0 ? JOB_DIRECTION_Y : 0);
        job.domain.max = (struct vec3){1.0, 1.0, 1.0};
        EXPECT(open_all());
        EXPECT(least_gap() >= -1e-12);
        const double asked = kind == 0 ? 0.33 : 0.3 * 0.16 * acos(-1.0);
        EXPECT_NEAR(volume(&packings.groups[0]), asked, 2e-5);
        for (int64_t k = 0; k < packings.groups[0].n; k++) {
            const double x = packings.groups[0].rows[k].position.x;
            EXPECT(x >= 0.0 && x < 1.0);
            n_edge += x < 0.02 || x > 0.98;
            n_middle += fabs(x - 0.5) < 0.02;
        }
        EXPECT(n_edge > 100);
        EXPECT_NEAR((double)n_edge, (double)n_middle, 4.0 * sqrt(n_edge + n_middle));
        close_all();
    }
}

/* A filling that straddles a boundary, but not all of space: what is left of the period stays
 * free. */
TEST(a_region_across_a_periodic_boundary)
{
    int n_left = 0, n_right = 0;
    begin(1);
    groups[0].fraction = 0.34;
    groups[0].radius = 0.03;
    groups[0].region.min.x = 0.6;
    groups[0].region.max.x = 1.4;
    job.domain.given = true;
    job.domain.periodic = JOB_DIRECTION_X;
    job.domain.max = (struct vec3){1.0, 1.0, 1.0};
    EXPECT(open_all());
    EXPECT(least_gap() >= -1e-12);
    for (int64_t k = 0; k < packings.groups[0].n; k++) {
        const double x = packings.groups[0].rows[k].position.x;
        EXPECT((x >= 0.0 && x <= 0.37 + 1e-12) || (x >= 0.63 - 1e-12 && x < 1.0));
        n_left += x < 0.37;
        n_right += x > 0.63;
    }
    EXPECT(n_left > 900 && n_right > 900);
    close_all();
}

/* Spheres of one size added until there is no room, where there are no walls: 0.38413 of the
 * volume (G. Zhang and S. Torquato, Phys. Rev. E 88, 053312, 2013).  Of 3400 spheres the
 * density scatters by some 0.001. */
TEST(saturated_without_walls)
{
    double reached = 0.0;
    begin(1);
    groups[0].radius = 0.03;
    groups[0].fraction = 0.5;
    job.domain.given = true;
    job.domain.periodic = JOB_DIRECTION_X | JOB_DIRECTION_Y | JOB_DIRECTION_Z;
    job.domain.max = (struct vec3){1.0, 1.0, 1.0};
    EXPECT(!open_all());
    const char *text = strstr(mistakes.list[0].text, "and reached ");
    EXPECT(strstr(mistakes.list[0].text, "no room is left for the next") != NULL);
    EXPECT(text != NULL && sscanf(text, "and reached %lf", &reached) == 1);
    EXPECT_NEAR(reached, 38.413, 0.4);
    mistakes_clear(&mistakes);
}

/* A closed body in the region is solid: none touches it, none is inside.  One that comes later
 * is not there yet; one that most of the region is inside of is a container. */
TEST(none_inside_a_solid_body)
{
    static const double RADIUS = 0.3;
    begin(1);
    groups[0].radius = 0.02;
    groups[0].fraction = 0.2;
    body = (struct job_body){.name = fill_name,
                             .geometry = JOB_GEOMETRY_CYLINDER,
                             .from = {0.5, 0.5, 0.1},
                             .to = {0.5, 0.5, 0.9},
                             .radius = RADIUS,
                             .caps = JOB_CAP_FROM | JOB_CAP_TO};
    job.n_bodies = 1;
    job.bodies = &body;
    for (int kind = 0; kind < 4; kind++) {
        int n_inside = 0, n_touching = 0;
        body.segments = kind == 1 ? 24 : 0;
        body.comes_and_goes = kind == 2;
        body.active[0] = 0.5;
        body.active[1] = 1.0;
        if (kind == 3)
            groups[0].region = (struct job_region){.given = true,
                                                   .kind = JOB_REGION_BOX,
                                                   .min = {0.25, 0.25, 0.1},
                                                   .max = {0.75, 0.75, 0.9}};
        EXPECT(open_all());
        EXPECT(least_gap() >= -1e-15);
        for (int64_t k = 0; k < packings.groups[0].n; k++) {
            const struct vec3 x = packings.groups[0].rows[k].position;
            const double r = sqrt((x.x - 0.5) * (x.x - 0.5) + (x.y - 0.5) * (x.y - 0.5));
            const double aside = r - RADIUS * (kind == 1 ? cos(acos(-1.0) / 24.0) : 1.0);
            const double above = fabs(x.z - 0.5) - 0.4;
            n_inside += aside < 0.0 && above < 0.0;
            n_touching += aside < 0.02 - 1e-12 && above < 0.02 - 1e-12 &&
                          (aside < 0.0 || above < 0.0) && (aside > -0.02 || above > -0.02);
        }
        EXPECT(kind >= 2 ? n_inside > 100 : n_inside == 0);
        EXPECT(kind == 2 ? n_touching > 100 : kind == 3 || n_touching == 0);
        close_all();
    }
}

TEST(the_same_for_the_same_seed)
{
    struct vec3 first;
    begin(1);
    groups[0].count = 20;
    EXPECT(open_all());
    first = packings.groups[0].rows[19].position;
    close_all();
    EXPECT(open_all());
    EXPECT(packings.groups[0].rows[19].position.x == first.x);
    close_all();
    job.seed = 4;
    EXPECT(open_all());
    EXPECT(packings.groups[0].rows[19].position.x != first.x);
    close_all();
}

TEST(no_room)
{
    begin(1);
    groups[0].fraction = 0.55;
    EXPECT(!open_all());
    EXPECT(
        mistakes.n == 1 &&
        strstr(mistakes.list[0].text,
               "spheres 'fill': random addition was asked for 55 % of the region's volume "
               "(1050 spheres) and reached 34.7 % (663): no room is left for the next; less, "
               "a lattice, or letting them settle is expected") != NULL);
    mistakes_clear(&mistakes);
    groups[0].fraction = 0.0;
    groups[0].count = 1;
    groups[0].radius = 0.6;
    EXPECT(!open_all());
    EXPECT(strstr(mistakes.list[0].text, "(1 spheres) and reached 0 % (0)") != NULL);
    mistakes_clear(&mistakes);
}

/* Hexagonal close packing: nothing overlaps, inner spheres touch twelve others. */
TEST(hexagonal_lattices)
{
    int most = 0;
    begin(1);
    groups[0].packing = JOB_PACKING_HEXAGONAL;
    groups[0].count = 400;
    groups[0].spacing = 0.1;
    groups[0].size[0] = groups[0].size[1] = 1.0;
    EXPECT(open_all());
    EXPECT(least_gap() >= -1e-12);
    for (int64_t k = 0; k < 400; k++) {
        const struct packing_sphere a = packing_get(&packings.groups[0], k);
        int n = 0;
        for (int64_t l = 0; l < 400; l++) {
            const struct packing_sphere b = packing_get(&packings.groups[0], l);
            n += l != k && vec3_norm(vec3_sub(a.position, b.position)) < 0.1 + 1e-9;
        }
        most = n > most ? n : most;
        EXPECT(a.position.x > 0.05 - 1e-12 && a.position.x < 0.95 + 1e-12);
        EXPECT(a.position.y > 0.05 - 1e-12 && a.position.y < 0.95 + 1e-12);
    }
    EXPECT(most == 12);
    close_all();
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
