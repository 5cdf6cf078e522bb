/*
 * See solid_step.h.  Springs of a node add up, and the bound of an element takes the worst of
 * its corners, as in a run (solid/solid_limits.h, run/node_springs.h).  All springs are taken
 * to act at once, so a run usually bears more than this; elements that become narrower bear
 * less.
 */
#include "run/solid_step.h"

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/elementary.h"
#include "base/vec3.h"
#include "job/job.h"
#include "model/body.h"
#include "model/material.h"
#include "model/rigid.h"
#include "model/skin.h"
#include "model/solid_ball.h"
#include "model/solid_mesh.h"
#include "physics/critical_step.h"
#include "physics/shell_element.h"
#include "run/limits.h"
#include "solid/solid_plan.h"

/* A solid, and of each of its nodes what contacts do to it. */
struct ground {
    const struct job *job;
    const struct job_body *body;
    const struct solid_mesh *mesh;
    struct solid_mesh own;       /* of the mesh, where none is kept */
    double *mass;                /* [kg] */
    bool *on_surface;            /* nodes; NULL: all elements count, not only those there */
    double *stiffness, *damping; /* [N/m], [kg/s]; NULL: without contacts */
};

/* ------------------------------------------------------------------------------- elements */

static struct solid_element_material material_of(const struct ground *ground, int e)
{
    const struct job_body *body = ground->body;
    const struct job_material *from =
        &ground->job->materials[solid_mesh_material(ground->mesh, e, body->material)];
    const struct solid_plan_hourglass held =
        solid_plan_hourglass(body, solid_mesh_is_sheet(ground->mesh->elements[e]));
    struct solid_element_material material = {.density = from->density,
                                              .damping = body->solid.damping.stiffness,
                                              .hourglass_stiffness = held.stiffness,
                                              .hourglass_viscosity = held.viscosity};
    solid_element_elastic(&material, from->young, from->poisson);
    return material;
}

/* Its corners' places. */
static void places_of(const struct solid_mesh *mesh, int e, double x[SOLID_ELEMENT_CORNERS][3])
{
    const int n = solid_mesh_n_corners(mesh->elements[e]);
    for (int c = 0; c < n; c++) {
        const struct vec3 at = mesh->nodes[mesh->elements[e][c]];
        x[c][0] = at.x;
        x[c][1] = at.y;
        x[c][2] = at.z;
    }
}

static double mass_of(const struct ground *ground, int e)
{
    const enum solid_element_shape shape = solid_plan_shape(ground->mesh, e);
    double x[SOLID_ELEMENT_CORNERS][3];
    places_of(ground->mesh, e, x);
    const int material = solid_mesh_material(ground->mesh, e, ground->body->material);
    return ground->job->materials[material].density *
           (shell_element_is(shape)
                ? shell_element_area(shape, x) * ground->mesh->sheets[e].thickness
                : solid_element_volume(shape, x));
}

static struct solid_element_load load_of(const struct ground *ground, int e)
{
    const enum solid_element_shape shape = solid_plan_shape(ground->mesh, e);
    const double mass = mass_of(ground, e);
    const struct solid_element_material material = material_of(ground, e);
    double x[SOLID_ELEMENT_CORNERS][3];
    places_of(ground->mesh, e, x);
    return shell_element_is(shape)
               ? shell_element_load(shape, x, mass, ground->mesh->sheets[e].thickness,
                                    ground->body->sheet.layers, &material, 0.0)
               : solid_element_load(shape, x, mass, &material);
}

static void ground_init(struct ground *ground, const struct job *job, int b)
{
    *ground = (struct ground){.job = job, .body = &job->bodies[b]};
    ground->mesh = solid_mesh_borrow(ground->body, &ground->own);
    ground->mass = array_allocate((size_t)ground->mesh->n_nodes, sizeof *ground->mass);
    for (int e = 0; e < ground->mesh->n_elements; e++) {
        const int *corners = ground->mesh->elements[e], n = solid_mesh_n_corners(corners);
        const double share = mass_of(ground, e) / n;
        for (int c = 0; c < n; c++)
            ground->mass[corners[c]] += share;
    }
    for (int k = 0; k < ground->body->solid.n_masses; k++) {
        const struct solid_plan_mass share = solid_plan_mass(ground->body, ground->mesh, k);
        for (int j = 0; j < share.set->n_nodes; j++)
            ground->mass[share.set->nodes[j]] += share.mass;
    }
}

