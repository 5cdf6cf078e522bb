/* Where spheres begin: places of a lattice, rows of a CSV file, what is said of a bad one. */
#include "model/packing.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/array.h"
#include "check.h"
#include "job/job.h"

static char ore[] = "ore", tin[] = "tin", path[300];
static struct job_material materials[2] = {{.name = ore}, {.name = tin}};
static struct job_spheres group;
static const struct job job = {
    .n_materials = 2, .materials = materials, .n_spheres = 1, .spheres = &group};

static bool same_place(struct vec3 a, double x, double y, double z)
{
    return fabs(a.x - x) < 1e-12 && fabs(a.y - y) < 1e-12 && fabs(a.z - z) < 1e-12;
}

/* -------------------------------------------------------------------------------- lattices */

static struct packing_sphere place(int64_t k)
{
    struct packing packing;
    char *why;
    EXPECT(packing_open(&packing, &job, 0, &why) && why == NULL);
    EXPECT(packing.n == group.count);
    const struct packing_sphere sphere = packing_get(&packing, k);
    packing_close(&packing);
    return sphere;
}

static void begin_lattice(double spacing, double width, double depth)
{
    group = (struct job_spheres){.material = 1,
                                 .radius = 0.1,
                                 .velocity = {1.0, 2.0, 3.0},
                                 .spin = {4.0, 5.0, 6.0},
                                 .packing = JOB_PACKING_LATTICE,
                                 .count = 8768,
                                 .spacing = spacing,
                                 .corner = {-2.64, -1.0, 6.3},
                                 .size = {width, depth}};
}

/* Rows along x, then y, then layers; 5.28 / 0.22 is 24, whatever the rounding. */
TEST(lattice_places)
{
    begin_lattice(0.22, 5.28, 2.2);
    EXPECT(same_place(place(0).position, -2.53, -0.89, 6.41));
    EXPECT(same_place(place(23).position, 2.53, -0.89, 6.41));
    EXPECT(same_place(place(24).position, -2.53, -0.67, 6.41));
    EXPECT(same_place(place(239).position, 2.53, 1.09, 6.41));
    EXPECT(same_place(place(240).position, -2.53, -0.89, 6.63));
    EXPECT(same_place(place(8767).position, -2.64 + 0.22 * 7.5, -1.0 + 0.22 * 5.5,
                      6.3 + 0.22 * 36.5));
    const struct packing_sphere sphere = place(5);
    EXPECT(sphere.radius == 0.1 && sphere.material == 1);
    EXPECT(sphere.velocity.y == 2.0 && sphere.angular_velocity.z == 6.0);
}

/* A layer that holds less than one place still holds one. */
TEST(narrow_lattices)
{
    begin_lattice(0.22, 0.21, 0.5);
    EXPECT(same_place(place(0).position, -2.53, -0.89, 6.41));
    EXPECT(same_place(place(1).position, -2.53, -0.67, 6.41));
    EXPECT(same_place(place(2).position, -2.53, -0.89, 6.63));
}

/* ------------------------------------------------------------------------------ CSV files */

static void write_file(const char *text)
{
    const char *scratch = getenv("SCRATCH");
    (void)snprintf(path, sizeof path, "%s/test_packing_%d.csv",
                   scratch != NULL ? scratch : "/tmp", (int)getpid());
    FILE *file = fopen(path, "w");
    EXPECT(file != NULL);
    if (file != NULL) {
        (void)fputs(text, file);
        (void)fclose(file);
    }
    group = (struct job_spheres){.material = 1,
                                 .radius = 0.25,
                                 .velocity = {0.0, 0.0, -7.0},
                                 .spin = {0.0, 9.0, 0.0},
                                 .packing = JOB_PACKING_CSV,
                                 .file = path};
}

