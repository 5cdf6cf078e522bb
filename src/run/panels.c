/*
 * See panels.h.  Distances are taken at some thousand points, straight through space; of many
 * borders some are left out.  That is enough for an estimate, and quick on any surface.
 */
#include "run/panels.h"

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/elementary.h"
#include "base/groups.h"
#include "model/mesh.h"

/* Beyond 30 degrees a fold holds; facets of round walls meet at less. */
static const double FOLD = 3.14159265358979323846 / 6.0;

enum { POINTS = 4000, HOLDERS = 4000 };

/* ------------------------------------------------------------------------------- folds */

static struct vec3 unit(struct vec3 a)
{
    const double length = vec3_norm(a);
    return length > 0.0 ? vec3_scale(1.0 / length, a) : a;
}

/* Into a face from one of its edges, a unit vector. */
static struct vec3 inward(const struct mesh *mesh, int f, int e)
{
    const struct mesh_face *face = &mesh->faces[f];
    for (int k = 0; k < face->n; k++)
        if (face->edges[k] == e)
            return unit(mesh->face_borders[f][k].inward);
    return (struct vec3){0.0, 0.0, 0.0};
}

/* By how much the surface turns at an edge of two faces, whichever way they look [rad]. */
static double turn_at(const struct mesh *mesh, int e)
{
    const struct mesh_edge *edge = &mesh->edges[e];
    const struct vec3 a = inward(mesh, edge->faces[0], e), b = inward(mesh, edge->faces[1], e);
    return elementary_atan2(vec3_norm(vec3_cross(a, b)), -vec3_dot(a, b));
}

static bool goes_on(const struct mesh *mesh, int e)
{
    return mesh->edges[e].n_faces == 2 && turn_at(mesh, e) < FOLD;
}

/* The panel of each face; returns how many there are. */
static int number_faces(const struct mesh *mesh, int *panel_of)
{
    int n = 0;
    int *same = groups_apart(mesh->n_faces);
    for (int e = 0; e < mesh->n_edges; e++)
        if (goes_on(mesh, e))
            (void)groups_join(same, mesh->edges[e].faces[0], mesh->edges[e].faces[1]);
    for (int f = 0; f < mesh->n_faces; f++) {
        const int first = groups_first(same, f);
        panel_of[f] = first == f ? n++ : panel_of[first];
    }
    free(same);
    return n;
}

/* --------------------------------------------------------------------------- distances */

static double distance_squared(struct vec3 x, struct vec3 a, struct vec3 b)
{
    const struct vec3 way = vec3_sub(b, a), from = vec3_sub(x, a);
    const double length = vec3_dot(way, way), along = vec3_dot(from, way);
    const double part = !(length > 0.0) || along < 0.0 ? 0.0
                        : along > length               ? 1.0
                                                       : along / length;
    const struct vec3 off = vec3_axpy(from, -part, way);
    return vec3_dot(off, off);
}

/* Pieces of edges, or points that are both of their ends. */
struct holder {
    struct vec3 ends[2];
};

/* From a point to the nearest of n; infinite without any. */
static double nearest_squared(struct vec3 x, int n, const struct holder *holders)
{
    double least = (double)INFINITY;
    for (int k = 0; k < n; k++) {
        const double d2 = distance_squared(x, holders[k].ends[0], holders[k].ends[1]);
        least = d2 < least ? d2 : least;
    }
    return least;
}

/* Some of the points, as holders; returns how many. */
static int hold_points(struct holder *holders, int n, const struct vec3 *points)
{
    const int stride = 1 + n / HOLDERS;
    int count = 0;
    for (int k = 0; k < n; k += stride)
        holders[count++] = (struct holder){{points[k], points[k]}};
    return count;
}

double panels_farthest(int n, const struct vec3 *points, int n_held, const struct vec3 *held)
{
    struct holder *holders = array_allocate((size_t)n_held, sizeof *holders);
    const int n_holders = hold_points(holders, n_held, held);
    const int stride = 1 + n / POINTS;
    double most = 0.0;
    for (int k = 0; k < n && n_held > 0; k += stride) {
        const double d2 = nearest_squared(points[k], n_holders, holders);
        most = d2 > most ? d2 : most;
    }
    free(holders);
    return sqrt(most);
}

/* ------------------------------------------------------------------------------- panels */

/* Who holds the panels: those of panel p are begin[p] .. begin[p+1]-1. */
struct borders {
    int *begin;
    struct holder *list;
};

static bool holds(const struct mesh *mesh, int e, bool rims_hold)
{
    return mesh->edges[e].n_faces == 1 ? rims_hold : !goes_on(mesh, e);
}

