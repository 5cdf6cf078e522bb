/* See canvas.h. */
#include "canvas.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "font.h"

enum { POLYGON_MAX = 16 };
static const double NEAR = 1e-6; /* what is nearer to the eye is cut away [m] */

/* A rectangle of samples, ends included. */
struct span {
    int left, right, top, bottom;
};

static int clip(double value, int least, int most)
{
    if (!(value > least))
        return least;
    return value < most ? (int)value : most;
}

static struct span span_of(const struct canvas *canvas, double left, double right, double top,
                           double bottom)
{
    return (struct span){
        clip(floor(left), 0, canvas->width), clip(ceil(right), -1, canvas->width - 1),
        clip(floor(top), 0, canvas->height), clip(ceil(bottom), -1, canvas->height - 1)};
}

static unsigned char byte_of(double value)
{
    return (unsigned char)clip(value * 255.0 + 0.5, 0, 255);
}

static void paint(struct canvas *canvas, size_t i, struct colours_rgb colour, double opacity)
{
    const double channels[3] = {(double)colour.r, (double)colour.g, (double)colour.b};
    for (int k = 0; k < 3; k++) {
        const double under = canvas->colour[i][k] / 255.0;
        canvas->colour[i][k] = byte_of(under + opacity * (channels[k] - under));
    }
}

static size_t sample_at(const struct canvas *canvas, int x, int y)
{
    return (size_t)y * (size_t)canvas->width + (size_t)x;
}

/* The ray through the middle of a sample, at depth 1. */
static struct vec3 ray_of(const struct camera *camera, int x, int y)
{
    return (struct vec3){(x + 0.5 - camera->centre[0]) / camera->focal,
                         (camera->centre[1] - y - 0.5) / camera->focal, 1.0};
}

void canvas_init(struct canvas *canvas, int width, int height)
{
    *canvas =
        (struct canvas){.width = width * CANVAS_SAMPLES, .height = height * CANVAS_SAMPLES};
    const size_t n = (size_t)canvas->width * (size_t)canvas->height;
    canvas->depth = array_allocate(n, sizeof *canvas->depth);
    canvas->colour = array_allocate(n, sizeof *canvas->colour);
    canvas->normal = array_allocate(n, sizeof *canvas->normal);
    for (size_t i = 0; i < n; i++)
        canvas->depth[i] = INFINITY;
    for (int y = 0; y < canvas->height; y++) {
        const float share = (float)y / (float)canvas->height;
        const struct colours_rgb sky = {0.985f - 0.085f * share, 0.988f - 0.073f * share,
                                        0.992f - 0.060f * share};
        for (int x = 0; x < canvas->width; x++)
            paint(canvas, sample_at(canvas, x, y), sky, 1.0);
    }
}

void canvas_clear(struct canvas *canvas)
{
    free(canvas->depth);
    free(canvas->colour);
    free(canvas->normal);
    *canvas = (struct canvas){0};
}

/* ---------------------------------------------------------------------------------- spheres */

/* The range of x/z (or y/z) that a ball covers, its centre at x and depth z. */
static void slopes_of_ball(double x, double z, double radius, double slopes[2])
{
    const double square = z * z - radius * radius;
    const double root = radius * sqrt(x * x + square);
    slopes[0] = (x * z - root) / square;
    slopes[1] = (x * z + root) / square;
}

static void sphere_sample(struct canvas *canvas, size_t i, struct vec3 ray, struct vec3 centre,
                          double radius, const unsigned char colour[3])
{
    const double a = vec3_dot(ray, ray), b = vec3_dot(ray, centre);
    const double discriminant = b * b - a * (vec3_dot(centre, centre) - radius * radius);
    if (discriminant < 0.0)
        return;
    const double depth = (b - sqrt(discriminant)) / a;
    if (!(depth < (double)canvas->depth[i]))
        return;
    const struct vec3 normal =
        vec3_scale(127.0 / radius, vec3_sub(vec3_scale(depth, ray), centre));
    canvas->depth[i] = (float)depth;
    canvas->normal[i][0] = (signed char)normal.x;
    canvas->normal[i][1] = (signed char)normal.y;
    canvas->normal[i][2] = (signed char)normal.z;
    memcpy(canvas->colour[i], colour, 3);
}

