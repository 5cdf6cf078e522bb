/* Sections: passages each way, by number and mass; only the side of the plane counts. */
#include "run/sections.h"

#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "job/job.h"
#include "random_cloud.h"

/* Two planes: z = 1, counted downwards, and an oblique one through the origin. */
static struct job_section planes[2] = {
    {NULL, {0.0, 0.0, 1.0}, {0.0, 0.0, -1.0}},
    {NULL, {0.0, 0.0, 0.0}, {0.6, 0.8, 0.0}},
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
    return exact_sum_value(&sections.counts[section].number[backward]);
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
    EXPECT_NEAR(exact_sum_value(&sections.counts[0].mass[0]), 1.0 + 3.0 + 5.0, 1e-12);
    EXPECT_NEAR(exact_sum_value(&sections.counts[1].mass[0]), 15.0, 1e-12);
    EXPECT(exact_sum_value(&sections.counts[1].mass[1]) == 0.0);
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
