/*
 * See rigid.h.  The rotation of a free body is the implicit midpoint rule in its angular
 * momentum, solved by a fixed number of passes: without torque the momentum does not change at
 * all and the energy keeps its value to the third order in the angle of a step, without drift
 * (THEORY.md, section 10.2).
 */
#include "model/rigid.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/elementary.h"
#include "base/report.h"
#include "job/job.h"
#include "model/mesh.h"

_Static_assert(sizeof(struct rigid_state) == RIGID_STATE_SIZE * sizeof(double), "only doubles");

enum { PASSES = 5 }; /* of the midpoint rule: each gains a factor of the angle of a step */

static const struct vec3 ZERO = {0.0, 0.0, 0.0};

static double size_of(double x)
{
    return x < 0.0 ? -x : x;
}

/* ------------------------------------------------------------------------------- tensors */

/* Symmetric: xx, yy, zz, xy, xz, yz. */
static struct vec3 tensor_apply(const double m[6], struct vec3 v)
{
    return (struct vec3){m[0] * v.x + m[3] * v.y + m[4] * v.z,
                         m[3] * v.x + m[1] * v.y + m[5] * v.z,
                         m[4] * v.x + m[5] * v.y + m[2] * v.z};
}

static void tensor_invert(const double m[6], double inverse[6])
{
    const double a = m[1] * m[2] - m[5] * m[5], b = m[4] * m[5] - m[3] * m[2],
                 c = m[3] * m[5] - m[1] * m[4];
    const double per = 1.0 / (m[0] * a + m[3] * b + m[4] * c);
    inverse[0] = per * a;
    inverse[1] = per * (m[0] * m[2] - m[4] * m[4]);
    inverse[2] = per * (m[0] * m[1] - m[3] * m[3]);
    inverse[3] = per * b;
    inverse[4] = per * c;
    inverse[5] = per * (m[3] * m[4] - m[0] * m[5]);
}

static struct vec3 to_space(const double frame[3][3], struct vec3 v)
{
    return (struct vec3){frame[0][0] * v.x + frame[0][1] * v.y + frame[0][2] * v.z,
                         frame[1][0] * v.x + frame[1][1] * v.y + frame[1][2] * v.z,
                         frame[2][0] * v.x + frame[2][1] * v.y + frame[2][2] * v.z};
}

static struct vec3 to_body(const double frame[3][3], struct vec3 v)
{
    return (struct vec3){frame[0][0] * v.x + frame[1][0] * v.y + frame[2][0] * v.z,
                         frame[0][1] * v.x + frame[1][1] * v.y + frame[2][1] * v.z,
                         frame[0][2] * v.x + frame[1][2] * v.y + frame[2][2] * v.z};
}

/* I^-1 L in space. (10.4) */
static struct vec3 spin_of(const struct rigid *rigid, const double frame[3][3],
                           struct vec3 momentum)
{
    return to_space(frame, tensor_apply(rigid->inverse, to_body(frame, momentum)));
}

/* ----------------------------------------------------------------------------- quaternions */

static void normalise(double q[4])
{
    const double per = 1.0 / sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int k = 0; k < 4; k++)
        q[k] *= per;
}

/* q turned by the small rotation (1, h), normalised: by 2 atan |h| about h. (10.5) */
static void turn_by(double turned[4], const double q[4], struct vec3 h)
{
    turned[0] = q[0] - h.x * q[1] - h.y * q[2] - h.z * q[3];
    turned[1] = q[1] + h.x * q[0] + h.y * q[3] - h.z * q[2];
    turned[2] = q[2] + h.y * q[0] + h.z * q[1] - h.x * q[3];
    turned[3] = q[3] + h.z * q[0] + h.x * q[2] - h.y * q[1];
    normalise(turned);
}

static void frame_of(double frame[3][3], const double q[4])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double m[3][3] = {
        {1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)},
        {2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)},
        {2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)}};
    memcpy(frame, m, sizeof m);
}

/* ----------------------------------------------------------------------- mass of a surface */

struct moments {
    double volume;     /* [m3] */
    struct vec3 first; /* [m4] */
    double second[6];  /* of places, xx yy zz xy xz yz [m5] */
};