void canvas_sphere(struct canvas *canvas, const struct camera *camera, struct vec3 centre,
                   double radius, struct colours_rgb colour)
{
    const struct vec3 c = camera_point(camera, centre);
    if (!(c.z > 1.01 * radius))
        return;
    double across[2], upwards[2];
    slopes_of_ball(c.x, c.z, radius, across);
    slopes_of_ball(c.y, c.z, radius, upwards);
    const double f = camera->focal;
    const struct span span = span_of(
        canvas, camera->centre[0] + f * across[0] - 1.0, camera->centre[0] + f * across[1],
        camera->centre[1] - f * upwards[1] - 1.0, camera->centre[1] - f * upwards[0]);
    const unsigned char bytes[3] = {byte_of((double)colour.r), byte_of((double)colour.g),
                                    byte_of((double)colour.b)};
    for (int y = span.top; y <= span.bottom; y++)
        for (int x = span.left; x <= span.right; x++)
            sphere_sample(canvas, sample_at(canvas, x, y), ray_of(camera, x, y), c, radius,
                          bytes);
}

/* ------------------------------------------------------------------------------------ light */

enum { SHADE_PROBES = 12 };

/* Probes on a spiral; its turn differs from sample to sample within a pixel, so that averaging
 * a pixel's samples looks in all their directions. */
static void spiral(int turn, double probes[SHADE_PROBES][2])
{
    const double golden = 2.399963229728653;
    for (int k = 0; k < SHADE_PROBES; k++) {
        const double angle = golden * k + 1.570796326794897 * 0.61 * turn;
        const double length = sqrt((k + 0.5) / SHADE_PROBES);
        probes[k][0] = length * cos(angle);
        probes[k][1] = length * sin(angle);
    }
}

/* How open the surroundings of a surface point are, 0 to 1. */
static double openness(const struct canvas *canvas, const struct camera *camera, int x, int y,
                       struct vec3 normal, double reach, double probes[SHADE_PROBES][2])
{
    const double depth = (double)canvas->depth[sample_at(canvas, x, y)];
    const struct vec3 point = vec3_scale(depth, ray_of(camera, x, y));
    const double radius = reach * camera->focal / depth;
    double shut = 0.0;
    for (int k = 0; k < SHADE_PROBES; k++) {
        const int px = x + (int)(radius * probes[k][0]), py = y + (int)(radius * probes[k][1]);
        if (px < 0 || py < 0 || px >= canvas->width || py >= canvas->height)
            continue;
        const double there = (double)canvas->depth[sample_at(canvas, px, py)];
        if (!(there < depth + reach))
            continue;
        const struct vec3 way = vec3_sub(vec3_scale(there, ray_of(camera, px, py)), point);
        const double square = vec3_dot(way, way), rise = vec3_dot(normal, way);
        if (rise > 0.05 * reach)
            shut += rise / sqrt(square) / (1.0 + square / (reach * reach));
    }
    const double open = 1.0 - 2.0 * shut / SHADE_PROBES;
    return open > 0.0 ? open : 0.0;
}

/* The displayed brightness of a surface, times its colour, and the gloss added to it. */
static void shine(struct vec3 normal, double open, double *matt, double *gloss)
{
    static const struct vec3 lamp = {-0.42, 0.66, -0.62}; /* over the viewer's left shoulder */
    static const struct vec3 half = {-0.234, 0.367, -0.900};
    const double towards = vec3_dot(normal, lamp);
    const double sky = 0.5 + 0.5 * normal.y;
    const double facing = vec3_dot(normal, half);
    *matt = (0.36 + 0.24 * sky) * (0.25 + 0.75 * open) +
            (towards > 0.0 ? 0.60 * towards * (0.55 + 0.45 * open) : 0.0);
    *gloss = facing > 0.0 ? 0.16 * open * pow(facing, 40.0) : 0.0;
}

