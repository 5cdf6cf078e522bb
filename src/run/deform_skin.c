/* See deform_skin.h. */
#include "run/deform_skin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "run/simulation.h"

void deform_skin_init(struct deform_skin *skin, const struct solid_mesh *mesh,
                      const struct body *body)
{
    const size_t n_vertices = (size_t)body->mesh.n_vertices;
    *skin = (struct deform_skin){.n_points = body->mesh.n_corners};
    skin_build(&skin->shape, mesh);
    CHECK(skin->shape.n_vertices == body->mesh.n_corners, "a skin of %d vertices",
          skin->shape.n_vertices);
    skin->nodes = array_allocate((size_t)skin->n_points, sizeof *skin->nodes);
    if (skin->n_points > 0)
        memcpy(skin->nodes, skin->shape.nodes, (size_t)skin->n_points * sizeof *skin->nodes);
    skin->vertices = array_allocate(n_vertices, sizeof *skin->vertices);
    skin->is_here = array_allocate(n_vertices, sizeof *skin->is_here);
    skin->faces = array_allocate((size_t)body->mesh.n_faces, sizeof *skin->faces);
    skin->sheets = array_allocate((size_t)skin->shape.n_sheets, sizeof *skin->sheets);
    skin->normals = array_allocate((size_t)skin->shape.n_sheets, sizeof *skin->normals);
    skin->rings = array_allocate((size_t)skin->shape.n_rings, sizeof *skin->rings);
    skin->arms = array_allocate((size_t)skin->shape.n_rings, sizeof *skin->arms);
}

void deform_skin_clear(struct deform_skin *skin)
{
    skin_clear(&skin->shape);
    free(skin->nodes);
    free(skin->vertices);
    free(skin->is_here);
    free(skin->faces);
    free(skin->sheets);
    free(skin->normals);
    free(skin->rings);
    free(skin->arms);
    *skin = (struct deform_skin){0};
}

void deform_skin_add(struct deform_skin *skin, struct body *body, int n_nodes, int n,
                     const int *nodes, int *points)
{
    const size_t had = (size_t)skin->n_points, most = had + (size_t)n;
    int *point = array_allocate((size_t)n_nodes, sizeof *point); /* of each node, from 1 */
    skin->nodes = array_resize(skin->nodes, had, most, sizeof *skin->nodes);
    for (int p = 0; p < skin->n_points; p++)
        point[skin->nodes[p]] = p + 1;
    for (int k = 0; k < n; k++) {
        points[k] = -1;
        if (nodes[k] < 0)
            continue;
        if (point[nodes[k]] == 0) {
            skin->nodes[skin->n_points++] = nodes[k];
            point[nodes[k]] = skin->n_points;
        }
        points[k] = point[nodes[k]] - 1;
    }
    body->skin->force = array_resize_rows(body->skin->force, had, (size_t)skin->n_points,
                                          sizeof *body->skin->force);
    body->skin->pushed = array_resize(body->skin->pushed, had, (size_t)skin->n_points,
                                      sizeof *body->skin->pushed);
    free(point);
}

static struct vec3 vec3_of(const double *lane)
{
    return (struct vec3){lane[0], lane[1], lane[2]};
}

/* Arms of the sheets that are here. */
static void turn_arms(const struct deform_body *deform)
{
    const struct deform_skin *skin = &deform->skin;
    const size_t stride = sizeof *deform->solid.node / sizeof(double);
    for (int k = 0; k < skin->n_sheets; k++)
        skin->normals[skin->sheets[k]] =
            skin_normal(&skin->shape.sheets[skin->sheets[k]], deform->solid.node->lane, stride);
    for (int k = 0; k < skin->n_rings; k++)
        skin->arms[skin->rings[k]] = skin_arm(&skin->shape, skin->rings[k], skin->normals);
}

/* From the vertex's node to it [m]. */
static struct vec3 arm_of(const struct deform_skin *skin, int v)
{
    bool below;
    const int ring = skin_ring_of(&skin->shape, v, &below);
    if (ring < 0)
        return (struct vec3){0.0, 0.0, 0.0};
    return vec3_scale(below ? -1.0 : 1.0, skin->arms[ring]);
}

static struct vec3 place_of(const struct deform_body *deform, int v)
{
    return vec3_add(vec3_of(solid_place(&deform->solid, deform->skin.nodes[v])),
                    arm_of(&deform->skin, v));
}

static double faster(double speed2_max, struct vec3 velocity)
{
    const double speed2 = vec3_dot(velocity, velocity);
    return speed2 > speed2_max ? speed2 : speed2_max;
}