/* What is said of a file with this text, with the path cut off. */
static void expect_refused(const char *text, const char *expected)
{
    struct packing packing;
    char *why;
    write_file(text);
    EXPECT(!packing_open(&packing, &job, 0, &why));
    const size_t n = strlen(path);
    EXPECT_STRING(why != NULL && strncmp(why, path, n) == 0 ? why + n : why, expected);
    EXPECT(packing.rows == NULL);
    free(why);
    (void)unlink(path);
}

TEST(all_columns_in_any_order)
{
    struct packing packing;
    char *why;
    write_file("material,radius_m,comment,z_m,y_m,x_m,vz_m_s,vx_m_s,vy_m_s\n"
               "ore,0.5,none,3,2,1,6,4,5\r\n"
               "\n"
               "tin,1e-3 ,,-3e-1,+2.5,  .5,0,0,0\n");
    EXPECT(packing_open(&packing, &job, 0, &why));
    EXPECT(packing.n == 2);
    if (packing.n == 2) {
        const struct packing_sphere a = packing_get(&packing, 0), b = packing_get(&packing, 1);
        EXPECT(a.position.x == 1.0 && a.position.y == 2.0 && a.position.z == 3.0);
        EXPECT(a.velocity.x == 4.0 && a.velocity.y == 5.0 && a.velocity.z == 6.0);
        EXPECT(a.radius == 0.5 && a.material == 0 && a.angular_velocity.y == 9.0);
        EXPECT(b.position.x == 0.5 && b.position.y == 2.5 && b.position.z == -0.3);
        EXPECT(b.radius == 1e-3 && b.material == 1 && b.velocity.z == 0.0);
    }
    packing_close(&packing);
    (void)unlink(path);
}

TEST(the_group_says_what_a_file_leaves_out)
{
    struct packing packing;
    char *why;
    write_file("x_m,y_m,z_m\n1,2,3");
    EXPECT(packing_open(&packing, &job, 0, &why));
    EXPECT(packing.n == 1);
    const struct packing_sphere sphere = packing_get(&packing, 0);
    EXPECT(sphere.radius == 0.25 && sphere.material == 1 && sphere.velocity.z == -7.0);
    packing_close(&packing);
    (void)unlink(path);
}

TEST(mistakes_with_their_places)
{
    expect_refused("x_m,y_m\n1,2\n",
                   ":1:1: the header names no places; columns x_m,y_m,z_m are "
                   "expected");
    expect_refused("x_m,y_m,z_m\n1,2,3\n1,two,3\n",
                   ":3:3: this is no number between -1e6 and 1e6; one is expected");
    expect_refused("x_m,y_m,z_m\n1.25,2,nan\n",
                   ":2:8: this is no number between -1e6 and 1e6; one is expected");
    expect_refused("x_m,y_m,z_m\n1e7,2,3\n",
                   ":2:1: this is no number between -1e6 and 1e6; one is expected");
    expect_refused("x_m,y_m,z_m\n1,,3\n",
                   ":2:3: this is no number between -1e6 and 1e6; one is expected");
    expect_refused("x_m,y_m,z_m\n1,2\n",
                   ":2:1: this row has another number of cells than the header; as many are "
                   "expected");
    expect_refused("x_m,y_m,z_m,material\n1,2,3,ore\n\n1,2,3,lead\n",
                   ":4:7: unknown material; one of the job's materials is expected");
    expect_refused("x_m,y_m,z_m,radius_m\n1,2,3,0\n",
                   ":2:1: the radius is not positive; a length above 0 is expected");
    expect_refused("x_m,y_m,z_m\n", ":1:1: there are no spheres in it; a header and at least "
                                    "one row are expected");
    expect_refused("", ":0:1: there are no spheres in it; a header and at least one row are "
                       "expected");
}

TEST(a_file_that_is_not_there)
{
    struct packing packing;
    char *why;
    write_file("");
    (void)unlink(path);
    EXPECT(!packing_open(&packing, &job, 0, &why));
    EXPECT(why != NULL && strstr(why, "cannot be read (No such file or directory)") != NULL);
    free(why);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