static void light_sample(struct canvas *canvas, const struct camera *camera, int x, int y,
                         double reach, double probes[SHADE_PROBES][2])
{
    const size_t i = sample_at(canvas, x, y);
    const signed char *n = canvas->normal[i];
    const struct vec3 normal = {n[0] / 127.0, n[1] / 127.0, n[2] / 127.0};
    double matt, gloss;
    shine(normal, openness(canvas, camera, x, y, normal, reach, probes), &matt, &gloss);
    for (int k = 0; k < 3; k++)
        canvas->colour[i][k] = byte_of(canvas->colour[i][k] / 255.0 * matt + gloss);
}

void canvas_light(struct canvas *canvas, const struct camera *camera, double reach)
{
    double probes[4][SHADE_PROBES][2];
    for (int turn = 0; turn < 4; turn++)
        spiral(turn, probes[turn]);
    for (int y = 0; y < canvas->height; y++)
        for (int x = 0; x < canvas->width; x++)
            if (isfinite(canvas->depth[sample_at(canvas, x, y)]))
                light_sample(canvas, camera, x, y, reach, probes[(y & 1) * 2 + (x & 1)]);
}

/* ------------------------------------------------------------------------- facets and edges */

/* Cuts away what lies behind the eye; returns the corners left. */
static int clip_near(int n, const struct vec3 *corners, struct vec3 *kept)
{
    int n_kept = 0;
    for (int i = 0; i < n; i++) {
        const struct vec3 a = corners[i], b = corners[(i + 1) % n];
        if (a.z > NEAR)
            kept[n_kept++] = a;
        if ((a.z > NEAR) != (b.z > NEAR))
            kept[n_kept++] = vec3_axpy(a, (NEAR - a.z) / (b.z - a.z), vec3_sub(b, a));
    }
    return n_kept;
}

/* Is the ray inside the cone of the polygon's corners, seen from either side? */
static bool ray_inside(int n, const struct vec3 *sides, struct vec3 ray)
{
    bool plus = false, minus = false;
    for (int i = 0; i < n; i++) {
        const double side = vec3_dot(sides[i], ray);
        plus = plus || side > 0.0;
        minus = minus || side < 0.0;
    }
    return !(plus && minus);
}

static struct span span_of_polygon(const struct canvas *canvas, const struct camera *camera,
                                   int n, const struct vec3 *corners)
{
    double least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < n; i++) {
        const double at[2] = {camera->centre[0] + camera->focal * corners[i].x / corners[i].z,
                              camera->centre[1] - camera->focal * corners[i].y / corners[i].z};
        for (int k = 0; k < 2; k++) {
            least[k] = at[k] < least[k] ? at[k] : least[k];
            most[k] = at[k] > most[k] ? at[k] : most[k];
        }
    }
    return span_of(canvas, least[0] - 1.0, most[0], least[1] - 1.0, most[1]);
}