/* Puts vertices of nodes where these are; returns the largest square of their speeds. */
static double place_plain(const struct deform_body *deform, const struct body *body)
{
    const struct deform_skin *skin = &deform->skin;
    double speed2_max = 0.0;
    for (int k = 0; k < skin->n_plain; k++) {
        const int v = skin->vertices[k], node = skin->nodes[v];
        body->mesh.place[v] = vec3_of(solid_place(&deform->solid, node));
        body->skin->velocity[v] = vec3_of(solid_velocity(&deform->solid, node));
        speed2_max = faster(speed2_max, body->skin->velocity[v]);
    }
    return speed2_max;
}

/* The same of vertices above and below nodes of sheets. */
static double place_rings(const struct deform_body *deform, const struct body *body)
{
    const struct deform_skin *skin = &deform->skin;
    const struct solid_turns *turns = &deform->solid.turns;
    struct vec3 *place = body->mesh.place, *velocity = body->skin->velocity;
    double speed2_max = 0.0;
    for (int k = 0; k < skin->n_rings; k++) {
        const int ring = skin->rings[k], node = skin->shape.rings[ring].node;
        const int above = skin_above(&skin->shape, ring);
        const struct vec3 arm = skin->arms[ring];
        const struct vec3 at = vec3_of(solid_place(&deform->solid, node));
        const struct vec3 drift = vec3_of(solid_velocity(&deform->solid, node));
        struct vec3 swing = {0.0, 0.0, 0.0};
        if (turns->n_nodes > 0)
            swing = vec3_cross(vec3_of(solid_turn_spin(turns, node)), arm);
        place[above] = vec3_add(at, arm);
        velocity[above] = vec3_add(drift, swing);
        speed2_max = faster(speed2_max, velocity[above]);
        if (ring >= skin->shape.n_both)
            continue;
        place[above + 1] = vec3_sub(at, arm);
        velocity[above + 1] = vec3_sub(drift, swing);
        speed2_max = faster(speed2_max, velocity[above + 1]);
    }
    return speed2_max;
}

void deform_skin_place(const struct deform_body *deform, struct body *body)
{
    turn_arms(deform);
    const double plain = place_plain(deform, body), rings = place_rings(deform, body);
    body->skin->now++;
    body->speed_max = sqrt(plain > rings ? plain : rings);
}

void deform_skin_place_faces(const struct deform_body *deform, const struct body *body)
{
    for (int k = 0; k < deform->skin.n_faces; k++)
        body_renew_face(body, deform->skin.faces[k]);
}

/* Adds up what pushes a node: several vertices may be its own, in the order of their numbers.
 * */
static void take_force(struct solid *solid, int node, struct vec3 arm,
                       const struct exact_vector *force)
{
    double f[3];
    exact_vector_value(force, f);
    const struct vec3 moment = vec3_cross(arm, vec3_of(f));
    for (int x = 0; x < 3; x++)
        solid->contact[node][x] += f[x];
    if (solid->turns.n_nodes == 0 || !(solid->turns.inertia[node] > 0.0))
        return;
    solid->turns.contact[node][0] += moment.x;
    solid->turns.contact[node][1] += moment.y;
    solid->turns.contact[node][2] += moment.z;
}

void deform_skin_take_forces(struct deform_body *deform, const struct body *body)
{
    const struct deform_skin *skin = &deform->skin;
    struct solid *solid = &deform->solid;
    for (int p = 0; p < skin->n_points; p++) {
        if (!body->skin->pushed[p])
            continue;
        if (solid->moves[skin->nodes[p]])
            take_force(solid, skin->nodes[p],
                       p < body->mesh.n_corners ? arm_of(skin, p)
                                                : (struct vec3){0.0, 0.0, 0.0},
                       &body->skin->force[p]);
        body->skin->force[p] = (struct exact_vector){{{0}}};
        body->skin->pushed[p] = false;
    }
}

/* A face without a normal is not found, wherever its borders may be. */
static void place_nowhere(struct mesh *mesh)
{
    const struct vec3 none = {(double)NAN, (double)NAN, (double)NAN};
    for (int v = 0; v < mesh->n_vertices; v++)
        mesh->place[v] = none;
    for (int f = 0; f < mesh->n_faces; f++)
        mesh->face_normal[f] = none;
}

void deform_skin_forget(const struct deform_skin *skin, struct mesh *mesh)
{
    bool *keep = array_allocate((size_t)mesh->n_faces, sizeof *keep);
    for (int k = 0; k < skin->n_faces; k++)
        keep[skin->faces[k]] = true;
    array_forget(mesh->face_borders, (size_t)mesh->n_faces, sizeof *mesh->face_borders, keep);
    free(keep);
}

static bool has_sheet(const struct deform_body *deform, int s)
{
    const int *corners = deform->skin.shape.sheets[s].corners;
    for (int c = 0; c < 4 && corners[c] >= 0; c++)
        if (!deform_share_has(deform, corners[c]))
            return false;
    return true;
}

