/*
 * A plane made of many quads and triangles is a plane: a ball that rolls over it, face to edge
 * to vertex, feels the same force and goes on as on one facet, whether the mesh stands or
 * moves. On one that turns about an upright axis at W it goes round in a circle at 2/7 W. And
 * corners: one contact for each wall of a concave one, one on a convex edge or at a tip.
 *
 * The ball rests on the mesh from the start and rolls at once, so that nothing but the seams
 * could change anything.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/array.h"
#include "impact.h"
#include "run/simulation.h"
#include "verify.h"

enum { CELLS = 16 };

static const struct impact_solid stone = {1e8, 0.25, 2500.0}; /* as below */
static const double RADIUS = 0.01, G = 9.81, STEP = 1e-5, CELL = 0.013;

/* The mesh's geometry: a chessboard of quads and pairs of triangles, the origin at a vertex. */
static char *mesh(void)
{
    char *text = array_string("{kind: mesh, vertices: [");
    for (int k = 0; k < (CELLS + 1) * (CELLS + 1); k++) {
        const int x = k % (CELLS + 1) - CELLS / 2, y = k / (CELLS + 1) - CELLS / 2;
        char *more =
            array_format("%s%s[%.17g, %.17g, 0]", text, k > 0 ? ", " : "", CELL * x, CELL * y);
        free(text);
        text = more;
    }
    char *more = array_format("%s], facets: [", text);
    free(text);
    text = more;
    for (int k = 0; k < CELLS * CELLS; k++) {
        const int x = k % CELLS, y = k / CELLS, a = y * (CELLS + 1) + x, b = a + 1,
                  c = b + CELLS + 1, d = a + CELLS + 1;
        const char *comma = k > 0 ? ", " : "";
        more = (x + y) % 2 == 0 ? array_format("%s%s[%d, %d, %d, %d]", text, comma, a, b, c, d)
                                : array_format("%s%s[%d, %d, %d], [%d, %d, %d]", text, comma, a,
                                               b, c, a, c, d);
        free(text);
        text = more;
    }
    more = array_format("%s]}", text);
    free(text);
    return more;
}

static const char MATERIALS[] =
    "domain: {leavers: ignore}\n"
    "materials:\n  stone: {density: 2500, young: 1.0e+8, poisson: 0.25}\n"
    "contact:\n  pairs:\n    - {between: [stone, stone], friction: 0.5, restitution: 0.5%s}\n";

struct law {
    const char *more; /* keys of the pair */
    double stiffness; /* of the linear law [N/m]; 0: Hertz */
};
static const struct law hertz = {"", 0.0}, linear = {", law: linear, stiffness: 1.0e+5", 1e5};

/* Overlap at which the contact carries this force. (1.5) */
static double overlap_under(const struct law *law, double force)
{
    if (law->stiffness > 0.0)
        return force / law->stiffness;
    const double modulus = impact_modulus(&stone, &stone);
    return pow(0.75 * force / (modulus * sqrt(RADIUS)), 2.0 / 3.0);
}

/* What a ball feels that rolls, as largest over some steps. */
struct felt {
    double push;  /* change of the normal force over the weight [-] */
    double grip;  /* change of the acceleration along the plane over the expected one [-] */
    int contacts; /* at once, that number which is farthest from one */
};

/* n steps of a ball whose weight and whose acceleration along the plane, which may fade, are
 * known. */
static struct felt feel(struct simulation *sim, int n, double weight, double pull,
                        double fading)
{
    struct felt felt = {0.0, 0.0, 1};
    struct vec3 before = verify_velocity(sim, 0);
    for (int k = 0; k < n; k++) {
        verify_steps(sim, 1);
        const struct vec3 now = verify_velocity(sim, 0),
                          gained = vec3_scale(1.0 / STEP, vec3_sub(now, before));
        const double along = sqrt(gained.x * gained.x + gained.y * gained.y);
        felt.push = fmax(felt.push, fabs(gained.z) / weight);
        felt.grip = fmax(felt.grip, fabs(along / (pull * exp(-fading * k * STEP)) - 1.0));
        before = now;
        const int touching = (int)verify_series(sim, "n_facet_contacts");
        if (abs(touching - 1) > abs(felt.contacts - 1))
            felt.contacts = touching;
    }
    return felt;
}

static void compare_felt(const char *name, const struct felt *felt)
{
    char row[128];
    snprintf(row, sizeof row, "%s: normal force over the weight, largest change", name);
    verify_row(row, "", 0.0, felt->push, 1e-6, VERIFY_AT_MOST, "asked for");
    snprintf(row, sizeof row, "%s: acceleration along the plane, largest change of any step",
             name);
    verify_row(row, "", 0.0, felt->grip, 1e-6, VERIFY_AT_MOST, "asked for of the normal force");
    snprintf(row, sizeof row, "%s: contacts, fewest and most of all steps", name);
    verify_row(row, "", 1.0, felt->contacts, 0.0, VERIFY_ABSOLUTE, "a number");
}