void canvas_facet(struct canvas *canvas, const struct camera *camera, int n,
                  const struct vec3 *corners, struct colours_rgb colour, double opacity)
{
    CHECK(n <= POLYGON_MAX / 2, "a facet of %d corners", n);
    struct vec3 seen[POLYGON_MAX / 2], kept[POLYGON_MAX], sides[POLYGON_MAX];
    for (int i = 0; i < n; i++)
        seen[i] = camera_point(camera, corners[i]);
    const struct vec3 normal =
        vec3_cross(vec3_sub(seen[1], seen[0]), vec3_sub(seen[2], seen[0]));
    const int n_kept = clip_near(n, seen, kept);
    if (n_kept < 3)
        return;
    for (int i = 0; i < n_kept; i++)
        sides[i] = vec3_cross(kept[i], kept[(i + 1) % n_kept]);
    const struct span span = span_of_polygon(canvas, camera, n_kept, kept);
    for (int y = span.top; y <= span.bottom; y++)
        for (int x = span.left; x <= span.right; x++) {
            const struct vec3 ray = ray_of(camera, x, y);
            const size_t i = sample_at(canvas, x, y);
            const double depth = vec3_dot(normal, kept[0]) / vec3_dot(normal, ray);
            if (ray_inside(n_kept, sides, ray) && depth > 0.0 &&
                depth < (double)canvas->depth[i])
                paint(canvas, i, colour, opacity);
        }
}

/* Share of the way from a to b at which p is nearest, 0 to 1, and the square of the distance
 * there. */
static double nearest_share(const double a[2], const double b[2], const double p[2],
                            double *square)
{
    const double along[2] = {b[0] - a[0], b[1] - a[1]}, to[2] = {p[0] - a[0], p[1] - a[1]};
    const double length = along[0] * along[0] + along[1] * along[1];
    const double raw = length > 0.0 ? (to[0] * along[0] + to[1] * along[1]) / length : 0.0;
    const double share = raw > 0.0 ? (raw < 1.0 ? raw : 1.0) : 0.0;
    const double off[2] = {to[0] - share * along[0], to[1] - share * along[1]};
    *square = off[0] * off[0] + off[1] * off[1];
    return share;
}

/* Draws a line between points of the plane whose inverse depths are given [1/m]; it is hidden
 * by what is nearer by more than `slack`.  It goes by strips along its longer direction, so
 * that a long line costs no more than the samples near it. */
static void draw_line(struct canvas *canvas, const double ends[2][2], const double inverse[2],
                      double width, double slack, struct colours_rgb colour)
{
    const double dx = fabs(ends[1][0] - ends[0][0]), dy = fabs(ends[1][1] - ends[0][1]);
    const int along = dx > dy ? 0 : 1, across = 1 - along;
    const int low = ends[0][along] < ends[1][along] ? 0 : 1;
    const double *a = ends[low], *b = ends[1 - low];
    const double half = 0.5 * width, length = b[along] - a[along];
    const int sizes[2] = {canvas->width, canvas->height};
    const int last = clip(b[along] + half, -1, sizes[along] - 1);
    for (int u = clip(a[along] - half, 0, sizes[along]); u <= last; u++) {
        const double way = length > 0.0 ? (u + 0.5 - a[along]) / length : 0.0;
        const double middle =
            a[across] + (way > 0.0 ? (way < 1.0 ? way : 1.0) : 0.0) * (b[across] - a[across]);
        const int end = clip(middle + 1.5 * half + 1.0, -1, sizes[across] - 1);
        for (int v = clip(middle - 1.5 * half - 1.0, 0, sizes[across]); v <= end; v++) {
            const int x = along == 0 ? u : v, y = along == 0 ? v : u;
            double square;
            const double share =
                nearest_share(a, b, (const double[2]){x + 0.5, y + 0.5}, &square);
            const double depth =
                1.0 / (inverse[low] + share * (inverse[1 - low] - inverse[low]));
            const size_t i = sample_at(canvas, x, y);
            if (square <= half * half && depth - slack < (double)canvas->depth[i])
                paint(canvas, i, colour, 1.0);
        }
    }
}

