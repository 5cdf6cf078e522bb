/*
 * Shapes as facets, or as bands about an axis: see geometry.h.
 *
 * Facets of closed shapes face outwards.  Corners that facets share have the same coordinates
 * to the last bit, so the mesh joins them.
 *
 * Round shapes are lines in the half-plane beside their axis, turned about it.  A disc is cut
 * into strips, not into a fan: so no point of it has more than a few facets, whatever their
 * number.
 */
#include "model/geometry.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/elementary.h"
#include "base/report.h"
#include "job/job.h"
#include "model/mesh.h"
#include "model/skin.h"
#include "model/solid_mesh.h"

static const double PI = 3.14159265358979323846;
/* Around the skin of a curved surface: 0.1 % of the radius. */
enum { SKIN_SEGMENTS = 72 };

static void reserve(struct geometry *geometry, int n_vertices, int n_facets)
{
    geometry->vertices = array_allocate((size_t)n_vertices, sizeof *geometry->vertices);
    geometry->facets = array_allocate((size_t)n_facets, sizeof *geometry->facets);
}

static void add_quad(struct geometry *geometry, int a, int b, int c, int d)
{
    int *facet = geometry->facets[geometry->n_facets++];
    facet[0] = a;
    facet[1] = b;
    facet[2] = c;
    facet[3] = d;
}

static double magnitude(double x)
{
    return x < 0.0 ? -x : x;
}

/* A square about the point, its sides along the axes as far as the normal lets them. */
static void build_plane(struct geometry *geometry, const struct job_body *body)
{
    const struct vec3 n = vec3_scale(1.0 / vec3_norm(body->normal), body->normal);
    const struct vec3 along =
        magnitude(n.x) <= magnitude(n.y) || magnitude(n.x) <= magnitude(n.z)
            ? (struct vec3){1.0, 0.0, 0.0}
            : (struct vec3){0.0, 1.0, 0.0};
    const struct vec3 across = vec3_cross(n, along);
    const struct vec3 v = vec3_scale(0.5 * body->extent / vec3_norm(across), across);
    const struct vec3 u = vec3_cross(v, n);
    reserve(geometry, 4, 1);
    geometry->n_vertices = 4;
    geometry->vertices[0] = vec3_sub(vec3_sub(body->point, u), v);
    geometry->vertices[1] = vec3_sub(vec3_add(body->point, u), v);
    geometry->vertices[2] = vec3_add(vec3_add(body->point, u), v);
    geometry->vertices[3] = vec3_add(vec3_sub(body->point, u), v);
    add_quad(geometry, 0, 1, 2, 3);
}

/* Corner k of a box: bit 0 chooses x, bit 1 y, bit 2 z. */
static void build_box(struct geometry *geometry, const struct job_body *body)
{
    static const struct {
        enum job_side side;
        int corners[4];
    } walls[6] = {
        {JOB_SIDE_X_MIN, {0, 4, 6, 2}},  {JOB_SIDE_X_MAX, {1, 3, 7, 5}},
        {JOB_SIDE_Y_MIN, {0, 1, 5, 4}},  {JOB_SIDE_Y_MAX, {2, 6, 7, 3}},
        {JOB_SIDE_BOTTOM, {0, 2, 3, 1}}, {JOB_SIDE_TOP, {4, 5, 7, 6}},
    };
    reserve(geometry, 8, 6);
    geometry->n_vertices = 8;
    for (int k = 0; k < 8; k++)
        geometry->vertices[k] = (struct vec3){(k & 1) ? body->max.x : body->min.x,
                                              (k & 2) ? body->max.y : body->min.y,
                                              (k & 4) ? body->max.z : body->min.z};
    for (int w = 0; w < 6; w++) {
        const int *c = walls[w].corners;
        if (!(body->open & (int)walls[w].side))
            add_quad(geometry, c[0], c[1], c[2], c[3]);
    }
}

/* Four sloping quads from the outlet (vertices 0..3) to the top (4..7). */
static void build_hopper(struct geometry *geometry, const struct job_body *body)
{
    reserve(geometry, 8, 4);
    geometry->n_vertices = 8;
    for (int k = 0; k < 8; k++) {
        const double *width = k < 4 ? body->outlet : body->top;
        const double x = 0.5 * width[0], y = 0.5 * width[1];
        geometry->vertices[k] = (struct vec3){
            body->centre[0] + (k % 4 == 1 || k % 4 == 2 ? x : -x),
            body->centre[1] + (k % 4 >= 2 ? y : -y),
            k < 4 ? body->z[0] : body->z[1],
        };
    }
    for (int k = 0; k < 4; k++)
        add_quad(geometry, k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k);
}

