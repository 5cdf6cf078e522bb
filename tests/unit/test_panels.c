/* Surfaces as panels: what is one, how wide, how curved, what holds it. */
#include "run/panels.h"

#include <math.h>

#include "check.h"
#include "job/job.h"
#include "model/geometry.h"
#include "model/mesh.h"

static struct panels panels_of(const struct job_body *body, bool rims_hold, int n_held,
                               const struct vec3 *held)
{
    struct panels panels;
    struct mesh mesh;
    geometry_build_mesh(&mesh, body);
    panels_find(&panels, &mesh, rims_hold, n_held, held);
    mesh_clear(&mesh);
    return panels;
}

/* 3 m x 2 m x 1 m without a lid: its floor is held by four folds, walls by three and, where
 * rims hold, by those: as far as half their height, or, with a free rim, all of it. */
TEST(a_box)
{
    const struct job_body box = {
        .geometry = JOB_GEOMETRY_BOX, .max = {3.0, 2.0, 1.0}, .open = JOB_SIDE_TOP};
    for (int rims = 0; rims < 2; rims++) {
        struct panels panels = panels_of(&box, rims == 1, 0, NULL);
        EXPECT(panels.n == 5);
        double area = 0.0, widest = 0.0, narrowest = 1e9;
        for (int p = 0; p < panels.n; p++) {
            area += panels.list[p].area;
            widest = fmax(widest, panels.list[p].span);
            narrowest = fmin(narrowest, panels.list[p].span);
            EXPECT(fabs(panels.list[p].curvature) < 1e-12);
            EXPECT_NEAR(vec3_norm(panels.list[p].normal), 1.0, 1e-12);
        }
        EXPECT_NEAR(area, 16.0, 1e-9);
        EXPECT_NEAR(widest, 2.0, 0.1);
        EXPECT_NEAR(narrowest, rims == 1 ? 1.0 : 2.0, 0.1);
        panels_clear(&panels);
    }
}

/* Of a round wall facets go on into each other: 1/R in the mean, and its ends hold it. */
TEST(a_pipe)
{
    const struct job_body pipe = {.geometry = JOB_GEOMETRY_CYLINDER,
                                  .to = {0.0, 0.0, 4.0},
                                  .radius = 0.5,
                                  .segments = 32};
    struct panels panels = panels_of(&pipe, true, 0, NULL);
    EXPECT(panels.n == 1);
    EXPECT_NEAR(panels.list[0].curvature, 2.0, 0.02);
    EXPECT_NEAR(panels.list[0].span, 4.0, 0.3);
    EXPECT(vec3_norm(panels.list[0].normal) < 1e-9);
    panels_clear(&panels);
}

/* A square that is held along one side stands as far out as it is long. */
TEST(what_is_held)
{
    const struct job_body square = {
        .geometry = JOB_GEOMETRY_PLANE, .normal = {0.0, 0.0, 1.0}, .extent = 2.0};
    struct vec3 held[21];
    for (int k = 0; k < 21; k++)
        held[k] = (struct vec3){-1.0, -1.0 + 0.1 * k, 0.0};
    struct panels panels = panels_of(&square, false, 21, held);
    EXPECT(panels.n == 1);
    EXPECT_NEAR(panels.list[0].span, 4.0, 0.05);
    panels_clear(&panels);
    panels = panels_of(&square, false, 0, NULL);
    EXPECT(panels.list[0].span == 0.0);
    panels_clear(&panels);
    const struct vec3 far = {2.0, 0.0, 0.0};
    EXPECT_NEAR(panels_farthest(1, &far, 21, held), 3.0, 1e-12);
    EXPECT(panels_farthest(1, &far, 0, NULL) == 0.0);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
