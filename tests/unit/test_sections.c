/* Sections: passages each way, by number and mass; only the side of the plane counts. */
#include "run/sections.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "job/job.h"
#include "random_cloud.h"

/* Two planes: z = 1, counted downwards, and an oblique one through the origin. */
static struct job_section planes[2] = {
    {.point = {0.0, 0.0, 1.0}, .normal = {0.0, 0.0, -1.0}},
    {.point = {0.0, 0.0, 0.0}, .normal = {0.6, 0.8, 0.0}},
};
static const struct job scene = {.n_sections = 2, .sections = planes};

static struct spheres spheres;
static struct sections sections;

static void begin(void)
{
    sections_init(&sections, &scene);
    spheres_init(&spheres);
}

static void end(void)
{
    sections_clear(&sections);
    spheres_clear(&spheres);
}

/* A sphere of mass id + 1 that may go 0.5 m. */
static int add(double x, double y, double z)
{
    const double place[3] = {x, y, z};
    const int i = cloud_add(&spheres, spheres.n_owned, place, 0.1);
    spheres.spin[i].lane[7] = 1.0 / (i + 1);
    spheres.allowance[i] = 0.5;
    sections_begin(&sections, &spheres, i);
    return i;
}

static void move_to(int i, double x, double y, double z)
{
    const double place[3] = {x, y, z};
    memcpy(sphere_position(&spheres, i), place, sizeof place);
    sections_pass(&sections, &spheres);
}

static double passed(int section, int backward)
{
    return exact_sum_value(&sections.counts[section].passed[backward].number[0]);
}

TEST(there_and_back)
{
    begin();
    const int i = add(0.0, -2.0, 1.2);
    EXPECT(spheres.sides[i] == 0);
    sections_search(&sections, &spheres);
    move_to(i, 0.0, -2.0, 1.1);
    EXPECT(passed(0, 0) == 0.0);
    move_to(i, 0.0, -2.0, 0.9);
    EXPECT(passed(0, 0) == 1.0 && passed(0, 1) == 0.0 && spheres.sides[i] == 1);
    move_to(i, 0.0, -2.0, 0.8);
    EXPECT(passed(0, 0) == 1.0);
    move_to(i, 0.0, -2.0, 1.3);
    EXPECT(passed(0, 0) == 1.0 && passed(0, 1) == 1.0 && spheres.sides[i] == 0);
    move_to(i, 0.0, -2.0, 0.99);
    EXPECT(passed(0, 0) == 2.0 && passed(0, 1) == 1.0);
    EXPECT(passed(1, 0) == 0.0 && passed(1, 1) == 0.0);
    end();
}

TEST(the_plane_itself_is_not_forward)
{
    begin();
    const int i = add(0.0, -2.0, 1.0);
    EXPECT(spheres.sides[i] == 0);
    sections_search(&sections, &spheres);
    move_to(i, 0.0, -2.0, 1.0);
    EXPECT(passed(0, 0) == 0.0);
    move_to(i, 0.0, -2.0, 0.875);
    EXPECT(passed(0, 0) == 1.0);
    move_to(i, 0.0, -2.0, 1.0);
    EXPECT(passed(0, 1) == 1.0 && spheres.sides[i] == 0);
    end();
}

TEST(masses_and_several_planes)
{
    begin();
    for (int i = 0; i < 5; i++)
        add(-0.01, -0.01, 1.01);
    sections_search(&sections, &spheres);
    EXPECT(sections.n_near == 10);
    for (int i = 0; i < 5; i++) {
        double *x = sphere_position(&spheres, i);
        x[0] = 0.02;
        x[2] = i % 2 == 0 ? 0.99 : 1.02;
    }
    sections_pass(&sections, &spheres);
    EXPECT(passed(0, 0) == 3.0 && passed(1, 0) == 5.0);
    EXPECT_NEAR(exact_sum_value(&sections.counts[0].passed[0].mass[0]), 1.0 + 3.0 + 5.0, 1e-12);
    EXPECT_NEAR(exact_sum_value(&sections.counts[1].passed[0].mass[0]), 15.0, 1e-12);
    EXPECT(exact_sum_value(&sections.counts[1].passed[1].mass[0]) == 0.0);
    EXPECT(spheres.sides[0] == 3 && spheres.sides[1] == 2);
    end();
}