/* ---- Round shapes
 * ----------------------------------------------------------------------------- */

static int add_point(struct geometry *geometry, double out, double up)
{
    geometry->points[geometry->n_points][0] = out;
    geometry->points[geometry->n_points][1] = up;
    return geometry->n_points++;
}

static void add_band(struct geometry *geometry, int from, int to)
{
    geometry->bands[geometry->n_bands][0] = from;
    geometry->bands[geometry->n_bands++][1] = to;
}

/* Outwards along the first cap, up the side, inwards along the second. */
static void profile_cone(struct geometry *geometry, double from, double to, double length,
                         int caps)
{
    const int low = add_point(geometry, from, 0.0), high = add_point(geometry, to, length);
    if ((caps & JOB_CAP_FROM) != 0 && from > 0.0)
        add_band(geometry, add_point(geometry, 0.0, 0.0), low);
    add_band(geometry, low, high);
    if ((caps & JOB_CAP_TO) != 0 && to > 0.0)
        add_band(geometry, high, add_point(geometry, 0.0, length));
}

static void profile_tube(struct geometry *geometry, double inner, double outer, double length)
{
    const double out[4] = {inner, outer, outer, inner}, up[4] = {0.0, 0.0, length, length};
    for (int k = 0; k < 4; k++) {
        add_point(geometry, out[k], up[k]);
        add_band(geometry, k, (k + 1) % 4);
    }
}

/* The first vertex of a point's circle; one on the axis has a single vertex. */
static int circle_of(const struct geometry *geometry, int point, int n)
{
    int first = 0;
    for (int p = 0; p < point; p++)
        first += geometry->points[p][0] > 0.0 ? n : 1;
    return first;
}

static void add_circles(struct geometry *geometry, int n)
{
    const struct vec3 u = geometry->direction;
    const struct vec3 other =
        u.x * u.x <= 0.5 ? (struct vec3){1.0, 0.0, 0.0} : (struct vec3){0.0, 1.0, 0.0};
    const struct vec3 across = vec3_axpy(other, -vec3_dot(other, u), u);
    const struct vec3 a = vec3_scale(1.0 / vec3_norm(across), across), b = vec3_cross(u, a);
    for (int p = 0; p < geometry->n_points; p++) {
        const double out = geometry->points[p][0];
        const struct vec3 middle = vec3_axpy(geometry->origin, geometry->points[p][1], u);
        for (int k = 0; k < (out > 0.0 ? n : 1); k++) {
            const double angle = 2.0 * PI * (double)k / (double)n;
            const struct vec3 arm =
                vec3_axpy(vec3_scale(elementary_cos(angle), a), elementary_sin(angle), b);
            geometry->vertices[geometry->n_vertices++] = vec3_axpy(middle, out, arm);
        }
    }
}

/* A circle's inside in strips; it faces along the axis, or against it. */
static void add_disc(struct geometry *geometry, int first, int n, bool against)
{
    for (int k = 0; 2 * k + 2 <= n; k++) {
        const int corners[4] = {k, k + 1, n - k - 1, k > 0 ? n - k : -1};
        int c[4], m = 0;
        for (int j = 0; j < 4; j++)
            if (corners[j] >= 0 && (m == 0 || corners[j] != corners[j - 1]))
                c[m++] = first + corners[j];
        if (m < 3)
            continue;
        const int last = m == 4 ? c[3] : -1;
        if (!against)
            add_quad(geometry, c[0], c[1], c[2], last);
        else if (m == 4)
            add_quad(geometry, c[3], c[2], c[1], c[0]);
        else
            add_quad(geometry, c[2], c[1], c[0], -1);
    }
}

/* What a line from point to point makes about the axis. */
static void add_side(struct geometry *geometry, const int ends[2], int n)
{
    const double *from = geometry->points[ends[0]], *to = geometry->points[ends[1]];
    const int p = circle_of(geometry, ends[0], n), q = circle_of(geometry, ends[1], n);
    if (from[1] == to[1] && (from[0] == 0.0 || to[0] == 0.0)) {
        add_disc(geometry, from[0] == 0.0 ? q : p, n, from[0] == 0.0);
        return;
    }
    for (int k = 0; k < n; k++) {
        const int next = (k + 1) % n;
        if (from[0] == 0.0)
            add_quad(geometry, p, q + next, q + k, -1);
        else if (to[0] == 0.0)
            add_quad(geometry, p + k, p + next, q, -1);
        else
            add_quad(geometry, p + k, p + next, q + next, q + k);
    }
}

