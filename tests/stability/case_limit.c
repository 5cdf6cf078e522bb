/*
 * The real limit of the step beside the bound that runs are watched with (THEORY.md, section
 * 6): one contact, chains, packed beds, with and without damping.  With --csv it prints a
 * table, and its status says whether a limit lies below its bound or its margin.
 */
/* long */
#include "limit.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../verification/verify.h"
#include "base/array.h"

/* Modulus [Pa], density [kg/m3] and mean radius [m] of all scenes. */
#define MATERIALS                                                                              \
    "materials:\n"                                                                             \
    "  ore: {density: 2500, young: 1.0e+8, poisson: 0.2}\n"                                    \
    "  rigid: {density: 2500, young: 1.0e+14, poisson: 0.2}\n"                                 \
    "contact:\n  pairs:\n"                                                                     \
    "    - {between: [ore, ore], friction: %g, restitution: %g%s}\n"                           \
    "    - {between: [ore, rigid], friction: %g, restitution: %g%s}\n"                         \
    "domain: {leavers: ignore}\nwatch: {overlap: 1, motion: 1, step: 1000, energy: 0}\n"       \
    "damping: %g\ngravity: [0, 0, %g]\n"

static const double RADIUS = 0.01;
/* What `step: auto` takes of the real limit at most, as README.md says. */
static const double AUTOMATIC_MOST = 0.4;

struct material {
    double friction, restitution;
    const char *law, *keys; /* its name, and further keys of the pairs */
};

static const char hertz[] = "Hertz", linear[] = "linear", rolling[] = "Hertz and rolling";
/* About as stiff as Hertz's contact under gravity. */
static const char linear_keys[] = ", law: linear, stiffness: 6.0e+4";
static const char rolling_keys[] = ", rolling_friction: 0.5";

static char *materials_text(struct material m, double damping, double gravity)
{
    return array_format(MATERIALS, m.friction, m.restitution, m.keys, m.friction, m.restitution,
                        m.keys, damping, gravity);
}

static bool csv, broken;

static struct limit find(const char *scene, const char *what, struct material m, char *text,
                         double dt, int n_steps, enum limit_push push)
{
    const struct limit limit = limit_find(text, dt, n_steps, push);
    free(text);
    broken = broken || limit.bound > 1.002 * limit.step ||
             limit.automatic > AUTOMATIC_MOST * limit.step;
    if (csv)
        printf("%s,%s,%s,%g,%g,%.3f,%.3e,%.5e,%.5e,%.4f,%.4f,%.4f\n", scene, what, m.law,
               m.friction, m.restitution, limit.partners, limit.overlap_mean, limit.bound,
               limit.step, limit.step / limit.bound, limit.bound / limit.rayleigh,
               limit.automatic / limit.step);
    else {
        verify_row(scene, "", 1.0, limit.bound / limit.step, 0.002, VERIFY_AT_MOST,
                   "what is found is bisected to 2e-3");
        verify_row(scene, "", AUTOMATIC_MOST, limit.automatic / limit.step, 0.0, VERIFY_AT_MOST,
                   "the margin that is stated");
    }
    fflush(stdout);
    return limit;
}

/* A sphere that lies on a plane. */
static char *on_plane(struct material m)
{
    char *start = materials_text(m, 2000.0, -300.0);
    char *sphere = verify_sphere("one", "ore", RADIUS, (struct vec3){0.0, 0.0, 0.998 * RADIUS},
                                 (struct vec3){0.0, 0.0, 0.0}, (struct vec3){0.0, 0.0, 0.0});
    char *text = array_format(
        "%sspheres:\n%sbodies:\n  - {name: floor, material: rigid, geometry: {kind: plane, "
        "point: [0, 0, 0], normal: [0, 0, 1], extent: 1}}\n",
        start, sphere);
    free(start);
    free(sphere);
    return text;
}

/* n spheres in a row along x that two walls press together; no gravity. */
static char *row(struct material m, int n)
{
    char *start = materials_text(m, 2000.0, 0.0), *spheres = array_string("");
    const double spacing = 1.996 * RADIUS;
    for (int i = 0; i < n; i++) {
        char name[32];
        snprintf(name, sizeof name, "s%d", i);
        char *sphere =
            verify_sphere(name, "ore", RADIUS, (struct vec3){i * spacing, 0.0, 0.0},
                          (struct vec3){0.0, 0.0, 0.0}, (struct vec3){0.0, 0.0, 0.0});
        char *more = array_format("%s%s", spheres, sphere);
        free(spheres);
        free(sphere);
        spheres = more;
    }
    char *text = array_format(
        "%sspheres:\n%sbodies:\n"
        "  - {name: left, material: rigid, geometry: {kind: plane, point: [%.17g, 0, 0], "
        "normal: [1, 0, 0], extent: 1}}\n"
        "  - {name: right, material: rigid, geometry: {kind: plane, point: [%.17g, 0, 0], "
        "normal: [-1, 0, 0], extent: 1}}\n",
        start, spheres, -0.998 * RADIUS, (n - 1) * spacing + 0.998 * RADIUS);
    free(start);
    free(spheres);
    return text;
}

/* Pseudo-random, 0 to 1. */
static double next_random(unsigned *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / 16777216.0;
}

