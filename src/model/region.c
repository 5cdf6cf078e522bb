/*
 * See region.h.  Inside a surface is where a line straight up meets it an odd number of times.
 *
 * The line never meets an edge or a vertex: it is taken to pass by an infinitesimal beside them
 * (first in y, then in x).  An edge's crossing of the line's y is computed from the edge alone,
 * so the triangles at it agree on which side the line passes, and seen along z the triangles
 * cover the plane without gap or overlap whatever the rounding.  Only whether a triangle is met
 * above or below x is a matter of rounding, and only where x is on the triangle: within any
 * margin of it.
 *
 * A surface of revolution is looked at in the half-plane through its axis and x: distances are
 * those to lines there, and inside is where a line straight away from the axis meets an odd
 * number of them.
 *
 * Triangles are listed in the cells of a grid that their boxes meet; a query costs the lists of
 * one column of cells from x upwards, and of those within the margin.
 */
#include "model/region.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/random.h"
#include "model/body.h"
#include "model/periodic.h"

enum { CELLS_ALONG_MOST = 128 };

static const double PI = 3.14159265358979323846;

struct triangle {
    struct vec3 corners[3]; /* [m] */
    struct vec3 low, high;  /* its box [m] */
};

/* A line in the half-plane, from one point to another [m]. */
struct band {
    double radius[2], height[2];
};

struct region_surface {
    int n;
    struct triangle *triangles;
    struct vec3 origin, end; /* of the grid, and of all triangles [m] */
    double cell;             /* edge of a cell [m] */
    int cells[3];
    int *begin, *list; /* triangles of cell c: list[begin[c]] .. list[begin[c + 1] - 1] */
    /* A surface of revolution instead: its bands in the half-plane of an axis. */
    int n_bands;
    struct band *bands;
    struct vec3 foot, axis; /* a point of the axis [m]; along it, of length 1 */
};

static double lesser(double a, double b)
{
    return a < b ? a : b;
}

static double greater(double a, double b)
{
    return a > b ? a : b;
}

static void box_add(struct vec3 *low, struct vec3 *high, struct vec3 x)
{
    *low = (struct vec3){lesser(low->x, x.x), lesser(low->y, x.y), lesser(low->z, x.z)};
    *high = (struct vec3){greater(high->x, x.x), greater(high->y, x.y), greater(high->z, x.z)};
}

/* ------------------------------------------------------------------------------- the grid */

static int cell_along(double x, double origin, double cell, int n)
{
    const double k = (x - origin) / cell;
    return !(k > 0.0) ? 0 : k >= (double)n ? n - 1 : (int)k;
}

struct cells {
    int low[3], high[3];
};

/* The cells that a box meets. */
static struct cells cells_of(const struct region_surface *s, struct vec3 low, struct vec3 high)
{
    return (struct cells){{cell_along(low.x, s->origin.x, s->cell, s->cells[0]),
                           cell_along(low.y, s->origin.y, s->cell, s->cells[1]),
                           cell_along(low.z, s->origin.z, s->cell, s->cells[2])},
                          {cell_along(high.x, s->origin.x, s->cell, s->cells[0]),
                           cell_along(high.y, s->origin.y, s->cell, s->cells[1]),
                           cell_along(high.z, s->origin.z, s->cell, s->cells[2])}};
}

static int cell_index(const struct region_surface *s, int i, int j, int k)
{
    return (i * s->cells[1] + j) * s->cells[2] + k;
}

/* Cubes, some four for each triangle. */
static void choose_cells(struct region_surface *s)
{
    const struct vec3 size = vec3_sub(s->end, s->origin);
    const double longest = greater(size.x, greater(size.y, size.z));
    const double along[3] = {size.x, size.y, size.z};
    for (int n = 1; n <= CELLS_ALONG_MOST; n++) {
        s->cell = longest / (double)n;
        for (int c = 0; c < 3; c++)
            s->cells[c] = (int)(along[c] / s->cell) + 1;
        if ((double)s->cells[0] * s->cells[1] * s->cells[2] > 4.0 * s->n)
            return;
    }
}

/* Counts (list == NULL) or enters the triangles of each cell. */
static void fill_cells(struct region_surface *s, int *at, int *list)
{
    for (int t = 0; t < s->n; t++) {
        const struct cells c = cells_of(s, s->triangles[t].low, s->triangles[t].high);
        for (int i = c.low[0]; i <= c.high[0]; i++) {
            for (int j = c.low[1]; j <= c.high[1]; j++) {
                for (int k = c.low[2]; k <= c.high[2]; k++) {
                    const int cell = cell_index(s, i, j, k);
                    if (list != NULL)
                        list[at[cell]] = t;
                    at[cell]++;
                }
            }
        }
    }
}

