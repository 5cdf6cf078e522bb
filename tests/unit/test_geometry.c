/*
 * Round shapes: cut into facets they are closed where they should be and tend to the volume of
 * the curved ones; these are met where a search over their points finds the nearest.
 */
#include "check.h"
#include "job/job.h"
#include "model/geometry.h"
#include "model/mesh.h"
#include "physics/contact_geometry.h"

#include <math.h>
#include <stdint.h>

static const double PI = 3.14159265358979323846;

static struct job_body cylinder(int segments, int caps)
{
    return (struct job_body){.geometry = JOB_GEOMETRY_CYLINDER,
                             .from = {1.0, -2.0, 0.5},
                             .to = {1.6, -1.2, 0.5},
                             .radius = 0.7,
                             .caps = caps,
                             .segments = segments};
}

static struct job_body cone(int segments, int caps)
{
    return (struct job_body){.geometry = JOB_GEOMETRY_CONE,
                             .from = {0.0, 0.0, 0.0},
                             .to = {0.0, 0.0, 2.0},
                             .radii = {0.5, 1.5},
                             .caps = caps,
                             .segments = segments};
}

static struct job_body tube(int segments)
{
    return (struct job_body){.geometry = JOB_GEOMETRY_TUBE,
                             .from = {0.0, 0.0, 0.0},
                             .to = {0.0, 3.0, 4.0},
                             .inner = 1.0,
                             .outer = 1.5,
                             .segments = segments};
}

static struct mesh_survey survey_of(struct job_body body)
{
    struct mesh mesh;
    geometry_build_mesh(&mesh, &body);
    const struct mesh_survey survey = mesh_survey(&mesh);
    mesh_clear(&mesh);
    return survey;
}

TEST(closed_shapes_hold_the_volume_of_the_prism_they_are)
{
    const int both = JOB_CAP_FROM | JOB_CAP_TO;
    for (int n = 3; n <= 200; n = 2 * n + 1) {
        const double polygon = 0.5 * (double)n * sin(2.0 * PI / (double)n); /* of a circle's */
        const struct job_body shapes[3] = {cylinder(n, both), cone(n, both), tube(n)};
        const double volumes[3] = {0.49, 2.0 / 3.0 * (0.25 + 0.75 + 2.25), 5.0 * 1.25};
        for (int k = 0; k < 3; k++) {
            const struct mesh_survey survey = survey_of(shapes[k]);
            EXPECT(survey.closed && survey.n_turned == 0);
            EXPECT_NEAR(survey.volume, polygon * volumes[k], 1e-12 * survey.volume);
        }
    }
}

TEST(curved_shapes_hold_what_they_should)
{
    const int both = JOB_CAP_FROM | JOB_CAP_TO;
    const struct mesh_survey round[3] = {survey_of(cylinder(0, both)), survey_of(cone(0, both)),
                                         survey_of(tube(0))};
    EXPECT(round[0].closed && round[1].closed && round[2].closed);
    EXPECT_NEAR(round[0].volume, PI * 0.49, 1e-14);
    EXPECT_NEAR(round[1].volume, PI * 2.0 / 3.0 * 3.25, 1e-14);
    EXPECT_NEAR(round[2].volume, PI * 5.0 * 1.25, 1e-13);
    EXPECT_NEAR(round[0].area, 2.0 * PI * (0.7 + 0.49), 1e-14);
    EXPECT_NEAR(round[2].area, 2.0 * PI * (2.5 * 5.0 + 1.25), 1e-13);
    EXPECT(!survey_of(cylinder(0, JOB_CAP_TO)).closed);
    EXPECT(survey_of(cylinder(0, 0)).n_open == 2);
    EXPECT(survey_of(cylinder(40, 0)).n_open == 80);
    struct job_body tip = cone(0, JOB_CAP_TO);
    tip.radii[0] = 0.0;
    EXPECT(survey_of(tip).closed);
    tip.segments = 9;
    EXPECT(survey_of(tip).closed && survey_of(tip).n_turned == 0);
}