/* Who cannot get there before the next search is not looked at, which changes no count. */
TEST(a_search_changes_no_count)
{
    double numbers[2][2];
    for (int often = 0; often < 2; often++) {
        struct cloud_random dice = {3};
        begin();
        for (int i = 0; i < 40; i++)
            add(cloud_between(&dice, -2.0, 2.0), cloud_between(&dice, -2.0, 2.0),
                cloud_between(&dice, -1.0, 3.0));
        for (int n = 0; n < 300; n++) {
            if (often != 0 || n % 10 == 0) /* ten steps of 0.05 m are 0.5 m */
                sections_search(&sections, &spheres);
            for (int i = 0; i < 40; i++) {
                for (int k = 0; k < 3; k++)
                    sphere_position(&spheres, i)[k] += cloud_between(&dice, -0.028, 0.028);
            }
            sections_pass(&sections, &spheres);
        }
        for (int s = 0; s < 2; s++) {
            const double there = passed(s, 0), back = passed(s, 1);
            if (often != 0)
                EXPECT(there == numbers[s][0] && back == numbers[s][1]);
            numbers[s][0] = there;
            numbers[s][1] = back;
            EXPECT(there + back > 20.0);
        }
        end();
    }
}

/* Straight flights through parts of the plane z = 0: with a velocity that is the flight itself,
 * the place of the passage is where the line meets the plane. */
static struct job_section parts[3] = {
    {.kind = JOB_SECTION_DISC,
     .point = {0.5, 0.0, 0.0},
     .normal = {0.0, 0.0, 1.0},
     .radius = 0.2},
    {.kind = JOB_SECTION_RECTANGLE,
     .point = {0.5, 0.0, 0.0},
     .normal = {0.0, 0.0, 1.0},
     .across = {0.6, 0.0, 0.8}, /* leans: its part in the plane counts */
     .size = {0.6, 0.1}},
    {.kind = JOB_SECTION_PLANE, .normal = {0.0, 0.0, 1.0}},
};
static const struct job part_scene = {.n_sections = 3, .sections = parts};

/* Flies from (x, y, 0) - share * v to where v takes it from there. */
static void fly_through(double x, double y, const double v[3], double share)
{
    const double place[3] = {x - share * v[0], y - share * v[1], -share * v[2]};
    const int i = cloud_add(&spheres, spheres.n_owned, place, 0.1);
    spheres.spin[i].lane[7] = 1.0;
    spheres.allowance[i] = 2.0;
    sections_begin(&sections, &spheres, i);
    sections_search(&sections, &spheres);
    for (int k = 0; k < 3; k++) {
        sphere_position(&spheres, i)[k] += v[k];
        sphere_velocity(&spheres, i)[k] = v[k];
    }
    sections_pass(&sections, &spheres);
}

TEST(discs_and_rectangles_count_what_passes_within)
{
    struct cloud_random dice = {7};
    double n[3][2] = {{0.0}};
    sections_init(&sections, &part_scene);
    spheres_init(&spheres);
    for (int k = 0; k < 400; k++) {
        const double x = cloud_between(&dice, 0.0, 1.0), y = cloud_between(&dice, -0.4, 0.4);
        const double v[3] = {cloud_between(&dice, -1.0, 1.0), cloud_between(&dice, -1.0, 1.0),
                             cloud_between(&dice, -1.0, 1.0)};
        const int back = v[2] < 0.0;
        n[0][back] += hypot(x - 0.5, y) <= 0.2;
        n[1][back] += fabs(x - 0.5) <= 0.3 && fabs(y) <= 0.05;
        n[2][back] += 1.0;
        fly_through(x, y, v, cloud_between(&dice, 0.01, 0.99));
    }
    for (int s = 0; s < 3; s++) {
        EXPECT(passed(s, 0) == n[s][0] && passed(s, 1) == n[s][1]);
        EXPECT(n[s][0] > 5.0 && n[s][1] > 5.0);
    }
    end();
}

/* Who was beside the disc when it went through the plane is on the other side all the same. */
TEST(sides_are_those_of_the_plane)
{
    const double down[3] = {0.0, 0.0, -1.0};
    sections_init(&sections, &part_scene);
    spheres_init(&spheres);
    fly_through(5.0, 0.0, down, 0.5);
    EXPECT(spheres.sides[0] == 0 && passed(0, 1) == 0.0 && passed(2, 1) == 1.0);
    end();
}

/* A step that rounding, not the velocity, brings across counts where it is. */
TEST(passages_without_a_speed)
{
    const double still[3] = {0.0, 0.0, 0.0};
    sections_init(&sections, &part_scene);
    spheres_init(&spheres);
    fly_through(0.5, 0.0, still, 0.0);
    sphere_position(&spheres, 0)[2] = 1e-300;
    sections_pass(&sections, &spheres);
    EXPECT(passed(0, 0) == 1.0);
    end();
}