static void build_cells(struct region_surface *s)
{
    const size_t n = (size_t)s->cells[0] * (size_t)s->cells[1] * (size_t)s->cells[2];
    int *at = array_allocate(n, sizeof *at);
    s->begin = array_allocate(n + 1, sizeof *s->begin);
    fill_cells(s, at, NULL);
    for (size_t c = 0; c < n; c++) {
        s->begin[c + 1] = s->begin[c] + at[c];
        at[c] = s->begin[c];
    }
    s->list = array_allocate((size_t)s->begin[n], sizeof *s->list);
    fill_cells(s, at, s->list);
    free(at);
}

/* ------------------------------------------------------------------------------- surfaces */

/* Does every ring that is not a point of the axis join two bands? */
static bool is_closed_round(const struct body *body, char **why)
{
    int n_open = 0;
    for (int r = 0; r < body->mesh.n_rings; r++)
        n_open += body->mesh.rings[r].radius > 0.0 && body->mesh.rings[r].bands[1] < 0;
    if (n_open == 0)
        return true;
    *why =
        array_format("'%s' is not closed: it has %d open rim%s; a body with a closed surface "
                     "(caps: [...]) is expected",
                     body->name, n_open, n_open == 1 ? "" : "s");
    return false;
}

/* Is every edge met by faces that go along it as often one way as the other?  Says where it is
 * not. */
static bool is_closed(const struct body *body, char **why)
{
    const struct mesh *mesh = &body->mesh;
    if (mesh->n_bands > 0)
        return is_closed_round(body, why);
    int *faces = array_allocate((size_t)mesh->n_edges, sizeof *faces);
    int *turns = array_allocate((size_t)mesh->n_edges, sizeof *turns);
    int n_open = 0, n_turned = 0, example = -1;
    for (int f = 0; f < mesh->n_faces; f++) {
        const struct mesh_face *face = &mesh->faces[f];
        for (int k = 0; k < face->n; k++) {
            const int e = face->edges[k];
            faces[e]++;
            turns[e] += mesh->edges[e].vertices[0] == face->vertices[k] ? 1 : -1;
        }
    }
    for (int e = 0; e < mesh->n_edges; e++) {
        n_open += faces[e] % 2 != 0;
        n_turned += faces[e] % 2 == 0 && turns[e] != 0;
        if (example < 0 && turns[e] != 0)
            example = e;
    }
    free(faces);
    free(turns);
    if (mesh->n_faces > 0 && n_open == 0 && n_turned == 0)
        return true;
    struct vec3 x = {0.0, 0.0, 0.0};
    for (int v = 0; example >= 0 && v < 2; v++)
        x = vec3_axpy(x, 0.5, mesh->reference[mesh->edges[example].vertices[v]]);
    *why =
        n_open > 0 || mesh->n_faces == 0
            ? array_format("'%s' is not closed: %d of its edges are open, one at [%.6g, "
                           "%.6g, %.6g]; a body with a closed surface is expected",
                           body->name, n_open, x.x, x.y, x.z)
            : array_format("'%s' has facets that face each other's backs at %d edges, one at "
                           "[%.6g, %.6g, %.6g]; facets that all face outwards are expected",
                           body->name, n_turned, x.x, x.y, x.z);
    return false;
}

static void add_triangle(struct region_surface *s, const struct vec3 *vertices, int a, int b,
                         int c)
{
    struct triangle *t = &s->triangles[s->n++];
    t->corners[0] = t->low = t->high = vertices[a];
    t->corners[1] = vertices[b];
    t->corners[2] = vertices[c];
    for (int k = 1; k < 3; k++)
        box_add(&t->low, &t->high, t->corners[k]);
}

static void build_triangles(struct region_surface *s, const struct mesh *mesh,
                            const struct vec3 *vertices)
{
    s->triangles = array_allocate(2 * (size_t)mesh->n_faces, sizeof *s->triangles);
    for (int f = 0; f < mesh->n_faces; f++) {
        const int *v = mesh->faces[f].vertices;
        add_triangle(s, vertices, v[0], v[1], v[2]);
        if (mesh->faces[f].n == 4)
            add_triangle(s, vertices, v[0], v[2], v[3]);
    }
    s->origin = s->triangles[0].low;
    s->end = s->triangles[0].high;
    for (int t = 1; t < s->n; t++) {
        box_add(&s->origin, &s->end, s->triangles[t].low);
        box_add(&s->origin, &s->end, s->triangles[t].high);
    }
    choose_cells(s);
    build_cells(s);
}