static void ground_clear(struct ground *ground)
{
    free(ground->mass);
    free(ground->on_surface);
    free(ground->stiffness);
    free(ground->damping);
    solid_mesh_clear(&ground->own);
}

/* The corner of an element where this is largest beside the mass, and how large it is there. */
static int worst_corner(const struct ground *ground, int e, const double *of_node, double *most)
{
    const int *corners = ground->mesh->elements[e];
    int worst = -1;
    *most = 0.0;
    for (int c = 0; of_node != NULL && c < solid_mesh_n_corners(corners); c++) {
        const double share = of_node[corners[c]] / ground->mass[corners[c]];
        if (share > *most) {
            *most = share;
            worst = corners[c];
        }
    }
    return worst;
}

static bool counts(const struct ground *ground, int e)
{
    const int *corners = ground->mesh->elements[e];
    bool found = ground->on_surface == NULL;
    for (int c = 0; !found && c < solid_mesh_n_corners(corners); c++)
        found = ground->on_surface[corners[c]];
    return found;
}

/* The element that allows least, as solid_limits_find() and node_springs_slow() in a run. */
static struct solid_step find_least(const struct ground *ground)
{
    const double n = ground->job->time.substeps;
    struct solid_step least = {.step = (double)INFINITY, .element = -1, .node = -1};
    for (int e = 0; e < ground->mesh->n_elements; e++) {
        double stiffness, damping;
        if (!counts(ground, e))
            continue;
        const struct solid_element_load load = load_of(ground, e);
        const int node = worst_corner(ground, e, ground->stiffness, &stiffness);
        (void)worst_corner(ground, e, ground->damping, &damping);
        const double step =
            n * solid_element_critical_step(&load, n * n * stiffness, n * damping);
        if (step < least.step)
            least = (struct solid_step){.step = step, .element = e, .node = node};
    }
    return least;
}

struct solid_step solid_step_alone(const struct job *job, int b)
{
    struct ground ground;
    ground_init(&ground, job, b);
    const struct solid_step least = find_least(&ground);
    ground_clear(&ground);
    return least;
}

/* ------------------------------------------------------------------------------- contacts */

/* Springs and dashpots of nodes of the surface. */
struct surface {
    int n;
    int *nodes;               /* of vertices that contacts push */
    struct solid_ball *balls; /* of these, with the area that each stands for */
};

static void surface_init(struct surface *surface, const struct ground *ground,
                         const struct mesh *skin)
{
    struct skin shape;
    skin_build(&shape, ground->mesh);
    surface->n = shape.n_vertices;
    surface->nodes = shape.nodes;
    shape.nodes = NULL;
    surface->balls = solid_balls(ground->mesh, skin, surface->nodes);
    skin_clear(&shape);
}

static void surface_clear(struct surface *surface)
{
    free(surface->nodes);
    free(surface->balls);
}

/* A contact as nodes feel it. */
struct felt {
    double stiffness, damping; /* [N/m], [kg/s] */
};

static struct felt felt_of(const struct material_pair *pair, double width, double mass)
{
    const struct critical_step_contact contact = critical_step_contact(pair, width, mass);
    const double *k = contact.stiffness, *d = contact.damping;
    return (struct felt){k[0] > k[1] ? k[0] : k[1], d[0] > d[1] ? d[0] : d[1]};
}

static void push(const struct ground *ground, int node, double part, struct felt felt)
{
    ground->stiffness[node] += part * felt.stiffness;
    ground->damping[node] += part * felt.damping;
}

/* The spring of a ball between such materials, of a width of 1 m; none where they do not
 * touch.  (12.19) */
static struct material_pair spring_between(const struct job *job, int a, int b)
{
    for (int k = 0; k < job->n_pairs; k++) {
        const struct job_pair *asked = &job->pairs[k];
        if ((asked->a == a && asked->b == b) || (asked->a == b && asked->b == a))
            return material_touch(job, asked);
    }
    return (struct material_pair){.linear = 1.0};
}