static void list_rings(struct deform_body *deform)
{
    struct deform_skin *skin = &deform->skin;
    const struct skin *shape = &skin->shape;
    bool *here = array_allocate((size_t)shape->n_sheets, sizeof *here);
    skin->n_sheets = skin->n_rings = 0;
    for (int s = 0; s < shape->n_sheets; s++) {
        here[s] = has_sheet(deform, s);
        if (here[s])
            skin->sheets[skin->n_sheets++] = s;
    }
    for (int r = 0; r < shape->n_rings; r++) {
        bool all = true;
        for (int k = shape->rings[r].begin; k < shape->rings[r].end; k++)
            all = all && here[shape->around[k]];
        memset(skin->is_here + skin_above(shape, r), all, r < shape->n_both ? 2 : 1);
        if (all)
            skin->rings[skin->n_rings++] = r;
    }
    free(here);
}

static void list_vertices(struct deform_body *deform, const struct mesh *mesh)
{
    const struct deform_skin *skin = &deform->skin;
    for (int v = 0; v < skin->shape.n_plain; v++)
        skin->is_here[v] = deform_share_has(deform, skin->nodes[v]);
    list_rings(deform);
    for (int v = mesh->n_corners; v < mesh->n_vertices; v++) {
        skin->is_here[v] = 1;
        for (int k = 0; k < 4; k++)
            skin->is_here[v] &= skin->is_here[mesh->mean_of[v - mesh->n_corners][k]];
    }
}

void deform_skin_renew(struct deform_body *deform, struct body *body)
{
    struct deform_skin *skin = &deform->skin;
    struct mesh *mesh = &body->mesh;
    list_vertices(deform, mesh);
    skin->n_vertices = skin->n_plain = skin->n_faces = 0;
    for (int v = 0; v < mesh->n_vertices; v++) {
        if (skin->is_here[v] == 0)
            continue;
        skin->vertices[skin->n_vertices++] = v;
        skin->n_plain += v < skin->shape.n_plain;
    }
    for (int f = 0; f < mesh->n_faces; f++) {
        const int *v = mesh->faces[f].vertices;
        if (skin->is_here[v[0]] & skin->is_here[v[1]] & skin->is_here[v[2]])
            skin->faces[skin->n_faces++] = f;
    }
    if (skin->n_vertices < mesh->n_vertices)
        place_nowhere(mesh);
    deform_skin_place(deform, body);
    deform_skin_place_faces(deform, body);
}

/* ---- As a whole
 * ------------------------------------------------------------------------------- */

/* Where each rank's corners begin among all of them, rank by rank; returns their sizes. */
static int *measure(const struct deform_body *deform, const struct comm *comm, int n_corners,
                    int *begin)
{
    int *sizes = array_allocate((size_t)comm->n_ranks, sizeof *sizes);
    for (int v = 0; v < n_corners; v++)
        sizes[deform->share.owner[deform->skin.nodes[v]]]++;
    for (int q = 0, n = 0; q < comm->n_ranks; q++) {
        begin[q] = n;
        n += sizes[q];
        sizes[q] *= (int)sizeof(struct vec3);
    }
    return sizes;
}

static void show(const struct deform_body *deform, const struct comm *comm,
                 const struct body *body)
{
    const struct mesh *mesh = &body->mesh;
    struct vec3 *places = array_allocate((size_t)mesh->n_corners, sizeof *places);
    int *next = array_allocate((size_t)comm->n_ranks, sizeof *next);
    int *sizes = measure(deform, comm, mesh->n_corners, next);
    int own = next[comm->rank];
    for (int v = 0; v < mesh->n_corners; v++)
        if (deform->share.owner[deform->skin.nodes[v]] == comm->rank)
            places[own++] = place_of(deform, v);
    comm_gather_parts(comm, places, sizes);
    for (int v = 0; v < mesh->n_corners; v++)
        mesh->place[v] = places[next[deform->share.owner[deform->skin.nodes[v]]]++];
    body->skin->now++;
    for (int f = 0; f < mesh->n_faces; f++)
        body_renew_face(body, f);
    free(places);
    free(next);
    free(sizes);
}

void deform_skin_show(struct simulation *sim)
{
    for (int k = 0; sim->comm->n_ranks > 1 && k < sim->deform.n; k++)
        show(&sim->deform.list[k], sim->comm, &sim->bodies.list[sim->deform.list[k].body]);
}

void deform_skin_hide(struct simulation *sim)
{
    for (int k = 0; sim->comm->n_ranks > 1 && k < sim->deform.n; k++) {
        struct body *body = &sim->bodies.list[sim->deform.list[k].body];
        place_nowhere(&body->mesh);
        deform_skin_forget(&sim->deform.list[k].skin, &body->mesh);
        deform_skin_place(&sim->deform.list[k], body);
        deform_skin_place_faces(&sim->deform.list[k], body);
    }
}