/* How far a circle of radius 1 about an axis reaches along x, y and z. */
static struct vec3 circle_reach(struct vec3 axis)
{
    return (struct vec3){sqrt(greater(1.0 - axis.x * axis.x, 0.0)),
                         sqrt(greater(1.0 - axis.y * axis.y, 0.0)),
                         sqrt(greater(1.0 - axis.z * axis.z, 0.0))};
}

static void build_round(struct region_surface *s, const struct mesh *mesh,
                        const struct vec3 *vertices)
{
    s->foot = vertices[mesh->axis[0]];
    s->axis = vec3_sub(vertices[mesh->axis[1]], s->foot);
    s->axis = vec3_scale(1.0 / vec3_norm(s->axis), s->axis);
    const struct vec3 reach = circle_reach(s->axis);
    s->n_bands = mesh->n_bands;
    s->bands = array_allocate((size_t)mesh->n_bands, sizeof *s->bands);
    for (int b = 0; b < mesh->n_bands; b++) {
        for (int k = 0; k < 2; k++) {
            const struct mesh_ring *ring = &mesh->rings[mesh->bands[b].rings[k]];
            const struct vec3 centre = vec3_axpy(s->foot, ring->height, s->axis);
            s->bands[b].radius[k] = ring->radius;
            s->bands[b].height[k] = ring->height;
            if (b == 0 && k == 0)
                s->origin = s->end = centre;
            box_add(&s->origin, &s->end, vec3_axpy(centre, -ring->radius, reach));
            box_add(&s->origin, &s->end, vec3_axpy(centre, ring->radius, reach));
        }
    }
}

struct region_surface *region_surface_build(const struct mesh *mesh,
                                            const struct vec3 *vertices)
{
    struct region_surface *s = array_allocate(1, sizeof *s);
    if (mesh->n_bands > 0)
        build_round(s, mesh, vertices);
    else if (mesh->n_faces > 0)
        build_triangles(s, mesh, vertices);
    return s;
}

void region_surface_destroy(struct region_surface *surface)
{
    if (surface != NULL) {
        free(surface->triangles);
        free(surface->begin);
        free(surface->list);
        free(surface->bands);
    }
    free(surface);
}

/* By the divergence theorem: pyramids over the triangles, seen from a corner of the box. */
static double enclosed_volume(const struct region_surface *s, struct vec3 from)
{
    double volume = 0.0;
    for (int t = 0; t < s->n; t++) {
        const struct vec3 a = vec3_sub(s->triangles[t].corners[0], from);
        const struct vec3 b = vec3_sub(s->triangles[t].corners[1], from);
        const struct vec3 c = vec3_sub(s->triangles[t].corners[2], from);
        volume += vec3_dot(a, vec3_cross(b, c)) / 6.0;
    }
    for (int b = 0; b < s->n_bands; b++) { /* frustums */
        const double *r = s->bands[b].radius, *h = s->bands[b].height;
        volume += PI / 3.0 * (h[1] - h[0]) * (r[0] * r[0] + r[0] * r[1] + r[1] * r[1]);
    }
    return volume < 0.0 ? -volume : volume;
}

static bool build_surface(struct region *region, const char *name, const struct bodies *bodies,
                          char **why)
{
    const struct body *body = NULL;
    for (int b = 0; bodies != NULL && b < bodies->n; b++)
        body = strcmp(bodies->list[b].name, name) == 0 ? &bodies->list[b] : body;
    if (body == NULL) {
        *why = array_format("there is no body '%s'; the name of a body is expected", name);
        return false;
    }
    if (!is_closed(body, why))
        return false;
    region->surface = region_surface_build(&body->mesh, body->mesh.reference);
    region->low = region->surface->origin;
    region->high = region->surface->end;
    region->volume = enclosed_volume(region->surface, region->low);
    return true;
}

/* ------------------------------------------------------------------------------- building */

static void build_cylinder(struct region *region, const struct job_region *asked)
{
    const struct vec3 along = vec3_sub(asked->to, asked->from);
    region->length = vec3_norm(along);
    region->axis = vec3_scale(1.0 / region->length, along);
    region->centre = asked->from;
    region->radius = asked->radius;
    region->volume = PI * asked->radius * asked->radius * region->length;
    region->low = region->high = asked->from;
    box_add(&region->low, &region->high, asked->to);
    const struct vec3 aside = circle_reach(region->axis);
    region->low = vec3_axpy(region->low, -asked->radius, aside);
    region->high = vec3_axpy(region->high, asked->radius, aside);
}