static bool touches_bodies(const struct job_body *body)
{
    return body->model == JOB_MODEL_SOLID && body->solid.touches.what != JOB_TOUCHES_SPHERES;
}

/* Does a ball of body `from` meet faces of body `to`? */
static bool meets(const struct job *job, int from, int to)
{
    const struct job_body *body = &job->bodies[from];
    if (!touches_bodies(body))
        return false;
    return from != to || body->solid.touches.what == JOB_TOUCHES_ITSELF;
}

static void harder(struct felt *most, struct felt felt)
{
    most->stiffness = felt.stiffness > most->stiffness ? felt.stiffness : most->stiffness;
    most->damping = felt.damping > most->damping ? felt.damping : most->damping;
}

/* What one ball of body `from` does, of this width, in the stiffest contact with body `to`. */
static void harden(const struct ground *ground, int from, int to, double width, double mass,
                   struct felt *most)
{
    const struct job *job = ground->job;
    const struct material_pair pair =
        spring_between(job, job->bodies[from].material, job->bodies[to].material);
    const struct felt felt = felt_of(&pair, width, mass);
    harder(most, felt);
}

/* The body's own balls, each pressed against the stiffest other body. */
static void add_own_balls(const struct ground *ground, const struct surface *surface, int b)
{
    const struct job *job = ground->job;
    const double s = ground->body->solid.touches.stiffness;
    for (int v = 0; v < surface->n; v++) {
        const struct solid_ball *ball = &surface->balls[v];
        struct felt most = {0.0, 0.0};
        if (ball->n_inner == 0)
            continue;
        const double near = 1.0 - ball->part, far = ball->part / ball->n_inner;
        double inverse_mass = near * near / ground->mass[ball->outer];
        for (int k = 0; k < ball->n_inner; k++)
            inverse_mass += far * far / ground->mass[ball->inner[k]];
        for (int to = 0; to < job->n_bodies; to++)
            if (meets(job, b, to))
                harden(ground, b, to, s * ball->area / ball->depth, 1.0 / inverse_mass, &most);
        push(ground, ball->outer, near, most);
        for (int k = 0; k < ball->n_inner; k++)
            push(ground, ball->inner[k], far, most);
    }
}

/* How easily a body yields to forces on its surface, in the mean over its facets' corners and
 * sides' middles [1/kg]. */
static double yield_of(const struct body *body)
{
    const struct mesh *mesh = &body->mesh;
    double sum = 0.0;
    int n = 0;
    for (int k = 0; k < mesh_n_shown(mesh); k++) {
        const int *at, n_at = mesh_shown(mesh, k, &at);
        for (int c = 0; c < n_at; c++, n++) {
            const struct vec3 a = mesh->reference[at[c]],
                              b = mesh->reference[at[(c + 1) % n_at]];
            sum += rigid_yield_most(body->rigid, vec3_scale(0.5, vec3_add(a, b)));
        }
    }
    return sum / n;
}

/* From the ball's inner nodes to the outer one, of length 1. */
static struct vec3 outwards(const struct ground *ground, const struct solid_ball *ball)
{
    struct vec3 way = vec3_scale(ball->n_inner, ground->mesh->nodes[ball->outer]);
    for (int k = 0; k < ball->n_inner; k++)
        way = vec3_sub(way, ground->mesh->nodes[ball->inner[k]]);
    return vec3_scale(1.0 / vec3_norm(way), way);
}

/* Springs and dashpots of the balls that face one way, as many as find room on half of a body's
 * surface. */
static struct felt felt_from(const struct ground *ground, const struct surface *surface, int b,
                             int to, struct vec3 direction, double room)
{
    static const double FACING = 0.5; /* within 60 degrees: corners of boxes as well */
    struct felt sum = {0.0, 0.0};
    double area = 0.0;
    for (int v = 0; v < surface->n; v++) {
        const struct solid_ball *ball = &surface->balls[v];
        struct felt felt = {0.0, 0.0};
        if (ball->n_inner == 0 || vec3_dot(outwards(ground, ball), direction) < FACING)
            continue;
        harden(ground, b, to, ground->body->solid.touches.stiffness * ball->area / ball->depth,
               ground->mass[ball->outer], &felt);
        sum.stiffness += felt.stiffness;
        sum.damping += felt.damping;
        area += ball->area;
    }
    const double share = area > room ? room / area : 1.0;
    return (struct felt){share * sum.stiffness, share * sum.damping};
}