/* Adds the tetrahedron that a triangle makes with the origin. */
static void add_triangle(struct moments *moments, struct vec3 a, struct vec3 b, struct vec3 c)
{
    const double volume = vec3_dot(a, vec3_cross(b, c)) / 6.0;
    const struct vec3 s = vec3_add(vec3_add(a, b), c);
    const double per = volume / 20.0;
    moments->volume += volume;
    moments->first = vec3_axpy(moments->first, 0.25 * volume, s);
    moments->second[0] += per * (a.x * a.x + b.x * b.x + c.x * c.x + s.x * s.x);
    moments->second[1] += per * (a.y * a.y + b.y * b.y + c.y * c.y + s.y * s.y);
    moments->second[2] += per * (a.z * a.z + b.z * b.z + c.z * c.z + s.z * s.z);
    moments->second[3] += per * (a.x * a.y + b.x * b.y + c.x * c.y + s.x * s.y);
    moments->second[4] += per * (a.x * a.z + b.x * b.z + c.x * c.z + s.x * s.z);
    moments->second[5] += per * (a.y * a.z + b.y * b.z + c.y * c.z + s.y * s.z);
}

/* Of what the surface encloses, about its first vertex. */
static struct moments moments_of(const struct mesh *mesh)
{
    struct moments moments = {0.0, ZERO, {0.0}};
    const struct vec3 origin = mesh->reference[0];
    for (int f = 0; f < mesh->n_faces; f++) {
        const struct mesh_face *face = &mesh->faces[f];
        const struct vec3 a = vec3_sub(mesh->reference[face->vertices[0]], origin);
        for (int k = 2; k < face->n; k++)
            add_triangle(&moments, a, vec3_sub(mesh->reference[face->vertices[k - 1]], origin),
                         vec3_sub(mesh->reference[face->vertices[k]], origin));
    }
    return moments;
}

/* Mass, centre and tensor of inertia of a closed surface's inside, whichever way it faces. */
static void weigh_surface(struct rigid *rigid, const struct mesh *mesh, double density)
{
    const struct moments moments = moments_of(mesh);
    const double rho = moments.volume < 0.0 ? -density : density;
    const struct vec3 c = vec3_scale(1.0 / moments.volume, moments.first);
    const double v = moments.volume, *s = moments.second;
    /* Second moments about the centre. */
    const double m[6] = {s[0] - v * c.x * c.x, s[1] - v * c.y * c.y, s[2] - v * c.z * c.z,
                         s[3] - v * c.x * c.y, s[4] - v * c.x * c.z, s[5] - v * c.y * c.z};
    const double tensor[6] = {m[1] + m[2], m[0] + m[2], m[0] + m[1], -m[3], -m[4], -m[5]};
    rigid->mass = rho * v;
    rigid->centre = vec3_add(mesh->reference[0], c);
    for (int k = 0; k < 6; k++)
        rigid->tensor[k] = rho * tensor[k];
}

const char *rigid_fault(const struct job_body *asked, const struct mesh *mesh)
{
    if (!asked->free.given || !(asked->free.density > 0.0))
        return NULL;
    if (mesh->n_bands > 0)
        return "is curved, of which the mass is not known";
    int *passes = array_allocate(2 * (size_t)mesh->n_edges, sizeof *passes);
    bool closed = true;
    for (int f = 0; f < mesh->n_faces; f++) {
        const struct mesh_face *face = &mesh->faces[f];
        for (int k = 0; k < face->n; k++) {
            const int e = face->edges[k];
            passes[2 * e + (mesh->edges[e].vertices[0] != face->vertices[k])]++;
        }
    }
    for (int e = 0; e < 2 * mesh->n_edges; e++)
        closed = closed && passes[e] == 1;
    free(passes);
    if (!closed)
        return "is open, or its facets do not all face the same way";
    return moments_of(mesh).volume == 0.0 ? "encloses nothing" : NULL;
}

/* ------------------------------------------------------------------------------- start */