static void build_box(struct region *region, const struct job_region *asked)
{
    const struct vec3 size = vec3_sub(asked->max, asked->min);
    region->low = asked->min;
    region->high = asked->max;
    region->volume = size.x * size.y * size.z;
}

static void build_sphere(struct region *region, const struct job_region *asked)
{
    const struct vec3 all = {1.0, 1.0, 1.0};
    region->centre = asked->centre;
    region->radius = asked->radius;
    region->low = vec3_axpy(asked->centre, -asked->radius, all);
    region->high = vec3_axpy(asked->centre, asked->radius, all);
    region->volume = 4.0 / 3.0 * PI * asked->radius * asked->radius * asked->radius;
}

bool region_build(struct region *region, const struct job_region *asked,
                  const struct bodies *bodies, char **why)
{
    *region = (struct region){.kind = asked->kind};
    *why = NULL;
    switch (asked->kind) {
    case JOB_REGION_BOX:
        build_box(region, asked);
        break;
    case JOB_REGION_CYLINDER:
        build_cylinder(region, asked);
        break;
    case JOB_REGION_SPHERE:
        build_sphere(region, asked);
        break;
    case JOB_REGION_INSIDE:
        return build_surface(region, asked->body, bodies, why);
    }
    return true;
}

void region_clear(struct region *region)
{
    region_surface_destroy(region->surface);
    region->surface = NULL;
}

/* A cylinder along one of the axes has two ends that space may go round; a box six. */
static bool has_ends_along(const struct region *region, int c)
{
    const double axis[3] = {region->axis.x, region->axis.y, region->axis.z};
    return region->kind == JOB_REGION_BOX || region->kind == JOB_REGION_INSIDE ||
           (region->kind == JOB_REGION_CYLINDER && (axis[c] == 1.0 || axis[c] == -1.0));
}

void region_repeat(struct region *region, const struct periodic *periodic)
{
    double *const low[3] = {&region->low.x, &region->low.y, &region->low.z};
    double *const high[3] = {&region->high.x, &region->high.y, &region->high.z};
    for (int c = 0; c < 3; c++) {
        const double size = *high[c] - *low[c];
        if (!periodic->along[c] || !has_ends_along(region, c) ||
            size < periodic->period[c] * (1.0 - 1e-12))
            continue;
        region->endless[c] = true;
        region->volume *= periodic->period[c] / size; /* all that is alike along there */
        *low[c] = periodic->low[c];
        *high[c] = periodic->high[c];
    }
}

/* ------------------------------------------------------------------------------- distances */

/* Square of the distance from x to the line between a and b. */
static double segment_distance(struct vec3 x, struct vec3 a, struct vec3 b)
{
    const struct vec3 along = vec3_sub(b, a), r = vec3_sub(x, a);
    const double length = vec3_dot(along, along), t = vec3_dot(r, along);
    const double share = length > 0.0 ? lesser(greater(t / length, 0.0), 1.0) : 0.0;
    const struct vec3 off = vec3_axpy(r, -share, along);
    return vec3_dot(off, off);
}

/* Square of the distance from x to a triangle: to its plane where x is over it, else to the
 * nearest side. */
static double triangle_distance(const struct triangle *t, struct vec3 x)
{
    const struct vec3 *p = t->corners;
    const struct vec3 normal = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
    const double area = vec3_dot(normal, normal);
    bool over = area > 0.0;
    double least = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const struct vec3 side = vec3_sub(p[(k + 1) % 3], p[k]);
        over = over && vec3_dot(vec3_cross(normal, side), vec3_sub(x, p[k])) >= 0.0;
        least = lesser(least, segment_distance(x, p[k], p[(k + 1) % 3]));
    }
    const double height = vec3_dot(normal, vec3_sub(x, p[0]));
    return over ? lesser(least, height * height / area) : least;
}

/* Where x is in the half-plane: distance from the axis (x), height along it (y). */
static struct vec3 half_plane(const struct region_surface *s, struct vec3 x)
{
    const struct vec3 r = vec3_sub(x, s->foot);
    const double height = vec3_dot(r, s->axis);
    return (struct vec3){vec3_norm(vec3_axpy(r, -height, s->axis)), height, 0.0};
}

