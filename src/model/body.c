/*
 * Rigid bodies and their motion: see body.h.
 *
 * A prescribed body's vertices follow from its reference mesh and the time alone; nothing is
 * accumulated, so a restart, or a rank that meets the body late, finds the same bits.  Its
 * motions are taken one after the other, as the job lists them.
 */
#include "model/body.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/groups.h"
#include "job/job.h"
#include "model/geometry.h"
#include "model/motion.h"
#include "model/rigid.h"
#include "model/skin.h"

static const struct vec3 ZERO = {0.0, 0.0, 0.0};

/* ----------------------------------------------------------------------------- prescribed */

/* Do places at two times differ? */
static bool has_moved(const struct body *body, double time)
{
    bool moved = false;
    for (int m = 0; m < body->n_motions; m++)
        moved = moved || motion_duration(&body->motions[m], time) !=
                             motion_duration(&body->motions[m], body->placed_at);
    return moved;
}

/* (3.1) */
static void place_vertices(struct body *body, double time)
{
    struct mesh *mesh = &body->mesh;
    for (int v = 0; v < mesh->n_vertices; v++)
        mesh->place[v] = mesh->reference[v];
    for (int m = 0; m < body->n_motions; m++) {
        const struct motion_place place = motion_place(&body->motions[m], time);
        for (int v = 0; v < mesh->n_vertices; v++)
            mesh->place[v] = motion_apply(&place, mesh->place[v]);
    }
    body->placed_at = time;
    mesh_update(mesh);
}

/* Velocities of all motions together, half a step before `time`. (3.2) */
static void find_motion(struct body *body, double time, double half, double dt)
{
    struct vec3 point = ZERO, velocity = ZERO, spin = ZERO;
    for (int m = 0; m < body->n_motions; m++) {
        const struct job_motion *motion = &body->motions[m];
        const struct motion_place place = motion_place(motion, time);
        const struct motion_rate rate = motion_rate(motion, half, dt);
        if (m == 0)
            point = place.pivot;
        point = motion_apply(&place, point);
        const struct vec3 arm =
            vec3_sub(point, vec3_add(place.pivot, place.shift)); /* zero for the first */
        velocity = vec3_add(vec3_add(motion_turn(&place, velocity), rate.velocity),
                            vec3_cross(rate.spin, arm));
        spin = vec3_add(motion_turn(&place, spin), rate.spin);
    }
    body->pivot_now = point;
    body->velocity_now = velocity;
    body->spin_now = spin;
}

/* The farthest that a vertex is from a motion's axis. */
static double arm_of(const struct mesh *mesh, const struct motion_place *place)
{
    double most = 0.0;
    for (int v = 0; v < mesh->n_vertices; v++) {
        const struct vec3 r = vec3_sub(mesh->reference[v], place->pivot);
        const double across = vec3_norm(vec3_cross(place->axis, r));
        most = across > most ? across : most;
    }
    return most;
}

/* A bound on the speed that a motion gives a vertex which has strayed by up to so much from its
 * place at the start [m/s]; the motion lets it stray farther by the end of the run. */
static double speed_of(const struct body *body, const struct job_motion *motion, double end,
                       double *strayed)
{
    const struct motion_place place = motion_place(motion, 0.0);
    const double spin = motion_spin_most(motion);
    const double arm = arm_of(&body->mesh, &place) + *strayed;
    *strayed += motion_shift_most(motion, end) + (spin > 0.0 ? 2.0 * arm : 0.0);
    return motion_speed_most(motion) + spin * arm;
}

/* No vertex is ever faster than the motions of one time together, each with the arm that those
 * before it may have given the vertex by the end of the run; `strayed` is how far any may be
 * from its place at the start then. */
static double fastest(const struct body *body, double end, double *strayed)
{
    double *speeds = array_allocate((size_t)body->n_motions, sizeof *speeds);
    double most = 0.0; /* [m/s] */
    for (int m = 0; m < body->n_motions; m++)
        speeds[m] = speed_of(body, &body->motions[m], end, strayed);
    /* The most of all acts when one of them begins. */
    for (int m = 0; m < body->n_motions; m++) {
        double sum = 0.0;
        for (int k = 0; k < body->n_motions; k++)
            if (body->motions[k].start <= body->motions[m].start &&
                body->motions[k].stop > body->motions[m].start)
                sum += speeds[k];
        most = sum > most ? sum : most;
    }
    free(speeds);
    return most;
}

/* ---------------------------------------------------------------------------------- surface */