static void build_driven(struct rigid *rigid, const struct job_driven *asked)
{
    const bool slides = asked->kind == JOB_DRIVE_SLIDE;
    const double *limits = slides ? asked->travel : asked->angles;
    rigid->kind = slides ? RIGID_SLIDE : RIGID_TURN;
    rigid->axis = asked->axis;
    rigid->point = asked->point;
    rigid->mass = asked->mass;
    rigid->inertia = asked->inertia;
    rigid->load = slides ? asked->force : asked->torque;
    rigid->friction = slides ? asked->friction : asked->drag;
    rigid->damping = asked->damping;
    rigid->limited = asked->limited;
    rigid->limits[0] = limits[0];
    rigid->limits[1] = limits[1];
    rigid->start = asked->start;
    rigid->state.speed = slides ? asked->speed : asked->rate;
}

static void build_free(struct rigid *rigid, const struct job_free *asked,
                       const struct mesh *mesh)
{
    rigid->kind = RIGID_FREE;
    rigid->mass = asked->mass;
    rigid->centre = asked->centre;
    rigid->damping = asked->damping;
    rigid->start = asked->start;
    memcpy(rigid->tensor, asked->inertia, sizeof rigid->tensor);
    if (asked->density > 0.0)
        weigh_surface(rigid, mesh, asked->density);
    tensor_invert(rigid->tensor, rigid->inverse);
    rigid->state.centre = rigid->centre;
    rigid->state.velocity = asked->velocity;
    rigid->state.spin = asked->spin;
    rigid->state.momentum = tensor_apply(rigid->tensor, asked->spin);
}

/* The farthest that a vertex is from the centre, or from the axis. */
static double arm_of(const struct rigid *rigid, const struct mesh *mesh)
{
    double most = 0.0;
    for (int v = 0; v < mesh->n_vertices; v++) {
        const struct vec3 r = vec3_sub(
            mesh->reference[v], rigid->kind == RIGID_FREE ? rigid->centre : rigid->point);
        const double arm =
            rigid->kind == RIGID_FREE ? vec3_norm(r) : vec3_norm(vec3_cross(rigid->axis, r));
        most = arm > most ? arm : most;
    }
    return most;
}

void rigid_build(struct rigid *rigid, const struct job_body *asked, const struct mesh *mesh)
{
    *rigid = (struct rigid){.state = {.turn = {1.0, 0.0, 0.0, 0.0}}};
    if (asked->free.given)
        build_free(rigid, &asked->free, mesh);
    else
        build_driven(rigid, &asked->driven);
    rigid->arm = arm_of(rigid, mesh);
    rigid_refresh(rigid);
}

/* ------------------------------------------------------------------------------- place */

void rigid_refresh(struct rigid *rigid)
{
    if (rigid->kind == RIGID_FREE) {
        frame_of(rigid->frame, rigid->state.turn);
        return;
    }
    const double half = rigid->kind == RIGID_TURN ? 0.5 * rigid->state.way : 0.0;
    const double sine = elementary_sin(half);
    const double turn[4] = {elementary_cos(half), sine * rigid->axis.x, sine * rigid->axis.y,
                            sine * rigid->axis.z};
    frame_of(rigid->frame, turn);
}

struct vec3 rigid_place(const struct rigid *rigid, struct vec3 reference)
{
    if (rigid->kind == RIGID_SLIDE)
        return vec3_axpy(reference, rigid->state.way, rigid->axis);
    const bool is_free = rigid->kind == RIGID_FREE;
    const struct vec3 pivot = is_free ? rigid->centre : rigid->point;
    return vec3_add(is_free ? rigid->state.centre : rigid->point,
                    to_space(rigid->frame, vec3_sub(reference, pivot)));
}

void rigid_motion(const struct rigid *rigid, struct vec3 *pivot, struct vec3 *velocity,
                  struct vec3 *spin)
{
    const struct vec3 along = vec3_scale(rigid->state.speed, rigid->axis);
    switch (rigid->kind) {
    case RIGID_SLIDE:
        *pivot = rigid->point;
        *velocity = along;
        *spin = ZERO;
        break;
    case RIGID_TURN:
        *pivot = rigid->point;
        *velocity = ZERO;
        *spin = along;
        break;
    case RIGID_FREE:
        *pivot = rigid->state.centre;
        *velocity = rigid->state.velocity;
        *spin = rigid->state.spin;
        break;
    }
}

double rigid_speed(const struct rigid *rigid)
{
    const struct rigid_state *state = &rigid->state;
    if (rigid->kind == RIGID_SLIDE)
        return size_of(state->speed);
    if (rigid->kind == RIGID_TURN)
        return size_of(state->speed) * rigid->arm;
    return vec3_norm(state->velocity) + vec3_norm(state->spin) * rigid->arm;
}