/* A body that forces move yields to all balls on it together: each has this much beside its own
 * spring, for every kg of its node. (10.8) */
static void add_yielding(const struct ground *ground, const struct surface *surface,
                         const struct bodies *bodies, int b)
{
    struct felt most = {0.0, 0.0};
    for (int to = 0; to < bodies->n; to++) {
        const struct body *body = &bodies->list[to];
        if (body->rigid == NULL || !meets(ground->job, b, to))
            continue;
        const double yield = yield_of(body), room = 0.5 * mesh_survey(&body->mesh).area;
        for (int d = 0; d < 6; d++) {
            double way[3] = {0.0, 0.0, 0.0};
            way[d / 2] = d % 2 == 0 ? 1.0 : -1.0;
            const struct felt felt =
                felt_from(ground, surface, b, to, (struct vec3){way[0], way[1], way[2]}, room);
            harder(&most, (struct felt){yield * felt.stiffness, yield * felt.damping});
        }
    }
    for (int v = 0; v < surface->n && most.stiffness > 0.0; v++)
        if (surface->balls[v].n_inner > 0)
            push(ground, surface->nodes[v], ground->mass[surface->nodes[v]], most);
}

/* Others' balls on the body's faces: as many of mean size as find room on what a node stands
 * for, or one. */
static void add_others_balls(const struct ground *ground, const struct surface *surface,
                             const struct bodies *bodies, int b)
{
    const struct job *job = ground->job;
    struct felt *most = array_allocate((size_t)surface->n, sizeof *most);
    for (int from = 0; from < job->n_bodies; from++) {
        if (!meets(job, from, b))
            continue;
        const struct mesh *mesh = &bodies->list[from].mesh;
        const double area = mesh_survey(mesh).area / mesh->n_corners;
        const double width = job->bodies[from].solid.touches.stiffness * sqrt(area);
        for (int v = 0; v < surface->n; v++) {
            const double room = surface->balls[v].area / area;
            harden(ground, from, b, room > 1.0 ? room * width : width,
                   ground->mass[surface->nodes[v]], &most[v]);
        }
    }
    for (int v = 0; v < surface->n; v++)
        push(ground, surface->nodes[v], 1.0, most[v]);
    free(most);
}

/* Spheres of this size on a node of the surface: one that strikes, and as many as find room
 * that rest. */
static struct felt felt_of_spheres(const struct material_pair *pair,
                                   const struct limits_strike *strike, double radius,
                                   double area, double mass)
{
    const double both = mass * strike->mass / (mass + strike->mass);
    const double room = area / (4.0 * radius * radius);
    const struct felt struck = felt_of(pair, strike->struck, both);
    const struct felt pressed = felt_of(pair, strike->pressed, both);
    return (struct felt){struck.stiffness + room * pressed.stiffness,
                         struck.damping + room * pressed.damping};
}

static void add_spheres(const struct ground *ground, const struct surface *surface,
                        const struct materials *materials, const struct limits_spheres *spheres)
{
    struct felt *most = array_allocate((size_t)surface->n, sizeof *most);
    for (int m = 0; m < 2 * spheres->n_materials; m++) {
        const struct limits_sizes *sizes = &spheres->sizes[m / 2];
        const double radius = m % 2 == 0 ? sizes->least : sizes->most;
        const struct material_pair *pair =
            &materials->pairs[m / 2 * materials->n + ground->body->material];
        if (!(radius > 0.0 && pair->normal > 0.0))
            continue;
        const struct limits_strike strike =
            limits_strike(spheres, ground->job, pair, m / 2, radius);
        for (int v = 0; v < surface->n; v++) {
            const struct felt felt = felt_of_spheres(
                pair, &strike, radius, surface->balls[v].area, ground->mass[surface->nodes[v]]);
            if (felt.stiffness > most[v].stiffness)
                most[v] = felt;
        }
    }
    for (int v = 0; v < surface->n; v++)
        push(ground, surface->nodes[v], 1.0, most[v]);
    free(most);
}