/* How the surface runs between half a step before `half` and half a step after. (3.6) */
static void run_surface(struct body *body, double half, double dt)
{
    const struct motion_rate rate = motion_rate(body->surface, half, dt);
    body->surface_runs = half > body->surface->start && half < body->surface->stop;
    body->surface_velocity = rate.velocity;
    body->surface_spin = rate.spin;
    body->surface_pivot = body->surface->pivot;
}

struct vec3 body_drift(const struct body *body, struct vec3 point)
{
    if (!body->moves)
        return ZERO;
    const struct vec3 arm = vec3_sub(point, body->pivot_now);
    return vec3_add(body->velocity_now, vec3_cross(body->spin_now, arm));
}

struct vec3 body_velocity(const struct body *body, struct vec3 point, struct vec3 normal)
{
    const struct vec3 drift = body_drift(body, point);
    if (!body->surface_runs)
        return drift;
    const struct vec3 arm = vec3_sub(point, body->surface_pivot);
    const struct vec3 run =
        vec3_add(body->surface_velocity, vec3_cross(body->surface_spin, arm));
    return vec3_add(drift, vec3_axpy(run, -vec3_dot(run, normal), normal));
}

struct vec3 body_spin(const struct body *body)
{
    struct vec3 spin = body->moves ? body->spin_now : ZERO;
    if (body->surface_runs)
        spin = vec3_add(spin, body->surface_spin);
    return spin;
}

/* ----------------------------------------------------------------------------------- forced */

static void place_forced(struct body *body)
{
    struct mesh *mesh = &body->mesh;
    for (int v = 0; v < mesh->n_vertices; v++)
        mesh->place[v] = rigid_place(body->rigid, mesh->reference[v]);
    rigid_motion(body->rigid, &body->pivot_now, &body->velocity_now, &body->spin_now);
    body->speed_max = rigid_speed(body->rigid);
    mesh_update(mesh);
}

/* ------------------------------------------------------------------------------------ frame */

/* Where what moves with the body has come to, from its place at time 0. */
static struct vec3 carry(const struct body *body, double time, struct vec3 x)
{
    if (body->rigid != NULL)
        return rigid_place(body->rigid, x);
    for (int m = 0; m < body->n_motions; m++) {
        const struct motion_place place = motion_place(&body->motions[m], time);
        x = motion_apply(&place, x);
    }
    return x;
}