static struct vec3 band_end(const struct band *band, int k)
{
    return (struct vec3){band->radius[k], band->height[k], 0.0};
}

static bool is_near_band(const struct region_surface *s, struct vec3 x, double margin)
{
    const struct vec3 at = half_plane(s, x);
    for (int b = 0; b < s->n_bands; b++)
        if (segment_distance(at, band_end(&s->bands[b], 0), band_end(&s->bands[b], 1)) <
            margin * margin)
            return true;
    return false;
}

bool region_surface_is_near(const struct region_surface *s, struct vec3 x, double margin)
{
    if (s->n_bands > 0 || s->n == 0)
        return is_near_band(s, x, margin);
    const struct vec3 grow = {margin, margin, margin};
    const struct cells c = cells_of(s, vec3_sub(x, grow), vec3_add(x, grow));
    for (int i = c.low[0]; i <= c.high[0]; i++) {
        for (int j = c.low[1]; j <= c.high[1]; j++) {
            const int first = s->begin[cell_index(s, i, j, c.low[2])];
            const int end = s->begin[cell_index(s, i, j, c.high[2]) + 1];
            for (int l = first; l < end; l++)
                if (triangle_distance(&s->triangles[s->list[l]], x) < margin * margin)
                    return true;
        }
    }
    return false;
}

/* ------------------------------------------------------------------------------- inside */

/* Does the line through x pass to the left of where this side of a triangle crosses its y? */
static bool crosses_right_of(struct vec3 a, struct vec3 b, struct vec3 x)
{
    if ((a.y > x.y) == (b.y > x.y))
        return false;
    const struct vec3 low = a.y < b.y ? a : b, high = a.y < b.y ? b : a;
    const double at = low.x + (x.y - low.y) * ((high.x - low.x) / (high.y - low.y));
    return greater(lesser(low.x, high.x), lesser(at, greater(low.x, high.x))) > x.x;
}

/* Does the line straight up through x meet the triangle?  Gives the height. */
static bool meets(const struct triangle *t, struct vec3 x, double *height)
{
    bool odd = false;
    for (int k = 0; k < 3; k++)
        odd ^= crosses_right_of(t->corners[k], t->corners[(k + 1) % 3], x);
    if (!odd)
        return false;
    const struct vec3 *p = t->corners;
    const struct vec3 n = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
    const double tilt = (x.x - p[0].x) * n.x + (x.y - p[0].y) * n.y;
    const double z = n.z != 0.0 ? p[0].z - tilt / n.z : t->low.z;
    *height = greater(t->low.z, lesser(z, t->high.z));
    return true;
}

static bool is_within_bands(const struct region_surface *s, struct vec3 x)
{
    const struct vec3 at = half_plane(s, x);
    bool odd = false;
    for (int b = 0; b < s->n_bands; b++)
        odd ^= crosses_right_of(band_end(&s->bands[b], 0), band_end(&s->bands[b], 1), at);
    return odd;
}

bool region_surface_holds(const struct region_surface *s, struct vec3 x)
{
    if (s->n_bands > 0)
        return is_within_bands(s, x);
    const struct cells c = cells_of(s, x, x);
    bool odd = false;
    for (int k = c.low[2]; k < s->cells[2]; k++) {
        const int cell = cell_index(s, c.low[0], c.low[1], k);
        for (int l = s->begin[cell]; l < s->begin[cell + 1]; l++) {
            double z;
            /* A triangle stands in several cells but counts in that of its height. */
            if (meets(&s->triangles[s->list[l]], x, &z) && z > x.z &&
                cell_along(z, s->origin.z, s->cell, s->cells[2]) == k)
                odd = !odd;
        }
    }
    return odd;
}

static bool is_in_box(const struct region *region, struct vec3 x, double margin)
{
    const struct vec3 a = region->low, b = region->high;
    const bool *endless = region->endless;
    return (endless[0] || (x.x - a.x >= margin && b.x - x.x >= margin)) &&
           (endless[1] || (x.y - a.y >= margin && b.y - x.y >= margin)) &&
           (endless[2] || (x.z - a.z >= margin && b.z - x.z >= margin));
}

static bool is_in_cylinder(const struct region *region, struct vec3 x, double margin)
{
    const struct vec3 r = vec3_sub(x, region->centre);
    const double along = vec3_dot(r, region->axis);
    const struct vec3 aside = vec3_axpy(r, -along, region->axis);
    const bool endless = region->endless[0] || region->endless[1] || region->endless[2];
    return (endless || (along >= margin && region->length - along >= margin)) &&
           vec3_norm(aside) <= region->radius - margin;
}