/* Sorts the borders by panel, those of an edge to both its sides. */
static void borders_find(struct borders *borders, const struct mesh *mesh, int n,
                         const int *panel_of, bool rims_hold)
{
    borders->begin = array_allocate((size_t)n + 2, sizeof *borders->begin);
    borders->list = array_allocate(2 * (size_t)mesh->n_edges, sizeof *borders->list);
    for (int round = 0; round < 2; round++) { /* first they are counted */
        for (int e = 0; e < mesh->n_edges; e++) {
            const struct mesh_edge *edge = &mesh->edges[e];
            const struct holder holder = {
                {mesh->reference[edge->vertices[0]], mesh->reference[edge->vertices[1]]}};
            for (int k = 0; k < 2 && holds(mesh, e, rims_hold); k++) {
                if (edge->faces[k] < 0)
                    continue;
                int *at = &borders->begin[panel_of[edge->faces[k]] + 2 - round];
                if (round == 1)
                    borders->list[*at] = holder;
                ++*at;
            }
        }
        for (int p = 0; p < n && round == 0; p++)
            borders->begin[p + 2] += borders->begin[p + 1];
    }
}

/* Point i, j of a grid within a face. */
static struct vec3 point_of(const struct mesh *mesh, int f, double u, double v)
{
    const struct mesh_face *face = &mesh->faces[f];
    const struct vec3 a = mesh->reference[face->vertices[0]],
                      b = mesh->reference[face->vertices[1]],
                      c = mesh->reference[face->vertices[2]],
                      d = face->n == 4 ? mesh->reference[face->vertices[3]] : c;
    const struct vec3 below = vec3_axpy(a, u, vec3_sub(b, a)),
                      above = vec3_axpy(d, u, vec3_sub(c, d));
    return vec3_axpy(below, v, vec3_sub(above, below));
}

/* Grows the span of each panel to twice the distance of its farthest point. */
static void measure_spans(struct panels *panels, const struct mesh *mesh, const int *panel_of,
                          const struct borders *borders, int n_held, const struct holder *held)
{
    const int stride = 1 + mesh->n_faces / POINTS;
    int grid = 1;
    while (mesh->n_faces * (grid + 2) * (grid + 2) <= POINTS && grid < 63)
        grid += 2; /* odd, so that the middle is among them */
    for (int f = 0; f < mesh->n_faces; f += stride) {
        struct panel *panel = &panels->list[panel_of[f]];
        const int from = borders->begin[panel_of[f]], to = borders->begin[panel_of[f] + 1];
        if (from == to && n_held == 0)
            continue;
        for (int k = 0; k < grid * grid; k++) {
            const struct vec3 x =
                point_of(mesh, f, (k % grid + 0.5) / grid, (double)(k / grid + 0.5) / grid);
            const double own = nearest_squared(x, to - from, &borders->list[from]);
            const double other = nearest_squared(x, n_held, held);
            const double span = 2.0 * sqrt(own < other ? own : other);
            panel->span = span > panel->span ? span : panel->span;
        }
    }
}

static void add_faces(struct panels *panels, const struct mesh *mesh, const int *panel_of)
{
    for (int f = 0; f < mesh->n_faces; f++) {
        struct panel *panel = &panels->list[panel_of[f]];
        const int *v = mesh->faces[f].vertices;
        struct vec3 sum = {0.0, 0.0, 0.0};
        for (int k = 2; k < mesh->faces[f].n; k++)
            sum = vec3_add(
                sum, vec3_cross(vec3_sub(mesh->reference[v[k - 1]], mesh->reference[v[0]]),
                                vec3_sub(mesh->reference[v[k]], mesh->reference[v[0]])));
        const double area = 0.5 * vec3_norm(sum);
        panel->n_faces++;
        panel->area += area;
        panel->normal = vec3_axpy(panel->normal, 0.5, sum);
    }
    for (int e = 0; e < mesh->n_edges; e++) {
        const struct mesh_edge *edge = &mesh->edges[e];
        if (!goes_on(mesh, e))
            continue;
        const struct vec3 along =
            vec3_sub(mesh->reference[edge->vertices[1]], mesh->reference[edge->vertices[0]]);
        panels->list[panel_of[edge->faces[0]]].curvature += turn_at(mesh, e) * vec3_norm(along);
    }
    for (int p = 0; p < panels->n; p++) {
        struct panel *panel = &panels->list[p];
        panel->curvature /= panel->area;
        panel->normal = vec3_scale(1.0 / panel->area, panel->normal);
    }
}

void panels_find(struct panels *panels, const struct mesh *mesh, bool rims_hold, int n_held,
                 const struct vec3 *held)
{
    struct borders borders;
    int *panel_of = array_allocate((size_t)mesh->n_faces, sizeof *panel_of);
    struct holder *holders = array_allocate((size_t)n_held, sizeof *holders);
    const int n_holders = hold_points(holders, n_held, held);
    panels->n = number_faces(mesh, panel_of);
    panels->list = array_allocate((size_t)panels->n, sizeof *panels->list);
    add_faces(panels, mesh, panel_of);
    borders_find(&borders, mesh, panels->n, panel_of, rims_hold);
    measure_spans(panels, mesh, panel_of, &borders, n_holders, holders);
    free(borders.begin);
    free(borders.list);
    free(holders);
    free(panel_of);
}

void panels_clear(struct panels *panels)
{
    free(panels->list);
    *panels = (struct panels){0};
}