/* Rolls from `start` along `along` (a unit vector), down a slope of 5 degrees that way. */
static void roll(const char *name, const struct law *law, struct vec3 start, struct vec3 along,
                 struct vec3 mesh_moves)
{
    const double angle = 5.0 * M_PI / 180.0, speed = 0.3;
    const double weight = impact_mass(&stone, RADIUS) * G * cos(angle);
    const struct vec3 place = {start.x, start.y, RADIUS - overlap_under(law, weight)};
    const struct vec3 velocity = vec3_axpy(mesh_moves, speed, along);
    const struct vec3 spin = vec3_scale(speed / RADIUS, (struct vec3){-along.y, along.x, 0.0});
    char *ball = verify_sphere("ball", "stone", RADIUS, place, velocity, spin);
    char *surface = mesh(), *materials = array_format(MATERIALS, law->more);
    struct simulation *sim =
        verify_scene(STEP,
                     "%sgravity: [%.17g, %.17g, %.17g]\noutput: {series: {every: 1.0e-5}}\n"
                     "spheres:\n%sbodies:\n  - {name: floor, material: stone, geometry: %s, "
                     "motion: {velocity: [%.17g, %.17g, 0]}}\n",
                     materials, G * sin(angle) * along.x, G * sin(angle) * along.y,
                     -G * cos(angle), ball, surface, mesh_moves.x, mesh_moves.y);
    free(ball);
    free(surface);
    free(materials);
    /* The tangential force of rolling down builds up and swings for a while. */
    verify_steps(sim, 5000);
    const double begun = vec3_dot(verify_velocity(sim, 0), along);
    const int n = 20000; /* 0.2 s: some ten centimetres */
    const double pull = 5.0 / 7.0 * G * sin(angle);
    const struct felt felt = feel(sim, n, G * cos(angle), pull, 0.0);
    compare_felt(name, &felt);
    const double gained = vec3_dot(verify_velocity(sim, 0), along) - begun;
    char row[128];
    snprintf(row, sizeof row, "%s: mean acceleration", name);
    verify_row(row, "m/s2", pull, gained / (n * STEP), 1e-9, VERIFY_RELATIVE,
               "uniform, so exact but for rounding");
    verify_scene_free(sim);
}

/* A ball on a table that turns at `rate` about the z axis goes round at w = 2/7 of it, at
 * whatever speed and radius.  It starts in rolling.  Two things are known to be off: the spring
 * that turns with the path yields, by (w/w_s)^2 where w_s = sqrt(7/2 k_t/m) is its own swing;
 * and the table's speed is that of half a step before at the place of the step, which takes
 * w^2 dt/2 of the speed in a time. */
static void turntable(double rate)
{
    const double speed = 0.12, turning = 2.0 / 7.0 * rate, x = 0.07, y = 0.013;
    const double weight = impact_mass(&stone, RADIUS) * G;
    const struct vec3 place = {x, y, RADIUS - overlap_under(&hertz, weight)},
                      velocity = {0.0, speed, 0.0},
                      spin = {(rate * x - speed) / RADIUS, rate * y / RADIUS, 0.0};
    const double shear = stone.young / (4.0 * (2.0 - stone.poisson) * (1.0 + stone.poisson));
    const double k_t = 8.0 * shear * sqrt(RADIUS * overlap_under(&hertz, weight)),
                 yields = turning * turning * impact_mass(&stone, RADIUS) / (3.5 * k_t),
                 fading = 0.5 * turning * turning * STEP;
    char *ball = verify_sphere("ball", "stone", RADIUS, place, velocity, spin);
    char *surface = mesh(), *materials = array_format(MATERIALS, "");
    struct simulation *sim =
        verify_scene(STEP,
                     "%sgravity: [0, 0, %.17g]\noutput: {series: {every: 1.0e-5}}\n"
                     "spheres:\n%sbodies:\n  - {name: floor, material: stone, geometry: %s, "
                     "motion: {rotation: {point: [0, 0, 0], axis: [0, 0, 1], rate: %.17g}}}\n",
                     materials, -G, ball, surface, rate);
    free(ball);
    free(surface);
    free(materials);
    verify_steps(sim, 5000);
    const struct vec3 first = verify_velocity(sim, 0);
    const int n = 50000; /* half a second */
    const struct felt felt =
        feel(sim, n, G, vec3_norm(first) * turning * (1.0 + yields), fading);
    const struct vec3 last = verify_velocity(sim, 0);
    verify_source(
        "2/7 of the table's rate, as of any ball that rolls on a turntable; (1.9), (3.2)");
    compare_felt("across a mesh that turns", &felt);
    const double turned =
        atan2(first.x * last.y - first.y * last.x, first.x * last.x + first.y * last.y);
    verify_row("across a mesh that turns: the path's own rate", "rad/s",
               turning * (1.0 + yields), turned / (n * STEP), 1e-8, VERIFY_RELATIVE,
               "that the spring yields, 2e-6, is expected; what is left of its first swing");
    verify_row("across a mesh that turns: speed after over before", "", exp(-fading * n * STEP),
               vec3_norm(last) / vec3_norm(first), 1e-8, VERIFY_ABSOLUTE,
               "the table's speed of half a step before is expected");
    verify_scene_free(sim);
}