/* ------------------------------------------------------------------------------- yield */

double rigid_yield(const struct rigid *rigid, struct vec3 point, struct vec3 along)
{
    if (rigid->kind == RIGID_SLIDE) {
        const double c = vec3_dot(rigid->axis, along);
        return c * c / rigid->mass;
    }
    if (rigid->kind == RIGID_TURN) {
        const double arm =
            vec3_dot(rigid->axis, vec3_cross(vec3_sub(point, rigid->point), along));
        return arm * arm / rigid->inertia;
    }
    const struct vec3 turn =
        to_body(rigid->frame, vec3_cross(vec3_sub(point, rigid->state.centre), along));
    return 1.0 / rigid->mass + vec3_dot(turn, tensor_apply(rigid->inverse, turn));
}

double rigid_yield_most(const struct rigid *rigid, struct vec3 point)
{
    if (rigid->kind == RIGID_SLIDE)
        return 1.0 / rigid->mass;
    if (rigid->kind == RIGID_TURN) {
        const struct vec3 arm = vec3_cross(rigid->axis, vec3_sub(point, rigid->point));
        return vec3_dot(arm, arm) / rigid->inertia;
    }
    const struct vec3 arm = vec3_sub(point, rigid->state.centre);
    const double trace = rigid->inverse[0] + rigid->inverse[1] + rigid->inverse[2];
    return 1.0 / rigid->mass + vec3_dot(arm, arm) * trace;
}

/* ------------------------------------------------------------------------------- step */

/* The two factors of damping. (5.3) */
static double keep_of(double damping, double dt)
{
    return (1.0 - 0.5 * damping * dt) / (1.0 + 0.5 * damping * dt);
}

static double push_of(double damping, double dt)
{
    return 1.0 / (1.0 + 0.5 * damping * dt);
}

/* What friction leaves of a speed: it stops what it can. (10.2) */
static double rub(double speed, double held)
{
    if (speed > held)
        return speed - held;
    return speed < -held ? speed + held : 0.0;
}

static double clamp(const struct rigid *rigid, double way)
{
    if (!rigid->limited)
        return way;
    if (way < rigid->limits[0])
        return rigid->limits[0];
    return way > rigid->limits[1] ? rigid->limits[1] : way;
}

/* Books a step's work and losses: half is done by the step itself. (10.6) */
static void book(struct rigid *rigid, double work, double damped, double rubbed)
{
    struct rigid_state *next = &rigid->next;
    next->work += work;
    next->damped += damped;
    next->rubbed += rubbed;
    rigid->energies.work = 0.5 * (rigid->state.work + next->work);
    rigid->energies.damped = 0.5 * (rigid->state.damped + next->damped);
    rigid->energies.rubbed = 0.5 * (rigid->state.rubbed + next->rubbed);
}

/* Work of gravity that changes between steps, which is done by now. (10.6) */
static void book_gravity(struct rigid *rigid, struct vec3 middle, struct vec3 change)
{
    const double work = -rigid->mass * vec3_dot(middle, change);
    rigid->state.work += work;
    rigid->next.work += work;
}

static void plan_driven(struct rigid *rigid, const struct rigid_load *load, double dt)
{
    const bool slides = rigid->kind == RIGID_SLIDE;
    const double mass = slides ? rigid->mass : rigid->inertia, before = rigid->state.speed;
    const double weight = slides ? mass * vec3_dot(load->gravity, rigid->axis) : 0.0;
    const struct vec3 torque = vec3_sub(load->torque, vec3_cross(rigid->point, load->force));
    const double force = vec3_dot(slides ? load->force : torque, rigid->axis);
    const double push = push_of(rigid->damping, dt) * dt / mass;
    struct rigid_state *next = &rigid->next;
    if (slides)
        book_gravity(rigid, vec3_scale(rigid->state.way - 0.5 * dt * before, rigid->axis),
                     load->gravity_change);
    /* (10.1), (10.2), (10.3) */
    const double pushed =
        keep_of(rigid->damping, dt) * before + push * (force + weight + rigid->load);
    const double rubbed = rub(pushed, push * rigid->friction);
    const double way = rigid->state.way + dt * rubbed;
    next->way = clamp(rigid, way);
    next->speed = next->way != way ? (next->way - rigid->state.way) / dt : rubbed;
    const double mean = 0.5 * (before + next->speed), path = mean * dt;
    const double held = (next->speed - pushed) / push; /* by friction and stops [N] */
    const double kinetic = 0.5 * mass * mean * mean;
    rigid->energies = (struct rigid_energies){.kinetic_translation = slides ? kinetic : 0.0,
                                              .kinetic_rotation = slides ? 0.0 : kinetic,
                                              .potential = -weight * rigid->state.way};
    book(rigid, rigid->load * path, rigid->damping * mass * mean * path, -held * path);
}