static void build_round(struct geometry *geometry, const struct job_body *body)
{
    const bool hopper = body->geometry == JOB_GEOMETRY_CONICAL_HOPPER;
    const struct vec3 from =
        hopper ? (struct vec3){body->centre[0], body->centre[1], body->z[0]} : body->from;
    const struct vec3 to =
        hopper ? (struct vec3){body->centre[0], body->centre[1], body->z[1]} : body->to;
    const struct vec3 along = vec3_sub(to, from);
    const double length = vec3_norm(along);
    const int n = body->segments > 0 ? body->segments : SKIN_SEGMENTS;
    geometry->origin = from;
    geometry->direction = vec3_scale(1.0 / length, along);
    if (body->geometry == JOB_GEOMETRY_TUBE)
        profile_tube(geometry, body->inner, body->outer, length);
    else if (body->geometry == JOB_GEOMETRY_CYLINDER)
        profile_cone(geometry, body->radius, body->radius, length, body->caps);
    else
        profile_cone(geometry, body->radii[0], body->radii[1], length, body->caps);
    reserve(geometry, geometry->n_points * n, geometry->n_bands * n);
    add_circles(geometry, n);
    for (int b = 0; b < geometry->n_bands; b++)
        add_side(geometry, geometry->bands[b], n);
    if (body->segments > 0)
        geometry->n_bands = 0;
}

/* ---- Meshes
 * ----------------------------------------------------------------------------------- */

struct sweep { /* a vertex on its way past its neighbours */
    double key;
    int vertex;
};

static int compare_sweeps(const void *a, const void *b)
{
    const struct sweep *p = a, *q = b;
    if (p->key != q->key)
        return p->key < q->key ? -1 : 1;
    return (p->vertex > q->vertex) - (p->vertex < q->vertex);
}

/* Gives facets the same vertex where several are nearer to it than the tolerance.  Vertices are
 * swept along a direction in which hardly any two of a drawing lie level. */
static void merge_vertices(struct geometry *geometry, double tolerance)
{
    static const struct vec3 sweeping = {0.5317, 0.3141, 0.7865};
    const int n = geometry->n_vertices;
    struct sweep *kept = array_allocate((size_t)n, sizeof *kept);
    struct sweep *sweeps = array_allocate((size_t)n, sizeof *sweeps);
    int *same = array_allocate((size_t)n, sizeof *same), n_kept = 0;
    const double width = tolerance * vec3_norm(sweeping);
    for (int v = 0; v < n; v++)
        sweeps[v] = (struct sweep){vec3_dot(sweeping, geometry->vertices[v]), v};
    qsort(sweeps, (size_t)n, sizeof *sweeps, compare_sweeps);
    for (int k = 0; k < n; k++) {
        const int v = sweeps[k].vertex;
        same[v] = v;
        for (int j = n_kept - 1; j >= 0 && sweeps[k].key - kept[j].key <= width; j--) {
            const struct vec3 apart =
                vec3_sub(geometry->vertices[v], geometry->vertices[kept[j].vertex]);
            if (vec3_norm(apart) < tolerance) {
                same[v] = kept[j].vertex;
                break;
            }
        }
        if (same[v] == v)
            kept[n_kept++] = sweeps[k];
    }
    for (int f = 0; f < geometry->n_facets; f++)
        for (int k = 0; k < 4; k++)
            if (geometry->facets[f][k] >= 0)
                geometry->facets[f][k] = same[geometry->facets[f][k]];
    free(kept);
    free(sweeps);
    free(same);
}

static void build_mesh(struct geometry *geometry, const struct job_body *body)
{
    reserve(geometry, body->n_vertices, body->n_facets);
    geometry->n_vertices = body->n_vertices;
    geometry->n_facets = body->n_facets;
    for (int v = 0; v < body->n_vertices; v++)
        geometry->vertices[v] = body->vertices[v];
    for (int f = 0; f < body->n_facets; f++)
        memcpy(geometry->facets[f], body->facets[f], sizeof geometry->facets[f]);
    if (body->merge > 0.0)
        merge_vertices(geometry, body->merge);
}

/* ---- Any shape
 * -------------------------------------------------------------------------------- */

static struct vec3 turned(struct vec3 r, struct vec3 axis, double sine, double cosine)
{
    const struct vec3 along = vec3_scale(vec3_dot(axis, r) * (1.0 - cosine), axis);
    const struct vec3 across = vec3_scale(sine, vec3_cross(axis, r));
    return vec3_add(vec3_add(vec3_scale(cosine, r), across), along);
}