/* Where contacts are. */
static void look_at_surface(struct ground *ground, const struct surface *surface)
{
    ground->on_surface =
        array_allocate((size_t)ground->mesh->n_nodes, sizeof *ground->on_surface);
    for (int v = 0; v < surface->n; v++)
        ground->on_surface[surface->nodes[v]] = true;
}

static void add_springs(struct ground *ground)
{
    const size_t n = (size_t)ground->mesh->n_nodes;
    ground->stiffness = array_allocate(n, sizeof *ground->stiffness);
    ground->damping = array_allocate(n, sizeof *ground->damping);
}

struct solid_step solid_step_touching(const struct job *job, const struct bodies *bodies, int b)
{
    struct ground ground;
    struct surface surface;
    ground_init(&ground, job, b);
    surface_init(&surface, &ground, &bodies->list[b].mesh);
    add_springs(&ground);
    add_own_balls(&ground, &surface, b);
    look_at_surface(&ground, &surface);
    const struct solid_step least = find_least(&ground);
    surface_clear(&surface);
    ground_clear(&ground);
    return least;
}

struct solid_step solid_step_with_contacts(const struct job *job, const struct bodies *bodies,
                                           const struct materials *materials,
                                           const struct limits_spheres *spheres, int b)
{
    struct ground ground;
    struct surface surface;
    bool of_spheres = false, of_bodies = false;
    ground_init(&ground, job, b);
    surface_init(&surface, &ground, &bodies->list[b].mesh);
    add_springs(&ground);
    add_own_balls(&ground, &surface, b);
    add_others_balls(&ground, &surface, bodies, b);
    add_yielding(&ground, &surface, bodies, b);
    if (spheres != NULL)
        add_spheres(&ground, &surface, materials, spheres);
    else
        look_at_surface(&ground, &surface);
    struct solid_step least = find_least(&ground);
    for (int k = 0; k < job->n_bodies; k++)
        of_bodies = of_bodies || meets(job, b, k) || meets(job, k, b);
    for (int m = 0; spheres != NULL && m < spheres->n_materials; m++)
        of_spheres = of_spheres || spheres->sizes[m].most > 0.0;
    least.of_bodies = of_bodies;
    least.of_spheres = of_spheres;
    surface_clear(&surface);
    ground_clear(&ground);
    return least;
}

double solid_step_flow(const struct job *job, const struct job_body *body)
{
    const struct job_material *material = &job->materials[body->material];
    const double yield =
        material->n_hardening_table > 0 ? material->hardening_table[0].stress : material->yield;
    const struct vec3 v = body->solid.velocity;
    return yield > 0.0 ? 0.5 * material->density * vec3_dot(v, v) / yield : 0.0;
}

/* What elements that become flat as their body stops will bear of what they bear at first. */
static double flow_share(double flow)
{
    static const double FLATTER = 2.5, LEAST = 0.05;
    const double share = elementary_exp(-FLATTER * flow);
    return share > LEAST ? share : LEAST;
}

double solid_step_safe(const struct job *job, const struct bodies *bodies)
{
    double least = (double)INFINITY;
    for (int b = 0; b < job->n_bodies; b++) {
        if (!job_deforms(&job->bodies[b]))
            continue;
        const double step = solid_step_with_contacts(job, bodies, NULL, NULL, b).step;
        least = step < least ? step : least;
    }
    return SOLID_STEP_SHARE * least;
}

double solid_step_auto(const struct job *job, const struct bodies *bodies,
                       const struct materials *materials, const struct limits_spheres *spheres)
{
    double least = (double)INFINITY;
    for (int b = 0; b < job->n_bodies; b++) {
        if (!job_deforms(&job->bodies[b]))
            continue;
        const double step = flow_share(solid_step_flow(job, &job->bodies[b])) *
                            solid_step_with_contacts(job, bodies, materials, spheres, b).step;
        least = step < least ? step : least;
    }
    return SOLID_STEP_SHARE * least;
}
