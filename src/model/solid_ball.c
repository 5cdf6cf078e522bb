/* Balls below the surface: see solid_ball.h. */
#include "model/solid_ball.h"

#include <stdlib.h>

#include "base/array.h"
#include "base/vec3.h"
#include "model/mesh.h"
#include "model/solid_mesh.h"

/* A ball's radius over the depth of the inner node, or over the way to the nearest one if that
 * is less: deep enough for what a node may be pressed in, and within its elements. */
static const double PART = 1.0 / 3.0;

/* Elements at each node: list[begin[i] .. begin[i + 1] - 1]. */
struct around {
    int *begin, *list;
};

static struct around find_around(const struct solid_mesh *mesh)
{
    struct around around;
    around.begin = array_allocate((size_t)mesh->n_nodes + 2, sizeof *around.begin);
    around.list = array_allocate(8 * (size_t)mesh->n_elements, sizeof *around.list);
    for (int e = 0; e < mesh->n_elements; e++)
        for (int k = 0; k < solid_mesh_n_corners(mesh->elements[e]); k++)
            around.begin[mesh->elements[e][k] + 2]++;
    for (int i = 0; i < mesh->n_nodes; i++)
        around.begin[i + 2] += around.begin[i + 1];
    for (int e = 0; e < mesh->n_elements; e++)
        for (int k = 0; k < solid_mesh_n_corners(mesh->elements[e]); k++)
            around.list[around.begin[mesh->elements[e][k] + 1]++] = e;
    return around;
}

/* How far a point is below the faces around a vertex, at least [m]. */
static double depth_below(const struct mesh *skin, int vertex, struct vec3 point)
{
    const struct vec3 arm = vec3_sub(skin->reference[vertex], point);
    double least = (double)INFINITY;
    for (int k = skin->edge_begin[vertex]; k < skin->edge_begin[vertex + 1]; k++) {
        const struct mesh_edge *edge = &skin->edges[skin->edge_list[k]];
        for (int side = 0; side < 2 && edge->faces[side] >= 0; side++) {
            const double depth = vec3_dot(arm, skin->face_normal[edge->faces[side]]);
            least = depth < least ? depth : least;
        }
    }
    return least;
}

/* Between the outer node and the node of an element there that lies deepest below the faces; of
 * such the nearest, then the first. */
static void place_ball(const struct solid_mesh *mesh, const struct mesh *skin,
                       const struct around *around, int vertex, struct solid_ball *ball)
{
    double deepest = 0.0, nearest2 = 0.0, shortest2 = (double)INFINITY;
    ball->inner = -1;
    for (int m = around->begin[ball->outer]; m < around->begin[ball->outer + 1]; m++) {
        const int *corners = mesh->elements[around->list[m]];
        for (int k = 0; k < solid_mesh_n_corners(corners); k++) {
            const double depth = depth_below(skin, vertex, mesh->nodes[corners[k]]);
            const struct vec3 way = vec3_sub(mesh->nodes[corners[k]], mesh->nodes[ball->outer]);
            const double way2 = vec3_dot(way, way), hair = 1e-9 * deepest;
            shortest2 = corners[k] != ball->outer && way2 < shortest2 ? way2 : shortest2;
            const bool is_better =
                depth > deepest + hair ||
                (ball->inner >= 0 && depth > deepest - hair &&
                 (way2 < nearest2 || (way2 == nearest2 && corners[k] < ball->inner)));
            if (!is_better)
                continue;
            ball->inner = corners[k];
            deepest = depth;
            nearest2 = way2;
        }
    }
    const double shortest = sqrt(shortest2);
    ball->radius = PART * (deepest < shortest ? deepest : shortest);
    ball->part = ball->inner >= 0 ? ball->radius / deepest : 0.0;
}

/* A third of a face belongs to each of its vertices; a mean point passes its own on. */
static void share_areas(const struct mesh *skin, struct solid_ball *balls)
{
    for (int f = 0; f < skin->n_faces; f++) {
        const int *v = skin->faces[f].vertices;
        const struct vec3 area =
            vec3_cross(vec3_sub(skin->reference[v[1]], skin->reference[v[0]]),
                       vec3_sub(skin->reference[v[2]], skin->reference[v[0]]));
        const double third = vec3_norm(area) / 6.0;
        for (int k = 0; k < 3; k++) {
            if (v[k] < skin->n_corners)
                balls[v[k]].area += third;
            for (int m = 0; m < 4 && v[k] >= skin->n_corners; m++)
                balls[skin->mean_of[v[k] - skin->n_corners][m]].area += 0.25 * third;
        }
    }
}

struct solid_ball *solid_balls(const struct solid_mesh *mesh, const struct mesh *skin,
                               const int *nodes)
{
    struct solid_ball *balls = array_allocate((size_t)skin->n_corners, sizeof *balls);
    const struct around around = find_around(mesh);
    for (int v = 0; v < skin->n_corners; v++) {
        balls[v].outer = nodes[v];
        place_ball(mesh, skin, &around, v, &balls[v]);
    }
    share_areas(skin, balls);
    free(around.begin);
    free(around.list);
    return balls;
}