/* Spheres of radii that differ by up to `spread` that have fallen into a box. */
static char *bed(struct material m, double spread)
{
    enum { SIDE = 5, LAYERS = 10 };
    const double pitch = 2.0 * RADIUS * (1.0 + spread) * 1.02, edge = SIDE * pitch;
    char *start = materials_text(m, 30.0, -100.0), *spheres = NULL;
    size_t size = 0;
    unsigned seed = 7;
    FILE *out = open_memstream(&spheres, &size);
    for (int k = 0; k < SIDE * SIDE * LAYERS; k++) {
        char name[32];
        snprintf(name, sizeof name, "s%d", k);
        const double r = RADIUS * (1.0 + spread * (2.0 * next_random(&seed) - 1.0));
        const int row = k / SIDE, layer = row / SIDE;
        const struct vec3 x = {(k % SIDE + 0.5) * pitch, (row % SIDE + 0.5) * pitch,
                               (layer + 0.5) * pitch};
        const struct vec3 v = {next_random(&seed) - 0.5, next_random(&seed) - 0.5, 0.0};
        char *sphere = verify_sphere(name, "ore", r, x, v, (struct vec3){0.0, 0.0, 0.0});
        fputs(sphere, out);
        free(sphere);
    }
    fclose(out);
    char *text = array_format("%sspheres:\n%sbodies:\n  - {name: box, material: rigid, "
                              "geometry: {kind: box, open: top, min: [0, 0, 0], max: [%.17g, "
                              "%.17g, 1]}}\n",
                              start, spheres, edge, edge);
    free(start);
    free(spheres);
    return text;
}

/* Layers of a close packing, each sphere amid twelve, pressed by gravity in a box that fits. */
static char *crystal(struct material m)
{
    enum { SIDE = 4, LAYERS = 5 };
    const double pitch = 1.998 * RADIUS, height = pitch * sqrt(0.5);
    char *start = materials_text(m, 30.0, -100.0), *spheres = NULL;
    size_t size = 0;
    int n = 0;
    FILE *out = open_memstream(&spheres, &size);
    for (int layer = 0; layer < LAYERS; layer++) {
        const int side = SIDE - layer % 2;
        for (int k = 0; k < side * side; k++) {
            char name[32];
            snprintf(name, sizeof name, "s%d", n++);
            const double shift = 0.5 * pitch * (layer % 2);
            const int row = k / side, place = k % side;
            const struct vec3 x = {place * pitch + shift, row * pitch + shift, layer * height};
            char *sphere = verify_sphere(name, "ore", RADIUS, x, (struct vec3){0.0, 0.0, 0.0},
                                         (struct vec3){0.0, 0.0, 0.0});
            fputs(sphere, out);
            free(sphere);
        }
    }
    fclose(out);
    const double low = -0.999 * RADIUS, high = (SIDE - 1) * pitch + 0.999 * RADIUS;
    char *text = array_format("%sspheres:\n%sbodies:\n  - {name: box, material: rigid, "
                              "geometry: {kind: box, min: [%.17g, %.17g, %.17g], max: [%.17g, "
                              "%.17g, %.17g]}}\n",
                              start, spheres, low, low, low, high, high,
                              (LAYERS - 1) * height + 0.999 * RADIUS);
    free(start);
    free(spheres);
    return text;
}

int main(int argc, char **argv)
{
    csv = argc > 1 && strcmp(argv[1], "--csv") == 0;
    verify_begin(argc, argv, "The step's limit", "THEORY.md (6.5)");
    const double dt = 2e-6;
    if (csv)
        puts("scene,motion,law,friction,restitution,partners,overlap,bound_s,limit_s,"
             "limit_over_bound,bound_over_rayleigh,automatic_over_limit");
    static const double restitutions[] = {1.0, 0.9, 0.5, 0.2, 0.05};
    for (int k = 0; k < 5; k++) {
        const double e = restitutions[k];
        const struct material smooth = {0.0, e, hertz, ""}, rough = {10.0, e, hertz, ""};
        const struct material spring = {0.0, e, linear, linear_keys};
        find("plane", "normal", smooth, on_plane(smooth), dt, 20000, LIMIT_PUSH_Z);
        find("plane", "tangential", rough, on_plane(rough), dt, 20000, LIMIT_PUSH_SPIN);
        find("plane", "normal", spring, on_plane(spring), dt, 20000, LIMIT_PUSH_Z);
        find("row of 2", "normal", smooth, row(smooth, 2), dt, 20000, LIMIT_PUSH_X);
        find("row of 10", "normal", smooth, row(smooth, 10), dt, 20000, LIMIT_PUSH_X);
    }
    for (int k = 0; k < 4; k++) {
        const double e = restitutions[k];
        const struct material smooth = {0.0, e, hertz, ""}, rough = {0.5, e, hertz, ""},
                              sticky = {10.0, e, hertz, ""},
                              springs = {0.5, e, linear, linear_keys},
                              rolls = {0.5, e, rolling, rolling_keys};
        find("crystal", "all", smooth, crystal(smooth), 5e-6, 40000, LIMIT_PUSH_ALL);
        find("crystal", "all", sticky, crystal(sticky), 5e-6, 40000, LIMIT_PUSH_ALL);
        find("bed", "all", smooth, bed(smooth, 0.2), 5e-6, 80000, LIMIT_PUSH_ALL);
        find("bed", "all", rough, bed(rough, 0.2), 5e-6, 80000, LIMIT_PUSH_ALL);
        find("bed", "all", springs, bed(springs, 0.2), 5e-6, 80000, LIMIT_PUSH_ALL);
        find("bed", "all", rolls, bed(rolls, 0.2), 5e-6, 80000, LIMIT_PUSH_ALL);
    }
    const int status = verify_end();
    return csv ? broken : status;
}