void geometry_place(const struct job_body *body, int n, struct vec3 *points)
{
    const double sine = elementary_sin(body->turn_angle);
    const double cosine = elementary_cos(body->turn_angle);
    const bool turns = vec3_norm(body->turn_axis) > 0.0, moves = vec3_norm(body->move) > 0.0;
    for (int k = 0; k < n; k++) {
        struct vec3 x = points[k];
        if (body->scale > 0.0)
            x = vec3_scale(body->scale, x);
        if (turns)
            x = vec3_add(body->turn_point,
                         turned(vec3_sub(x, body->turn_point), body->turn_axis, sine, cosine));
        if (moves)
            x = vec3_add(x, body->move);
        points[k] = x;
    }
}

/* The axis of a round shape, and its profile. */
static void place_profile(struct geometry *geometry, const struct job_body *body)
{
    geometry_place(body, 1, &geometry->origin);
    if (vec3_norm(body->turn_axis) > 0.0)
        geometry->direction =
            turned(geometry->direction, body->turn_axis, elementary_sin(body->turn_angle),
                   elementary_cos(body->turn_angle));
    for (int p = 0; p < geometry->n_points && body->scale > 0.0; p++) {
        geometry->points[p][0] = body->scale * geometry->points[p][0];
        geometry->points[p][1] = body->scale * geometry->points[p][1];
    }
}

void geometry_build_shape(struct geometry *geometry, const struct job_body *body)
{
    *geometry = (struct geometry){0};
    switch (body->geometry) {
    case JOB_GEOMETRY_PLANE:
        build_plane(geometry, body);
        return;
    case JOB_GEOMETRY_BOX:
        build_box(geometry, body);
        return;
    case JOB_GEOMETRY_HOPPER:
        build_hopper(geometry, body);
        return;
    case JOB_GEOMETRY_CYLINDER:
    case JOB_GEOMETRY_CONE:
    case JOB_GEOMETRY_CONICAL_HOPPER:
    case JOB_GEOMETRY_TUBE:
        build_round(geometry, body);
        return;
    case JOB_GEOMETRY_MESH:
    case JOB_GEOMETRY_STL:
    case JOB_GEOMETRY_GMSH:
        build_mesh(geometry, body);
        return;
    }
    CHECK(false, "unknown geometry %d", (int)body->geometry);
}

/* The surface of a body that deforms. */
static void build_skin(struct geometry *geometry, const struct job_body *body)
{
    struct solid_mesh own;
    struct skin skin;
    const struct solid_mesh *mesh = solid_mesh_borrow(body, &own);
    skin_build(&skin, mesh);
    reserve(geometry, skin.n_vertices, skin.n_facets);
    geometry->n_vertices = skin.n_vertices;
    geometry->n_facets = skin.n_facets;
    skin_place(&skin, mesh->nodes, geometry->vertices);
    for (int f = 0; f < skin.n_facets; f++)
        memcpy(geometry->facets[f], skin.facets[f], sizeof *skin.facets);
    skin_clear(&skin);
    solid_mesh_clear(&own);
}

void geometry_build(struct geometry *geometry, const struct job_body *body)
{
    *geometry = (struct geometry){0};
    if (job_deforms(body)) {
        build_skin(geometry, body);
        return;
    }
    geometry_build_shape(geometry, body);
    geometry_place(body, geometry->n_vertices, geometry->vertices);
    place_profile(geometry, body);
}

void geometry_clear(struct geometry *geometry)
{
    free(geometry->vertices);
    free(geometry->facets);
    *geometry = (struct geometry){0};
}

void geometry_build_mesh(struct mesh *mesh, const struct job_body *body)
{
    struct geometry g;
    geometry_build(&g, body);
    const struct mesh_profile profile = {g.n_points, g.n_bands, (const double(*)[2])g.points,
                                         (const int(*)[2])g.bands};
    if (g.n_bands > 0)
        mesh_build_round(mesh, &profile, g.origin, g.direction, g.n_vertices, g.vertices,
                         g.n_facets, (const int(*)[4])g.facets);
    else if (job_deforms(body))
        mesh_build_skin(mesh, g.n_vertices, g.vertices, g.n_facets, (const int(*)[4])g.facets);
    else
        mesh_build(mesh, g.n_vertices, g.vertices, g.n_facets, (const int(*)[4])g.facets);
    geometry_clear(&g);
}