TEST(scale_comes_before_rotation_and_rotation_before_the_shift)
{
    struct job_body box = {.geometry = JOB_GEOMETRY_BOX,
                           .min = {1.0, 0.0, 0.0},
                           .max = {2.0, 1.0, 1.0},
                           .scale = 2.0,
                           .turn_axis = {0.0, 0.0, 1.0},
                           .turn_point = {1.0, 0.0, 0.0},
                           .turn_angle = PI / 2.0,
                           .move = {0.0, 0.0, 10.0}};
    const struct mesh_survey survey = survey_of(box);
    EXPECT_NEAR(survey.low.x, -1.0, 1e-15);
    EXPECT_NEAR(survey.high.x, 1.0, 1e-15);
    EXPECT_NEAR(survey.low.y, 1.0, 1e-15);
    EXPECT_NEAR(survey.high.y, 3.0, 1e-15);
    EXPECT_NEAR(survey.low.z, 10.0, 0.0);
    EXPECT_NEAR(survey.volume, 8.0, 1e-14);
    /* The curved surface goes the same way as its skin. */
    struct job_body round = cone(0, 0);
    round.scale = 0.5;
    round.turn_axis = (struct vec3){0.0, 1.0, 0.0};
    round.turn_angle = PI / 2.0;
    round.move = (struct vec3){3.0, 0.0, 0.0};
    struct mesh mesh;
    geometry_build_mesh(&mesh, &round);
    for (int v = 0; v < mesh.n_vertices - 2; v++) {
        const struct contact_geometry at = contact_geometry_closest(
            &mesh, mesh_n_features(&mesh) - mesh.n_rings - mesh.n_bands, mesh.place[v]);
        EXPECT_NEAR(at.distance, 0.0, 1e-15);
    }
    EXPECT_NEAR(mesh_survey(&mesh).low.x, 3.0, 1e-15);
    EXPECT_NEAR(mesh_survey(&mesh).high.x, 4.0, 1e-15);
    mesh_clear(&mesh);
}

TEST(vertices_within_the_tolerance_become_one)
{
    /* The two triangles of a square, which a drawing has not quite brought together. */
    struct vec3 vertices[6] = {{0, 0, 0}, {1, 0, 0},    {1, 1, 0},
                               {1, 1, 0}, {0, 1, 1e-6}, {0, 1e-6, 0}};
    int facets[2][4] = {{0, 1, 2, -1}, {3, 4, 5, -1}};
    struct job_body body = {.geometry = JOB_GEOMETRY_MESH,
                            .n_vertices = 6,
                            .vertices = vertices,
                            .n_facets = 2,
                            .facets = facets};
    EXPECT(survey_of(body).n_open == 6);
    body.merge = 1e-7;
    EXPECT(survey_of(body).n_open == 6);
    body.merge = 1e-5;
    EXPECT(survey_of(body).n_open == 4);
}

/* ---- Where curved surfaces are met
 * ------------------------------------------------------------- */

static uint64_t random_state = 1;

static double random_between(double low, double high)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * ((double)(random_state >> 11) * 0x1p-53);
}

/* The distance to all points of the bands. */
static double distance_by_search(const struct mesh *mesh, struct vec3 x)
{
    const struct vec3 arm = vec3_sub(x, mesh->origin);
    const double up = vec3_dot(arm, mesh->direction);
    const double out = vec3_norm(vec3_axpy(arm, -up, mesh->direction));
    double least = 1e300;
    for (int b = 0; b < mesh->n_bands; b++) {
        const struct mesh_ring *p = &mesh->rings[mesh->bands[b].rings[0]];
        const struct mesh_ring *q = &mesh->rings[mesh->bands[b].rings[1]];
        for (int k = 0; k <= 20000; k++) {
            const double t = (double)k / 20000.0;
            const double r = p->radius + t * (q->radius - p->radius) - out;
            const double h = p->height + t * (q->height - p->height) - up;
            least = r * r + h * h < least ? r * r + h * h : least;
        }
    }
    return sqrt(least);
}