struct body_frame body_frame(const struct body *body, double time)
{
    static const struct vec3 units[3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    struct body_frame frame = {.origin = carry(body, time, ZERO)};
    for (int k = 0; k < 3; k++)
        frame.axes[k] = vec3_sub(carry(body, time, units[k]), frame.origin);
    return frame;
}

struct vec3 body_frame_reference(const struct body_frame *frame, struct vec3 x)
{
    const struct vec3 arm = vec3_sub(x, frame->origin);
    return (struct vec3){vec3_dot(frame->axes[0], arm), vec3_dot(frame->axes[1], arm),
                         vec3_dot(frame->axes[2], arm)};
}

/* -------------------------------------------------------------------------------------- all */

static void copy_motions(struct body *body, int n_motions, const struct job_motion *motions)
{
    body->n_motions = n_motions;
    body->motions = array_allocate((size_t)n_motions, sizeof *body->motions);
    for (int m = 0; m < n_motions; m++) {
        struct job_motion *motion = &body->motions[m];
        *motion = motions[m];
        const size_t n = (size_t)motion->path.n;
        motion->path.points = array_allocate(n, sizeof *motion->path.points);
        if (n > 0)
            memcpy(motion->path.points, motions[m].path.points,
                   n * sizeof *motion->path.points);
    }
}

/* Its own; of a body that deforms those of the first set that follows some. */
static void take_motions(struct body *body, const struct job_body *asked)
{
    const struct job_solid *solid = &asked->solid;
    int item = 0;
    while (item < solid->n_boundary && solid->boundary[item].n_motions == 0)
        item++;
    if (job_deforms(asked) && item < solid->n_boundary)
        copy_motions(body, solid->boundary[item].n_motions, solid->boundary[item].motions);
    else
        copy_motions(body, asked->n_motions, asked->motions);
}

/* Faces that are one smooth part of the surface, by the first of them. */
static int *find_smooth(const struct mesh *mesh)
{
    int *smooth = groups_apart(mesh->n_faces);
    for (int e = 0; e < mesh->n_edges; e++) {
        const int *faces = mesh->edges[e].faces;
        if (faces[1] < 0 ||
            vec3_dot(mesh->face_normal[faces[0]], mesh->face_normal[faces[1]]) < SKIN_SMOOTH)
            continue;
        (void)groups_join(smooth, faces[0], faces[1]);
    }
    for (int f = 0; f < mesh->n_faces; f++)
        smooth[f] = groups_first(smooth, f);
    return smooth;
}

struct body_skin *body_skin_build(const struct mesh *mesh)
{
    const size_t n = (size_t)mesh->n_corners;
    struct body_skin *skin = array_allocate(1, sizeof *skin);
    skin->smooth = find_smooth(mesh);
    skin->velocity = array_allocate(n + 1, sizeof *skin->velocity); /* kernels read on */
    skin->inverse_mass = array_allocate(n, sizeof *skin->inverse_mass);
    skin->force = array_allocate_rows(n, sizeof *skin->force);
    skin->pushed = array_allocate(n, sizeof *skin->pushed);
    skin->since = array_allocate((size_t)mesh->n_faces, sizeof *skin->since);
    return skin;
}

void body_renew_face(const struct body *body, int face)
{
    if (body->skin == NULL || body->skin->since[face] == body->skin->now)
        return;
    body_renew_mean(body, face);
    mesh_update_face(&body->mesh, face);
    body->skin->since[face] = body->skin->now;
}

void body_skin_free(struct body_skin *skin)
{
    if (skin == NULL)
        return;
    free(skin->velocity);
    free(skin->inverse_mass);
    free(skin->force);
    free(skin->pushed);
    free(skin->since);
    free(skin->smooth);
    free(skin);
}

static void body_build(struct body *body, const struct job_body *asked, double end)
{
    *body = (struct body){.name = array_string(asked->name),
                          .material = asked->material,
                          .exists = true,
                          .comes_and_goes = asked->comes_and_goes,
                          .active = {asked->active[0], asked->active[1]}};
    take_motions(body, asked);
    geometry_build_mesh(&body->mesh, asked);
    if (asked->driven.given || asked->free.given) {
        body->rigid = array_allocate(1, sizeof *body->rigid);
        rigid_build(body->rigid, asked, &body->mesh);
        body->speed_max = rigid_speed(body->rigid);
        body->moves = true;
        return;
    }
    if (job_deforms(asked)) {
        body->skin = body_skin_build(&body->mesh);
        body->moves = true;
        return;
    }
    for (int m = 0; m < body->n_motions; m++)
        body->moves = body->moves || motion_moves(&body->motions[m]);
    double strayed = 0.0;
    body->speed_max = body->moves ? fastest(body, end, &strayed) : 0.0;
    if (asked->surface.given) {
        body->surface = array_allocate(1, sizeof *body->surface);
        *body->surface = asked->surface.motion;
        body->surface_speed_max = speed_of(body, body->surface, end, &strayed);
    }
}

void bodies_build(struct bodies *bodies, const struct job *job)
{
    *bodies = (struct bodies){.n = job->n_bodies};
    bodies->list = array_allocate((size_t)job->n_bodies, sizeof *bodies->list);
    for (int b = 0; b < bodies->n; b++) {
        body_build(&bodies->list[b], &job->bodies[b], job->time.end);
        bodies->n_forced += bodies->list[b].rigid != NULL;
    }
    bodies_place(bodies, 0, job->time.step > 0.0 ? job->time.step : 1.0);
}

void bodies_clear(struct bodies *bodies)
{
    for (int b = 0; b < bodies->n; b++) {
        struct body *body = &bodies->list[b];
        for (int m = 0; m < body->n_motions; m++)
            free(body->motions[m].path.points);
        free(body->motions);
        free(body->surface);
        free(body->rigid);
        body_skin_free(body->skin);
        free(body->name);
        mesh_clear(&body->mesh);
    }
    free(bodies->list);
    *bodies = (struct bodies){0, NULL, 0};
}

bool body_exists(const struct body *body, int64_t step, double dt)
{
    const double *active = body->active;
    if (!body->comes_and_goes)
        return true;
    return (double)step >= active[0] / dt - 0.5 && (double)step < active[1] / dt - 0.5;
}

void bodies_place(struct bodies *bodies, int64_t step, double dt)
{
    const double time = (double)step * dt, half_before = ((double)step - 0.5) * dt; /* [s] */
    for (int b = 0; b < bodies->n; b++) {
        struct body *body = &bodies->list[b];
        body->exists = body_exists(body, step, dt);
        if (body->surface != NULL)
            run_surface(body, half_before, dt);
        if (!body->moves || body->skin != NULL)
            continue;
        if (body->rigid != NULL) {
            place_forced(body);
            continue;
        }
        find_motion(body, time, half_before, dt);
        /* Before its start and after its stop a body costs nothing either. */
        if (has_moved(body, time))
            place_vertices(body, time);
    }
}