void canvas_edge(struct canvas *canvas, const struct camera *camera, struct vec3 a,
                 struct vec3 b, double width, double slack, struct colours_rgb colour)
{
    struct vec3 p[2] = {camera_point(camera, a), camera_point(camera, b)};
    const double least = 0.01 * slack + NEAR;
    if (p[0].z < least && p[1].z < least)
        return;
    const struct vec3 whole[2] = {p[0], p[1]};
    for (int k = 0; k < 2; k++)
        if (p[k].z < least)
            p[k] = vec3_axpy(whole[k], (least - whole[k].z) / (whole[1 - k].z - whole[k].z),
                             vec3_sub(whole[1 - k], whole[k]));
    const double ends[2][2] = {{camera->centre[0] + camera->focal * p[0].x / p[0].z,
                                camera->centre[1] - camera->focal * p[0].y / p[0].z},
                               {camera->centre[0] + camera->focal * p[1].x / p[1].z,
                                camera->centre[1] - camera->focal * p[1].y / p[1].z}};
    draw_line(canvas, ends, (const double[2]){1.0 / p[0].z, 1.0 / p[1].z}, width, slack,
              colour);
}

/* ----------------------------------------------------------------------------- on the plane */

void canvas_rectangle(struct canvas *canvas, double left, double top, double right,
                      double bottom, struct colours_rgb colour)
{
    const struct span span = span_of(canvas, left, right - 1.0, top, bottom - 1.0);
    for (int y = span.top; y <= span.bottom; y++)
        for (int x = span.left; x <= span.right; x++)
            paint(canvas, sample_at(canvas, x, y), colour, 1.0);
}

void canvas_stroke(struct canvas *canvas, const double a[2], const double b[2], double width,
                   struct colours_rgb colour)
{
    const double ends[2][2] = {{a[0], a[1]}, {b[0], b[1]}};
    draw_line(canvas, ends, (const double[2]){1.0, 1.0}, width, INFINITY, colour);
}

static double dot_size(double height)
{
    return height / 6.0; /* capitals have 7 rows of dots, 6 gaps */
}

double canvas_text_width(double height, const char *text)
{
    const size_t n = strlen(text);
    return n > 0 ? dot_size(height) * (FONT_ADVANCE * (double)n - 2.0) : 0.0;
}

static void draw_glyphs(struct canvas *canvas, double left, double y, double dot, double width,
                        struct colours_rgb colour, const char *text)
{
    for (; *text != '\0'; text++, left += dot * FONT_ADVANCE) {
        struct font_stroke strokes[FONT_STROKES_MAX];
        const int n = font_strokes(*text, strokes);
        for (int k = 0; k < n; k++) {
            const double a[2] = {left + dot * (double)strokes[k].x[0],
                                 y + dot * ((double)strokes[k].y[0] - 6.0)};
            const double b[2] = {left + dot * (double)strokes[k].x[1],
                                 y + dot * ((double)strokes[k].y[1] - 6.0)};
            canvas_stroke(canvas, a, b, width, colour);
        }
    }
}

void canvas_text(struct canvas *canvas, double x, double y, double height,
                 enum canvas_anchor anchor, struct colours_rgb colour, const char *text)
{
    static const struct colours_rgb halo = {0.95f, 0.955f,
                                            0.96f}; /* where spheres lie behind */
    const double dot = dot_size(height), width = canvas_text_width(height, text);
    const double left = anchor == CANVAS_LEFT     ? x
                        : anchor == CANVAS_MIDDLE ? x - 0.5 * width
                                                  : x - width;
    draw_glyphs(canvas, left, y, dot, 2.8 * dot, halo, text);
    draw_glyphs(canvas, left, y, dot, 0.95 * dot, colour, text);
}

/* -------------------------------------------------------------------------------- the image */

void canvas_develop(const struct canvas *canvas, struct image *image)
{
    enum { N = CANVAS_SAMPLES };
    image_init(image, canvas->width / N, canvas->height / N);
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            for (int k = 0; k < 3; k++) {
                int sum = 0;
                for (int s = 0; s < N * N; s++)
                    sum += canvas->colour[sample_at(canvas, x * N + s % N, y * N + s / N)][k];
                image->pixels[((size_t)y * (size_t)image->width + (size_t)x) * 3 + (size_t)k] =
                    (unsigned char)((sum + N * N / 2) / (N * N));
            }
}
