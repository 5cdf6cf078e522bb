/*
 * Rigid bodies and their prescribed motion: see body.h.
 *
 * A body's vertices follow from its reference mesh and the time alone; nothing is accumulated,
 * so a restart, or a rank that meets the body late, finds the same bits.  The rotation is
 * Rodrigues' formula about the pivot; the pivot travels with the translation.
 */
#include "model/body.h"

#include <stdlib.h>

#include "base/array.h"
#include "base/elementary.h"
#include "job/job.h"
#include "model/geometry.h"

/* How long the motion has lasted at a time [s]. */
static double moving_time(const struct body *body, double time)
{
    const double until = time < body->stop ? time : body->stop;
    return until > body->start ? until - body->start : 0.0;
}

static bool is_moving(const struct body *body, double time)
{
    return time > body->start && time < body->stop;
}

/* r turned by an angle about an axis of length 1 (Rodrigues). */
static struct vec3 turned(struct vec3 r, struct vec3 axis, double sine, double cosine)
{
    const struct vec3 along = vec3_scale(vec3_dot(axis, r) * (1.0 - cosine), axis);
    const struct vec3 across = vec3_scale(sine, vec3_cross(axis, r));
    return vec3_add(vec3_add(vec3_scale(cosine, r), across), along);
}

static void place_vertices(struct body *body, double duration)
{
    struct mesh *mesh = &body->mesh;
    const double angle = body->rate * duration;
    const double sine = elementary_sin(angle), cosine = elementary_cos(angle);
    const struct vec3 shift = vec3_scale(duration, body->velocity);
    for (int v = 0; v < mesh->n_vertices; v++) {
        struct vec3 x = mesh->reference[v];
        if (body->rate != 0.0)
            x = vec3_add(body->pivot,
                         turned(vec3_sub(x, body->pivot), body->axis, sine, cosine));
        mesh->place[v] = vec3_add(x, shift);
    }
    body->pivot_now = vec3_add(body->pivot, shift);
    body->placed_for = duration;
    mesh_update(mesh);
}

/* No vertex is ever faster than the translation and the rotation of the farthest one together.
 */
static double fastest(const struct body *body)
{
    double arm = 0.0; /* [m] */
    for (int v = 0; v < body->mesh.n_vertices; v++) {
        const struct vec3 r = vec3_sub(body->mesh.reference[v], body->pivot);
        const double across = vec3_norm(vec3_cross(body->axis, r));
        arm = across > arm ? across : arm;
    }
    const double spin = body->rate < 0.0 ? -body->rate : body->rate;
    return vec3_norm(body->velocity) + spin * arm;
}

static void body_build(struct body *body, const struct job_body *asked)
{
    struct geometry geometry;
    geometry_build(&geometry, asked);
    *body = (struct body){
        .name = array_string(asked->name),
        .material = asked->material,
        .velocity = asked->velocity,
        .pivot = asked->pivot,
        .axis = asked->axis,
        .rate = vec3_norm(asked->axis) > 0.0 ? asked->rate : 0.0,
        .start = asked->start,
        .stop = asked->stop,
        .pivot_now = asked->pivot,
        .placed_for = 0.0,
    };
    mesh_build(&body->mesh, geometry.n_vertices, geometry.vertices, geometry.n_facets,
               (const int(*)[4])geometry.facets);
    geometry_clear(&geometry);
    body->speed_max = fastest(body);
    body->moves = body->speed_max > 0.0 && body->stop > body->start;
    if (!body->moves)
        body->speed_max = 0.0;
}

void bodies_build(struct bodies *bodies, const struct job *job)
{
    bodies->n = job->n_bodies;
    bodies->list = array_allocate((size_t)job->n_bodies, sizeof *bodies->list);
    for (int b = 0; b < bodies->n; b++)
        body_build(&bodies->list[b], &job->bodies[b]);
    bodies_place(bodies, 0, 0.0);
}

void bodies_clear(struct bodies *bodies)
{
    for (int b = 0; b < bodies->n; b++) {
        free(bodies->list[b].name);
        mesh_clear(&bodies->list[b].mesh);
    }
    free(bodies->list);
    *bodies = (struct bodies){0, NULL};
}

void bodies_place(struct bodies *bodies, int64_t step, double dt)
{
    const double time = (double)step * dt, half_before = ((double)step - 0.5) * dt; /* [s] */
    const struct vec3 zero = {0.0, 0.0, 0.0};
    for (int b = 0; b < bodies->n; b++) {
        struct body *body = &bodies->list[b];
        if (!body->moves)
            continue;
        const bool now = is_moving(body, half_before);
        body->velocity_now = now ? body->velocity : zero;
        body->spin_now = now ? vec3_scale(body->rate, body->axis) : zero;
        /* Before its start and after its stop a body costs nothing either. */
        const double duration = moving_time(body, time);
        if (duration != body->placed_for)
            place_vertices(body, duration);
    }
}