/* The orientation a step later, from the angular momentum in between. (10.4), (10.5) */
static void turn_free(struct rigid *rigid, double dt)
{
    struct rigid_state *next = &rigid->next;
    const double *was = rigid->state.turn;
    double middle[4], frame[3][3];
    memcpy(middle, was, sizeof middle);
    for (int pass = 0; pass < PASSES; pass++) {
        frame_of(frame, middle);
        next->spin = spin_of(rigid, (const double(*)[3])frame, next->momentum);
        turn_by(next->turn, was, vec3_scale(0.5 * dt, next->spin));
        for (int k = 0; k < 4; k++)
            middle[k] = was[k] + next->turn[k];
        normalise(middle);
    }
}

static void plan_free(struct rigid *rigid, const struct rigid_load *load, double dt)
{
    const struct rigid_state *now = &rigid->state;
    struct rigid_state *next = &rigid->next;
    const double keep = keep_of(rigid->damping, dt), push = push_of(rigid->damping, dt) * dt;
    const struct vec3 torque = vec3_sub(load->torque, vec3_cross(now->centre, load->force));
    const struct vec3 rise =
        vec3_axpy(load->gravity, 1.0 / rigid->mass, load->force); /* [m/s2] */
    book_gravity(rigid, vec3_axpy(now->centre, -0.5 * dt, now->velocity), load->gravity_change);
    next->velocity = vec3_axpy(vec3_scale(keep, now->velocity), push, rise);
    next->centre = vec3_axpy(now->centre, dt, next->velocity);
    next->momentum = vec3_axpy(vec3_scale(keep, now->momentum), push, torque);
    turn_free(rigid, dt);
    const struct vec3 velocity = vec3_scale(0.5, vec3_add(now->velocity, next->velocity));
    const struct vec3 momentum = vec3_scale(0.5, vec3_add(now->momentum, next->momentum));
    const struct vec3 spin = spin_of(rigid, (const double(*)[3])rigid->frame, momentum);
    rigid->energies = (struct rigid_energies){
        .kinetic_translation = 0.5 * rigid->mass * vec3_dot(velocity, velocity),
        .kinetic_rotation = 0.5 * vec3_dot(momentum, spin),
        .potential = -rigid->mass * vec3_dot(load->gravity, now->centre)};
    const double kinetic =
        rigid->energies.kinetic_translation + rigid->energies.kinetic_rotation;
    book(rigid, 0.0, 2.0 * rigid->damping * kinetic * dt, 0.0);
}

void rigid_plan(struct rigid *rigid, const struct rigid_load *load, double time, double dt)
{
    rigid->next = rigid->state;
    if (time < rigid->start - 0.5 * dt) { /* held: what gravity's change would do it does not */
        const bool is_free = rigid->kind == RIGID_FREE;
        rigid->energies = (struct rigid_energies){0};
        if (rigid->kind != RIGID_TURN)
            rigid->energies.potential =
                -rigid->mass * (is_free
                                    ? vec3_dot(load->gravity, rigid->state.centre)
                                    : vec3_dot(load->gravity, rigid->axis) * rigid->state.way);
        book_gravity(rigid, is_free ? rigid->state.centre : ZERO, load->gravity_change);
        book(rigid, 0.0, 0.0, 0.0);
    } else if (rigid->kind == RIGID_FREE) {
        plan_free(rigid, load, dt);
    } else {
        plan_driven(rigid, load, dt);
    }
}

void rigid_move(struct rigid *rigid)
{
    rigid->state = rigid->next;
    rigid_refresh(rigid);
}
