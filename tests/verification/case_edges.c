/*
 * A plane made of many quads and triangles is a plane: a ball that rolls over it, face to edge
 * to vertex, feels the same force and goes on as on one facet, whether the mesh stands or
 * moves. And corners: one contact for each wall of a concave one, one on a convex edge.
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
    "contact:\n  pairs:\n    - {between: [stone, stone], friction: 0.5, restitution: 0.5}\n";

/* Overlap at which the contact carries this force. (1.5) */
static double overlap_under(double force)
{
    const double modulus = impact_modulus(&stone, &stone);
    return pow(0.75 * force / (modulus * sqrt(RADIUS)), 2.0 / 3.0);
}

/* Rolls from `start` along `along` (a unit vector), down a slope of 5 degrees that way. */
static void roll(const char *name, struct vec3 start, struct vec3 along, struct vec3 mesh_moves)
{
    const double angle = 5.0 * M_PI / 180.0, speed = 0.3;
    const double weight = impact_mass(&stone, RADIUS) * G * cos(angle);
    const struct vec3 place = {start.x, start.y, RADIUS - overlap_under(weight)};
    const struct vec3 velocity = vec3_axpy(mesh_moves, speed, along);
    const struct vec3 spin = vec3_scale(speed / RADIUS, (struct vec3){-along.y, along.x, 0.0});
    char *ball = verify_sphere("ball", "stone", RADIUS, place, velocity, spin);
    char *surface = mesh();
    struct simulation *sim =
        verify_scene(STEP,
                     "%sgravity: [%.17g, %.17g, %.17g]\noutput: {series: {every: 1.0e-5}}\n"
                     "spheres:\n%sbodies:\n  - {name: floor, material: stone, geometry: %s, "
                     "motion: {velocity: [%.17g, %.17g, 0]}}\n",
                     MATERIALS, G * sin(angle) * along.x, G * sin(angle) * along.y,
                     -G * cos(angle), ball, surface, mesh_moves.x, mesh_moves.y);
    free(ball);
    free(surface);
    /* The tangential force of rolling down builds up and swings for a while. */
    verify_steps(sim, 5000);
    const double begun = vec3_dot(verify_velocity(sim, 0), along);
    const int n = 20000; /* 0.2 s: some ten centimetres */
    double off = 0.0, grip_off = 0.0, contacts = 0.0;
    const double pull = 5.0 / 7.0 * G * sin(angle);
    struct vec3 before = verify_velocity(sim, 0);
    for (int k = 0; k < n; k++) {
        verify_steps(sim, 1);
        const struct vec3 now = verify_velocity(sim, 0);
        const double push = (now.z - before.z) / STEP / (G * cos(angle));
        const double gained = vec3_dot(vec3_sub(now, before), along) / STEP;
        off = fabs(push) > off ? fabs(push) : off;
        grip_off = fabs(gained / pull - 1.0) > grip_off ? fabs(gained / pull - 1.0) : grip_off;
        before = now;
        const double touching = verify_series(sim, "n_facet_contacts");
        contacts = touching > contacts ? touching : contacts;
    }
    const double gained = vec3_dot(before, along) - begun;
    char row[128];
    snprintf(row, sizeof row, "%s: normal force over the weight, largest change", name);
    verify_row(row, "", 0.0, off, 1e-6, VERIFY_AT_MOST, "asked for");
    snprintf(row, sizeof row, "%s: acceleration, largest change from one step to another",
             name);
    verify_row(row, "", 0.0, grip_off, 1e-6, VERIFY_AT_MOST, "asked for of the normal force");
    snprintf(row, sizeof row, "%s: mean acceleration", name);
    verify_row(row, "m/s2", pull, gained / (n * STEP), 1e-9, VERIFY_RELATIVE,
               "uniform, so exact but for rounding");
    snprintf(row, sizeof row, "%s: contacts at once", name);
    verify_row(row, "", 1.0, contacts, 0.0, VERIFY_ABSOLUTE, "a number");
    verify_scene_free(sim);
}

/* A ball that rests under this gravity against a body: how many contacts it has. */
static void rest(const char *name, struct vec3 gravity, struct vec3 centre,
                 const char *geometry, double expected)
{
    char *ball = verify_sphere("ball", "stone", RADIUS, centre, (struct vec3){0.0, 0.0, 0.0},
                               (struct vec3){0.0, 0.0, 0.0});
    struct simulation *sim = verify_scene(
        STEP,
        "%sgravity: [%g, %g, %g]\noutput: {series: {every: 1.0e-5}}\ndamping: 100\n"
        "spheres:\n%sbodies:\n  - {name: walls, material: stone, geometry: %s}\n",
        MATERIALS, gravity.x, gravity.y, gravity.z, ball, geometry);
    free(ball);
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
    const struct vec3 still = {0.0, 0.0, 0.0}, moving = {0.4, -0.25, 0.0};
    const struct vec3 x = {1.0, 0.0, 0.0}, skew = {0.8, 0.6, 0.0},
                      diagonal = {sqrt(0.5), sqrt(0.5), 0.0};
    verify_begin(argc, argv, "Edges and corners",
                 "a plane in pieces is a plane; 5/7 g sin of the slope");
    roll("across faces and edges", (struct vec3){-0.06, -0.031, 0.0}, skew, still);
    roll("along a seam", (struct vec3){-0.07, 0.0, 0.0}, x, still);
    roll("from vertex to vertex", (struct vec3){-4.0 * CELL, -4.0 * CELL, 0.0}, diagonal,
         still);
    roll("across a mesh that moves", (struct vec3){-0.06, -0.031, 0.0}, skew, moving);
    const double deep = 1e-5;
    verify_source("one for each wall of a concave corner, one on a convex edge");
    rest("contacts in a corner of three walls", (struct vec3){-3.0, -4.0, -5.0},
         (struct vec3){RADIUS - deep, RADIUS - deep, RADIUS - deep}, box, 3.0);
    rest("contacts in a corner of two walls", (struct vec3){-3.0, 0.0, -5.0},
         (struct vec3){RADIUS - deep, 0.05, RADIUS - deep}, box, 2.0);
    rest("contacts on a ridge", (struct vec3){0.0, 0.0, -5.0},
         (struct vec3){0.0, 0.003, RADIUS - deep}, ridge, 1.0);
    return verify_end();
}
