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
/* Over the way to the nearest node: a node less deep than the first is not deep enough, what is
 * less deep than the second leaves no room. */
static const double SHALLOW = 0.2, NO_ROOM = 0.01;

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

/* What has been found that lies deepest below the faces around a vertex. */
struct deepest {
    double depth, way2; /* below them [m]; squared way from the vertex [m2] */
    int n, nodes[SOLID_BALL_INNER];
};

/* The node of the elements there that is deepest; of such the nearest, then the first.  Returns
 * the way to the nearest of all [m]. */
static double find_node(const struct solid_mesh *mesh, const struct mesh *skin,
                        const struct around *around, int vertex, int outer,
                        struct deepest *found)
{
    double shortest2 = (double)INFINITY;
    for (int m = around->begin[outer]; m < around->begin[outer + 1]; m++) {
        const int *corners = mesh->elements[around->list[m]];
        for (int k = 0; k < solid_mesh_n_corners(corners); k++) {
            const double depth = depth_below(skin, vertex, mesh->nodes[corners[k]]);
            const struct vec3 way = vec3_sub(mesh->nodes[corners[k]], mesh->nodes[outer]);
            const double way2 = vec3_dot(way, way), hair = 1e-9 * found->depth;
            if (corners[k] == outer)
                continue;
            shortest2 = way2 < shortest2 ? way2 : shortest2;
            if (depth > found->depth + hair ||
                (found->n > 0 && depth > found->depth - hair &&
                 (way2 < found->way2 || (way2 == found->way2 && corners[k] < found->nodes[0]))))
                *found = (struct deepest){depth, way2, 1, {corners[k]}};
        }
    }
    return sqrt(shortest2);
}

/* The middle of such an element, if that is deeper. */
static void find_middle(const struct solid_mesh *mesh, const struct mesh *skin,
                        const struct around *around, int vertex, int outer,
                        struct deepest *found)
{
    for (int m = around->begin[outer]; m < around->begin[outer + 1]; m++) {
        const int *corners = mesh->elements[around->list[m]];
        struct deepest middle = {.n = solid_mesh_n_corners(corners)};
        struct vec3 sum = {0.0, 0.0, 0.0};
        for (int k = 0; k < middle.n; k++) {
            middle.nodes[k] = corners[k];
            sum = vec3_add(sum, mesh->nodes[corners[k]]);
        }
        middle.depth = depth_below(skin, vertex, vec3_scale(1.0 / middle.n, sum));
        if (middle.depth > found->depth)
            *found = middle;
    }
}

static void place_ball(const struct solid_mesh *mesh, const struct mesh *skin,
                       const struct around *around, int vertex, struct solid_ball *ball)
{
    struct deepest found = {.depth = 0.0};
    const double shortest = find_node(mesh, skin, around, vertex, ball->outer, &found);
    if (!(found.depth > SHALLOW * shortest))
        find_middle(mesh, skin, around, vertex, ball->outer, &found);
    if (!(found.depth > NO_ROOM * shortest))
        return;
    ball->n_inner = found.n;
    for (int k = 0; k < found.n; k++)
        ball->inner[k] = found.nodes[k];
    ball->depth = found.depth < shortest ? found.depth : shortest;
    ball->radius = PART * ball->depth;
    ball->part = ball->radius / found.depth;
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

static bool has_sheet(const struct solid_mesh *mesh, const struct around *around, int node)
{
    for (int m = around->begin[node]; m < around->begin[node + 1]; m++)
        if (solid_mesh_is_sheet(mesh->elements[around->list[m]]))
            return true;
    return false;
}

struct solid_ball *solid_balls(const struct solid_mesh *mesh, const struct mesh *skin,
                               const int *nodes)
{
    struct solid_ball *balls = array_allocate((size_t)skin->n_corners, sizeof *balls);
    const struct around around = find_around(mesh);
    for (int v = 0; v < skin->n_corners; v++) {
        balls[v].outer = nodes[v];
        if (!has_sheet(mesh, &around, nodes[v]))
            place_ball(mesh, skin, &around, v, &balls[v]);
    }
    share_areas(skin, balls);
    free(around.begin);
    free(around.list);
    return balls;
}