bool region_contains(const struct region *region, struct vec3 x, double margin)
{
    switch (region->kind) {
    case JOB_REGION_BOX:
        return is_in_box(region, x, margin);
    case JOB_REGION_CYLINDER:
        return is_in_cylinder(region, x, margin);
    case JOB_REGION_SPHERE:
        return vec3_norm(vec3_sub(x, region->centre)) <= region->radius - margin;
    case JOB_REGION_INSIDE:
        return is_in_box(region, x, margin) &&
               !region_surface_is_near(region->surface, x, margin) &&
               region_surface_holds(region->surface, x);
    }
    return false;
}

/* The part of a way, from share first to share last of it, that is left of it. */
struct stretch {
    double first, last;
};

/* Cuts off where low <= from + share * along <= high does not hold. */
static void cut(struct stretch *stretch, double from, double along, double low, double high)
{
    const double a = (low - from) / along, b = (high - from) / along;
    if (along == 0.0 && !(from >= low && from <= high))
        stretch->last = -1.0;
    if (along == 0.0)
        return;
    stretch->first = greater(stretch->first, lesser(a, b));
    stretch->last = lesser(stretch->last, greater(a, b));
}

static bool meets_box(const struct region *region, struct vec3 from, struct vec3 way)
{
    const struct vec3 low = region->low, high = region->high;
    struct stretch stretch = {0.0, 1.0};
    cut(&stretch, from.x, way.x, low.x, high.x);
    cut(&stretch, from.y, way.y, low.y, high.y);
    cut(&stretch, from.z, way.z, low.z, high.z);
    return stretch.first <= stretch.last;
}

static bool meets_cylinder(const struct region *region, struct vec3 from, struct vec3 way)
{
    const struct vec3 r = vec3_sub(from, region->centre), axis = region->axis;
    const double at = vec3_dot(r, axis), along = vec3_dot(way, axis);
    const struct vec3 aside = vec3_axpy(r, -at, axis), across = vec3_axpy(way, -along, axis);
    struct stretch stretch = {0.0, 1.0};
    cut(&stretch, at, along, 0.0, region->length);
    return stretch.first <= stretch.last &&
           segment_distance(
               (struct vec3){0.0, 0.0, 0.0}, vec3_axpy(aside, stretch.first, across),
               vec3_axpy(aside, stretch.last, across)) <= region->radius * region->radius;
}

bool region_is_met(const struct region *region, struct vec3 x, struct vec3 way)
{
    const struct vec3 from = vec3_sub(x, way);
    if (region_contains(region, x, 0.0))
        return true;
    switch (region->kind) {
    case JOB_REGION_BOX:
        return meets_box(region, from, way);
    case JOB_REGION_CYLINDER:
        return meets_cylinder(region, from, way);
    case JOB_REGION_SPHERE:
        return segment_distance(region->centre, from, x) <= region->radius * region->radius;
    case JOB_REGION_INSIDE:
        return false;
    }
    return false;
}

static double between(double low, double high, double margin, double share)
{
    const double room = (high - low) - 2.0 * margin;
    return room > 0.0 ? (low + margin) + share * room : 0.5 * (low + high);
}

struct vec3 region_point(const struct region *region, double margin, uint64_t seed,
                         uint64_t stream, uint64_t attempt)
{
    const struct vec3 a = region->low, b = region->high;
    const double x = region->endless[0] ? 0.0 : margin, y = region->endless[1] ? 0.0 : margin;
    const double z = region->endless[2] ? 0.0 : margin;
    return (struct vec3){
        between(a.x, b.x, x, random_unit(seed, stream, 3 * attempt)),
        between(a.y, b.y, y, random_unit(seed, stream, 3 * attempt + 1)),
        between(a.z, b.z, z, random_unit(seed, stream, 3 * attempt + 2)),
    };
}

bool region_meets_solid(const struct region *region, const struct body *body)
{
    enum { POINTS = 2000 };
    int n = 0, n_inside = 0;
    if (!mesh_survey(&body->mesh).closed)
        return false;
    struct region_surface *surface = region_surface_build(&body->mesh, body->mesh.reference);
    for (uint64_t k = 0; k < POINTS; k++) {
        const struct vec3 x = region_point(region, 0.0, 0, 0, k);
        if (!region_contains(region, x, 0.0))
            continue;
        n++;
        n_inside += region_surface_holds(surface, x);
    }
    region_surface_destroy(surface);
    return 2 * n_inside <= n;
}