TEST(materials_and_size_classes)
{
    double bounds[2] = {0.05, 0.1};
    struct job_material materials[2] = {{.name = (char[]){"ore"}},
                                        {.name = (char[]){"rubber"}}};
    struct job_section plane = {.normal = {0.0, 0.0, 1.0},
                                .by = JOB_SPLIT_MATERIAL | JOB_SPLIT_SIZE,
                                .n_classes = 2,
                                .classes = bounds};
    const struct job job = {
        .n_materials = 2, .materials = materials, .n_sections = 1, .sections = &plane};
    const double radii[4] = {0.03, 0.05, 0.0999, 0.1};
    sections_init(&sections, &job);
    spheres_init(&spheres);
    for (int i = 0; i < 4; i++) {
        const double place[3] = {0.0, 0.0, -0.1};
        cloud_add(&spheres, i, place, radii[i]);
        spheres.spin[i].lane[7] = 1.0 / (i + 1);
        spheres.material[i] = i == 0;
        spheres.allowance[i] = 1.0;
        sections_begin(&sections, &spheres, i);
    }
    sections_search(&sections, &spheres);
    for (int i = 0; i < 4; i++)
        sphere_position(&spheres, i)[2] = 0.1;
    sections_pass(&sections, &spheres);
    const struct tally *tally = &sections.counts[0].passed[0];
    const double numbers[6] = {4.0, 3.0, 1.0, 1.0, 2.0, 1.0},
                 masses[6] = {10.0, 9.0, 1.0, 1.0, 5.0, 4.0};
    static const char *const names[6] = {"",        "material_ore", "material_rubber",
                                         "class_1", "class_2",      "class_3"};
    EXPECT(tally->n_parts == 6);
    for (int part = 0; part < 6; part++) {
        char name[TALLY_PART_SIZE];
        EXPECT(exact_sum_value(&tally->number[part]) == numbers[part]);
        EXPECT(exact_sum_value(&tally->mass[part]) == masses[part]);
        EXPECT(strcmp(tally_part(&tally->split, &job, part, name), names[part]) == 0);
    }
    end();
}

/* Round a periodic direction: each passage counts once, the boundary and the place half way
 * round count nothing, wherever the plane is. */
TEST(round_and_round)
{
    const struct job space = {.domain = {true, {-3.0, -3.0, -3.0}, {3.0, 3.0, 3.0}, 4, 0}};
    const double heights[] = {1.0, 3.0, -2.9, 0.0};
    for (int h = 0; h < 4; h++) {
        struct job_section plane = {.point = {0.0, 0.0, heights[h]},
                                    .normal = {0.0, 0.0, -1.0}};
        const struct job one = {.n_sections = 1, .sections = &plane};
        sections_init(&sections, &one);
        spheres_init(&spheres);
        periodic_init(&spheres.periodic, &space);
        const int up = add(0.0, 0.0, -2.0), down = add(1.0, 0.0, 2.0);
        for (int n = 1; n <= 180; n++) { /* three times round in steps of 0.1 m */
            if (n % 4 == 0)
                sections_search(&sections, &spheres);
            move_to(up, 0.0, 0.0, -2.0 + 0.1 * n);
            move_to(down, 1.0, 0.0, 2.0 - 0.05 * n);
        }
        EXPECT(passed(0, 1) == 3.0);
        const double crossed =
            floor((2.0 - heights[h]) / 6.0) - floor((-7.0 - heights[h]) / 6.0);
        EXPECT(passed(0, 0) == crossed);
        end();
    }
}

/* A disc over the boundary of the direction across it counts on both sides. */
TEST(a_disc_over_the_boundary)
{
    const struct job space = {.domain = {true, {0.0, 0.0, -1.0}, {4.0, 4.0, 1.0}, 3, 0}};
    struct job_section disc = {.kind = JOB_SECTION_DISC,
                               .point = {3.9, 0.1, 0.0},
                               .normal = {0.0, 0.0, 1.0},
                               .radius = 0.5};
    const struct job one = {.n_sections = 1, .sections = &disc};
    const double down[3] = {0.0, 0.0, -0.5};
    sections_init(&sections, &one);
    spheres_init(&spheres);
    periodic_init(&spheres.periodic, &space);
    fly_through(3.8, 0.2, down, 0.5);
    fly_through(0.3, 0.2, down, 0.5);
    fly_through(4.1, -0.3, down, 0.5); /* in memory beyond the boundary */
    fly_through(3.8, 3.9, down, 0.5);
    fly_through(0.5, 0.2, down, 0.5);
    EXPECT(passed(0, 1) == 4.0);
    end();
}

TEST(no_sections_no_work)
{
    const struct job none = {.n_sections = 0};
    sections_init(&sections, &none);
    spheres_init(&spheres);
    add(0.0, 0.0, 1.0);
    sections_search(&sections, &spheres);
    sections_pass(&sections, &spheres);
    EXPECT(sections.n_near == 0 && spheres.sides[0] == 0);
    end();
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