TEST(the_nearest_point_of_a_curved_surface_is_held_by_one_of_its_features)
{
    const double radius = 1.0;
    for (int k = 0; k < 400; k++) {
        struct job_body shapes[3] = {cylinder(0, k % 4), cone(0, k % 4), tube(0)};
        struct mesh mesh;
        geometry_build_mesh(&mesh, &shapes[k % 3]);
        const struct vec3 middle = vec3_axpy(mesh.origin, 0.5, mesh.direction);
        const struct vec3 x = {middle.x + random_between(-2.0, 2.0),
                               middle.y + random_between(-2.0, 2.0),
                               middle.z + random_between(-2.0, 2.0)};
        const double nearest = distance_by_search(&mesh, x);
        double found = 1e300;
        for (int f = 0; f < mesh_n_features(&mesh); f++) {
            struct contact_geometry at;
            if (!contact_geometry_touches(&mesh, f, x, radius, &at))
                continue;
            EXPECT(contact_geometry_reaches(&mesh, f, x, radius));
            EXPECT_NEAR(vec3_norm(at.normal), 1.0, 1e-14);
            EXPECT_NEAR(vec3_norm(vec3_sub(vec3_axpy(at.point, at.distance, at.normal), x)),
                        0.0, 1e-14);
            const struct contact_geometry again = contact_geometry_closest(&mesh, f, x);
            EXPECT(again.distance == at.distance);
            found = at.distance < found ? at.distance : found;
        }
        if (nearest < radius)
            EXPECT_NEAR(found, nearest, 1e-6);
        else
            EXPECT(found > radius);
        mesh_clear(&mesh);
    }
}

/* A sphere inside a cylinder of N facets sees it nearer than the circle by no more than the
 * sagitta, which falls as the square of N. */
TEST(facets_tend_to_the_curved_surface_as_their_sagitta_does)
{
    struct job_body body = {.geometry = JOB_GEOMETRY_CYLINDER,
                            .from = {0.0, 0.0, 0.0},
                            .to = {0.0, 0.0, 1.0},
                            .radius = 1.0};
    const double radius = 0.1, out = 0.905;
    struct mesh exact;
    geometry_build_mesh(&exact, &body);
    for (int n = 64; n <= 1024; n *= 4) {
        struct mesh facets;
        double worst = 0.0;
        body.segments = n;
        geometry_build_mesh(&facets, &body);
        for (int k = 0; k < 997; k++) {
            const double angle = 2.0 * PI * (double)k / 997.0;
            const struct vec3 x = {out * cos(angle), out * sin(angle), 0.5};
            struct contact_geometry at, touched;
            double least = 1e300;
            for (int f = 0; f < mesh_n_features(&facets); f++)
                if (contact_geometry_touches(&facets, f, x, radius, &touched))
                    least = touched.distance < least ? touched.distance : least;
            EXPECT(
                contact_geometry_touches(&exact, mesh_n_features(&exact) - 3, x, radius, &at));
            EXPECT_NEAR(at.distance, 1.0 - out, 1e-15);
            EXPECT_NEAR(at.normal.x, -cos(angle), 1e-15);
            EXPECT(least <= at.distance + 1e-15);
            worst = at.distance - least > worst ? at.distance - least : worst;
        }
        const double sagitta = 1.0 - cos(PI / (double)n);
        EXPECT(worst <= sagitta * (1.0 + 1e-9) && worst >= 0.9 * sagitta);
        mesh_clear(&facets);
    }
    mesh_clear(&exact);
}

TEST(a_sphere_on_the_axis_of_a_cone_rests_on_it_all_around)
{
    struct job_body body = {.geometry = JOB_GEOMETRY_CONE,
                            .from = {0.0, 0.0, 0.0},
                            .to = {0.0, 0.0, 1.0},
                            .radii = {0.0, 1.0}};
    struct mesh mesh;
    geometry_build_mesh(&mesh, &body);
    const int band = mesh_n_features(&mesh) - mesh.n_rings - 1;
    const double radius = 0.1, height = 0.14; /* overlaps by .1 - .14 / sqrt(2) = .001 */
    struct contact_geometry at;
    EXPECT(contact_geometry_touches(&mesh, band, (struct vec3){0, 0, height}, radius, &at));
    EXPECT_NEAR(at.normal.z, 1.0, 1e-15);
    EXPECT_NEAR(at.distance, height / sqrt(2.0), 1e-15);
    double before = 0.0;
    for (int k = 1; k <= 20; k++) { /* turns from there to the wall's own, without a jump */
        const struct vec3 x = {1e-5 * (double)k, 0, height};
        EXPECT(contact_geometry_touches(&mesh, band, x, radius, &at));
        EXPECT(at.normal.x < before + 1e-15 && at.normal.x > before - 0.12);
        before = at.normal.x;
    }
    EXPECT_NEAR(before, -sqrt(0.5), 1e-15);
    mesh_clear(&mesh);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