/* A ball that rests under this gravity against a body: how many contacts it has. */
static void rest(const char *name, struct vec3 gravity, struct vec3 centre,
                 const char *geometry, double expected)
{
    char *ball = verify_sphere("ball", "stone", RADIUS, centre, (struct vec3){0.0, 0.0, 0.0},
                               (struct vec3){0.0, 0.0, 0.0});
    char *materials = array_format(MATERIALS, "");
    struct simulation *sim = verify_scene(
        STEP,
        "%sgravity: [%g, %g, %g]\noutput: {series: {every: 1.0e-5}}\ndamping: 100\n"
        "spheres:\n%sbodies:\n  - {name: walls, material: stone, geometry: %s}\n",
        materials, gravity.x, gravity.y, gravity.z, ball, geometry);
    free(ball);
    free(materials);
    verify_steps(sim, 5000);
    verify_row(name, "", expected, verify_series(sim, "n_facet_contacts"), 0.0, VERIFY_ABSOLUTE,
               "a number");
    verify_scene_free(sim);
}

int main(int argc, char **argv)
{
    static const char box[] = "{kind: box, open: top, min: [0, 0, 0], max: [0.1, 0.1, 0.1]}";
    static const char ridge[] = "{kind: mesh, vertices: [[0, -0.1, 0], [0, 0.1, 0], "
                                "[0.1, 0.1, -0.1], [0.1, -0.1, -0.1], [-0.1, 0.1, -0.1], "
                                "[-0.1, -0.1, -0.1]], facets: [[0, 3, 2, 1], [0, 1, 4, 5]]}";
    static const char pyramid[] = "{kind: mesh, vertices: [[0, 0, 0], [-0.1, -0.1, -0.1], "
                                  "[0.1, -0.1, -0.1], [0.1, 0.1, -0.1], [-0.1, 0.1, -0.1]], "
                                  "facets: [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]}";
    const struct vec3 still = {0.0, 0.0, 0.0}, moving = {0.4, -0.25, 0.0};
    const struct vec3 x = {1.0, 0.0, 0.0}, skew = {0.8, 0.6, 0.0},
                      diagonal = {sqrt(0.5), sqrt(0.5), 0.0};
    verify_begin(argc, argv, "Edges and corners",
                 "a plane in pieces is a plane; 5/7 g sin of the slope");
    roll("across faces and edges", &hertz, (struct vec3){-0.06, -0.031, 0.0}, skew, still);
    roll("along a seam", &hertz, (struct vec3){-0.07, 0.0, 0.0}, x, still);
    roll("from vertex to vertex", &hertz, (struct vec3){-4.0 * CELL, -4.0 * CELL, 0.0},
         diagonal, still);
    roll("across a mesh that moves", &hertz, (struct vec3){-0.06, -0.031, 0.0}, skew, moving);
    roll("linear law, across faces and edges", &linear, (struct vec3){-0.06, -0.031, 0.0}, skew,
         still);
    roll("linear law, across a mesh that moves", &linear, (struct vec3){-0.06, -0.031, 0.0},
         skew, moving);
    turntable(14.0);
    const double deep = 1e-5;
    verify_source("one for each wall of a concave corner, one on a convex edge or tip");
    rest("contacts in a corner of three walls", (struct vec3){-3.0, -4.0, -5.0},
         (struct vec3){RADIUS - deep, RADIUS - deep, RADIUS - deep}, box, 3.0);
    rest("contacts in a corner of two walls", (struct vec3){-3.0, 0.0, -5.0},
         (struct vec3){RADIUS - deep, 0.05, RADIUS - deep}, box, 2.0);
    rest("contacts on a ridge", (struct vec3){0.0, 0.0, -5.0},
         (struct vec3){0.0, 0.003, RADIUS - deep}, ridge, 1.0);
    rest("contacts on the tip of a pyramid", (struct vec3){0.0, 0.0, -5.0},
         (struct vec3){0.0, 0.0, RADIUS - deep}, pyramid, 1.0);
    return verify_end();
}
