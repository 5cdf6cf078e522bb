/* See deform.h. */
#include "run/deform.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/report.h"
#include "base/timer.h"
#include "job/job.h"
#include "model/solid_ball.h"
#include "model/solid_condition.h"
#include "model/solid_mesh.h"
#include "run/node_springs.h"
#include "run/simulation.h"
#include "solid/solid_limits.h"
#include "solid/solid_plan.h"

/* ---- Building
 * --------------------------------------------------------------------------------- */

/* A job's material as solids or sheets of the body have it; `points` has room for all of its
 * table. */
static struct solid_material material_of(const struct job_body *body, bool sheet,
                                         const struct job_material *from,
                                         struct solid_yield_point *points)
{
    const struct solid_plan_hourglass held = solid_plan_hourglass(body, sheet);
    points[0] = (struct solid_yield_point){0.0, from->yield};
    for (int k = 0; k < from->n_hardening_table; k++)
        points[k] = (struct solid_yield_point){from->hardening_table[k].strain,
                                               from->hardening_table[k].stress};
    return (struct solid_material){
        .density = from->density,
        .young = from->young,
        .poisson = from->poisson,
        .damping = body->solid.damping.stiffness,
        .hourglass_stiffness = held.stiffness,
        .hourglass_viscosity = held.viscosity,
        .n_yield = from->n_hardening_table > 0 ? from->n_hardening_table : from->yield > 0.0,
        .yield = points,
        .hardening = from->n_hardening_table > 0 ? 0.0 : from->hardening,
    };
}

/* What elements are made of: of each the number of its material, of all materials, for solids
 * and sheets apart, what they are. */
struct made_of {
    int *of_element, n;
    struct solid_material *list;
};

static void made_of_init(struct made_of *made, const struct solid_mesh *mesh,
                         const struct job_body *body, const struct job *job)
{
    int *number = array_allocate(2 * (size_t)job->n_materials, sizeof *number); /* from 1 */
    *made = (struct made_of){.n = 0};
    made->of_element = array_allocate((size_t)mesh->n_elements, sizeof *made->of_element);
    made->list = array_allocate(2 * (size_t)job->n_materials, sizeof *made->list);
    for (int e = 0; e < mesh->n_elements; e++) {
        const bool sheet = solid_mesh_is_sheet(mesh->elements[e]);
        const int asked = solid_mesh_material(mesh, e, body->material);
        int *own = &number[2 * asked + sheet];
        if (*own == 0) {
            const struct job_material *from = &job->materials[asked];
            struct solid_yield_point *points =
                array_allocate((size_t)from->n_hardening_table + 1, sizeof *points);
            made->list[made->n] = material_of(body, sheet, from, points);
            *own = ++made->n;
        }
        made->of_element[e] = *own - 1;
    }
    free(number);
}

static void made_of_clear(struct made_of *made)
{
    for (int m = 0; m < made->n; m++)
        free((void *)(uintptr_t)made->list[m].yield);
    free(made->of_element);
    free(made->list);
}

static void build_solid(struct solid *solid, const struct solid_mesh *mesh,
                        const struct job_body *body, const struct job *job, enum isa isa)
{
    const size_t n = (size_t)mesh->n_elements;
    enum solid_element_shape *shapes = array_allocate(n, sizeof *shapes);
    double *thickness = array_allocate(n, sizeof *thickness);
    struct made_of made;
    for (int e = 0; e < mesh->n_elements; e++) {
        shapes[e] = solid_plan_shape(mesh, e);
        thickness[e] = mesh->sheets != NULL ? mesh->sheets[e].thickness : 0.0;
    }
    made_of_init(&made, mesh, body, job);
    const struct solid_parts parts = {.n_nodes = mesh->n_nodes,
                                      .places = (double(*)[3])mesh->nodes,
                                      .n_elements = mesh->n_elements,
                                      .shapes = shapes,
                                      .corners = mesh->elements,
                                      .materials = made.of_element,
                                      .thickness = mesh->sheets != NULL ? thickness : NULL,
                                      .layers = body->sheet.layers};
    solid_create(solid, &parts, made.n, made.list, isa);
    made_of_clear(&made);
    free(shapes);
    free(thickness);
}

static void add_masses(struct solid *solid, const struct solid_mesh *mesh,
                       const struct job_body *body)
{
    for (int k = 0; k < body->solid.n_masses; k++) {
        const struct solid_plan_mass share = solid_plan_mass(body, mesh, k);
        for (int j = 0; j < share.set->n_nodes; j++)
            solid_add_mass(solid, share.set->nodes[j], share.mass, share.inertia);
    }
}

static void add_support(struct solid *solid, const struct solid_condition *condition)
{
    static const enum solid_support_kind kinds[] = {
        [SOLID_CONDITION_FIXED] = SOLID_SUPPORT_FIXED,
        [SOLID_CONDITION_DISPLACEMENT] = SOLID_SUPPORT_DISPLACEMENT,
        [SOLID_CONDITION_VELOCITY] = SOLID_SUPPORT_VELOCITY};
    struct solid_table table = solid_table_of(condition);
    for (int d = 0; d < 3; d++)
        if ((condition->turns >> d & 1) != 0)
            solid_supports_add_turn(&solid->supports, SOLID_SUPPORT_FIXED, d, &table,
                                    condition->set->n_nodes, condition->set->nodes);
    if (condition->kind == SOLID_CONDITION_MOTION)
        solid_supports_add_motion(&solid->supports, condition->n_motions, condition->motions,
                                  condition->set->n_nodes, condition->set->nodes);
    for (int d = 0; d < 3; d++)
        if ((condition->directions >> d & 1) != 0)
            solid_supports_add(&solid->supports, kinds[condition->kind], d, &table,
                               condition->set->n_nodes, condition->set->nodes);
    solid_table_clear(&table);
}

static void add_load(struct solid *solid, const struct solid_condition *condition)
{
    const struct solid_mesh_set *set = condition->set;
    const bool varies = condition->n > 0;
    const double value = varies ? 1.0 : condition->constant;
    struct solid_table table = solid_table_of(condition);
    if (condition->kind == SOLID_CONDITION_FORCE) {
        const double share = value / set->n_nodes;
        const struct vec3 force = {(condition->directions & 1) != 0 ? share : 0.0,
                                   (condition->directions & 2) != 0 ? share : 0.0,
                                   (condition->directions & 4) != 0 ? share : 0.0};
        solid_loads_add_force(&solid->loads, force, varies ? &table : NULL, set->n_nodes,
                              set->nodes);
    } else {
        struct solid_side *sides = array_allocate((size_t)set->n_sides, sizeof *sides);
        for (int k = 0; k < set->n_sides; k++)
            sides[k] = (struct solid_side){set->sides[k].element, set->sides[k].side};
        solid_loads_add_pressure(&solid->loads, value, varies ? &table : NULL, set->n_sides,
                                 sides);
        free(sides);
    }
    solid_table_clear(&table);
}

static void prescribe(struct solid *solid, const struct solid_mesh *mesh,
                      const struct job_body *body)
{
    const struct vec3 v = body->solid.velocity;
    solid->damping = body->solid.damping.mass;
    for (int k = 0; k < body->solid.n_boundary; k++) {
        const struct solid_condition condition =
            solid_condition_of(&body->solid.boundary[k], mesh);
        if (condition.kind == SOLID_CONDITION_FORCE ||
            condition.kind == SOLID_CONDITION_PRESSURE)
            add_load(solid, &condition);
        else
            add_support(solid, &condition);
    }
    for (int i = 0; i < solid->n_nodes; i++) {
        double *at = solid_velocity(solid, i);
        at[0] = v.x;
        at[1] = v.y;
        at[2] = v.z;
    }
}

static void add_balls(struct deform *deform, struct deform_body *own,
                      const struct solid_mesh *mesh, struct body *body)
{
    const int n = body->mesh.n_corners;
    int *nodes = array_allocate(SOLID_BALL_INNER * (size_t)n, sizeof *nodes), n_none = 0;
    own->balls = solid_balls(mesh, &body->mesh, own->skin.nodes);
    own->inner = array_allocate(SOLID_BALL_INNER * (size_t)n, sizeof *own->inner);
    own->n_balls = n;
    for (int k = 0; k < n; k++) {
        for (int m = 0; m < SOLID_BALL_INNER; m++)
            nodes[SOLID_BALL_INNER * k + m] =
                m < own->balls[k].n_inner ? own->balls[k].inner[m] : -1;
        n_none += own->balls[k].n_inner == 0;
    }
    deform_skin_add(&own->skin, body, mesh->n_nodes, SOLID_BALL_INNER * n, nodes, own->inner);
    if (n_none > 0)
        report_warn("body '%s': %d nodes of its surface lie on nothing that is deeper in; they "
                    "touch no bodies",
                    body->name, n_none);
    deform->n_balls += n;
    free(nodes);
}

static void build_body(struct deform *deform, const struct simulation *sim, int b, enum isa isa)
{
    struct deform_body *own = &deform->list[deform->n++];
    const struct job_body *body = &sim->job->bodies[b];
    struct body_skin *skin = sim->bodies.list[b].skin;
    struct solid_mesh built;
    *own = (struct deform_body){.body = b,
                                .first_node = deform->n_nodes,
                                .first_element = deform->n_elements,
                                .first_ball = deform->n_balls};
    const struct solid_mesh *mesh = solid_mesh_borrow(body, &built);
    build_solid(&own->solid, mesh, body, sim->job, isa);
    add_masses(&own->solid, mesh, body);
    prescribe(&own->solid, mesh, body);
    deform_share_init(&own->share, sim->comm, &own->solid);
    deform_skin_init(&own->skin, mesh, &sim->bodies.list[b]);
    deform_share_mark_rings(own);
    for (int v = 0; v < sim->bodies.list[b].mesh.n_corners; v++)
        skin->inverse_mass[v] = 1.0 / own->solid.mass[own->skin.nodes[v]];
    if (body->solid.touches.what != JOB_TOUCHES_SPHERES)
        add_balls(deform, own, mesh, &sim->bodies.list[b]);
    deform_skin_renew(own, &sim->bodies.list[b]);
    deform->n_nodes += own->solid.n_nodes;
    deform->n_elements += own->solid.n_elements;
    deform->sheets = deform->sheets || own->solid.shell != NULL;
    deform->turns = deform->turns || own->solid.turns.n_nodes > 0;
    solid_mesh_clear(&built);
}

void deform_init(struct deform *deform, const struct simulation *sim, enum isa isa)
{
    *deform = (struct deform){.substeps = sim->job->time.substeps};
    deform->list = array_allocate((size_t)sim->bodies.n, sizeof *deform->list);
    deform->near = array_allocate((size_t)sim->comm->n_ranks, sizeof *deform->near);
    deform->pushing = array_allocate((size_t)sim->comm->n_ranks, sizeof *deform->pushing);
    comm_mail_init(&deform->mail, sim->comm);
    for (int b = 0; b < sim->bodies.n; b++)
        if (job_deforms(&sim->job->bodies[b]))
            build_body(deform, sim, b, isa);
}

void deform_clear(struct deform *deform, const struct comm *comm)
{
    for (int k = 0; k < deform->n; k++) {
        solid_destroy(&deform->list[k].solid);
        deform_share_clear(&deform->list[k].share, comm);
        deform_skin_clear(&deform->list[k].skin);
        free(deform->list[k].balls);
        free(deform->list[k].inner);
    }
    comm_mail_clear(&deform->mail);
    free(deform->near);
    free(deform->pushing);
    free(deform->list);
    *deform = (struct deform){0};
}

/* ---- The step
 * --------------------------------------------------------------------------------- */

void deform_place(struct simulation *sim)
{
    for (int k = 0; k < sim->deform.n; k++)
        deform_skin_place(&sim->deform.list[k], &sim->bodies.list[sim->deform.list[k].body]);
}

void deform_place_faces(const struct simulation *sim)
{
    for (int k = 0; k < sim->deform.n; k++)
        deform_skin_place_faces(&sim->deform.list[k],
                                &sim->bodies.list[sim->deform.list[k].body]);
}

void deform_agree(struct simulation *sim)
{
    for (int k = 0; k < sim->deform.n; k++)
        comm_max(sim->comm, &sim->bodies.list[sim->deform.list[k].body].speed_max, 1);
}

/* Which element failed, and how. */
static void explain(const struct simulation *sim, const struct deform_body *deform, char *what,
                    size_t size)
{
    static const char *const failures[] = {[SOLID_LIMITS_FINE] = "has failed",
                                           [SOLID_LIMITS_INVERTED] = "is turned inside out",
                                           [SOLID_LIMITS_NOT_A_NUMBER] =
                                               "is no more at places that are numbers"};
    const struct solid_limits_fault fault =
        solid_limits_fault(&deform->solid, deform_dt(&sim->deform, sim->dt));
    snprintf(what, size, "element %d of body '%.60s' at (%.5g, %.5g, %.5g) m %s",
             fault.element + 1, sim->bodies.list[deform->body].name, fault.place.x,
             fault.place.y, fault.place.z, failures[fault.failure]);
}

/* Of the elements, in a step of theirs within the run's. */
static void find_forces(struct simulation *sim, struct deform_body *deform, int substep)
{
    if (sim->deform.failed ||
        solid_forces(&deform->solid, deform_step(&sim->deform, sim->step) + substep,
                     deform_dt(&sim->deform, sim->dt)))
        return;
    sim->deform.failed = true;
    explain(sim, deform, sim->watch.what, sizeof sim->watch.what);
}

void deform_plan(struct simulation *sim)
{
    deform_share_push(sim);
    const double began = timer_now();
    for (int k = 0; k < sim->deform.n; k++) {
        struct deform_body *deform = &sim->deform.list[k];
        struct solid *solid = &deform->solid;
        deform_skin_take_forces(deform, &sim->bodies.list[deform->body]);
        solid->gravity[0] = sim->gravity.x;
        solid->gravity[1] = sim->gravity.y;
        solid->gravity[2] = sim->gravity.z;
        find_forces(sim, deform, 0);
    }
    sim->balance.busy += timer_now() - began;
}

static void move_all(struct simulation *sim, int substep)
{
    const double began = timer_now();
    for (int k = 0; k < sim->deform.n; k++) {
        struct deform_body *deform = &sim->deform.list[k];
        const int64_t step = deform_step(&sim->deform, sim->step) + substep;
        if (substep > 0)
            find_forces(sim, deform, substep);
        if (substep + 1 < sim->deform.substeps)
            solid_move_on(&deform->solid, step, deform_dt(&sim->deform, sim->dt));
        else
            solid_move(&deform->solid, step, deform_dt(&sim->deform, sim->dt));
    }
    sim->balance.busy += timer_now() - began;
}

void deform_move(struct simulation *sim)
{
    for (int k = 0; k < sim->deform.n; k++)
        sim->deform.list[k].speed = 0.0;
    for (int substep = 0; substep < sim->deform.substeps; substep++) {
        move_all(sim, substep);
        deform_share_tell(sim);
        deform_place(sim);
        for (int k = 0; k < sim->deform.n; k++)
            sim->deform.list[k].speed += sim->bodies.list[sim->deform.list[k].body].speed_max;
    }
    sim->deform.spent = 0.0;
    for (int k = 0; k < sim->deform.n; k++) {
        const int b = sim->deform.list[k].body;
        /* Over the step no vertex was faster than the fastest of its substeps in the mean. */
        sim->bodies.list[b].speed_max = sim->deform.list[k].speed / sim->deform.substeps;
        const double spent = sim->bodies.list[b].speed_max * sim->dt / sim->body_allowance[b];
        sim->deform.spent = spent > sim->deform.spent ? spent : sim->deform.spent;
    }
}

/* ---- What others ask
 * -------------------------------------------------------------------------- */

struct deform_sizes deform_sizes(const struct deform *deform)
{
    struct deform_sizes sizes = {0};
    for (int b = 0; b < deform->n; b++) {
        const struct deform_body *body = &deform->list[b];
        for (int i = 0; i < body->solid.n_nodes; i++) {
            sizes.n_nodes += body->solid.moves[i];
            sizes.n_copies += !body->solid.moves[i] && deform_share_has(body, i);
        }
        for (int e = 0; e < body->solid.n_elements; e++)
            sizes.n_elements += body->solid.slot[e] >= 0;
    }
    return sizes;
}

/* What hourglass modes may hold of a body's energy, motion and all, whatever else it holds: a
 * first touch loads single nodes. */
static const double LITTLE = 0.02;

/* Has a body too much energy in hourglass modes?  The rank with the worst element names it. */
static bool is_hourglass(struct simulation *sim, const struct deform_body *deform,
                         const struct solid_energies *energies)
{
    const double hourglass = solid_energy_value(energies, SOLID_ENERGY_HOURGLASS) +
                             solid_energy_value(energies, SOLID_ENERGY_HOURGLASS_DAMPED);
    const double internal = hourglass + solid_energy_value(energies, SOLID_ENERGY_ELASTIC) +
                            solid_energy_value(energies, SOLID_ENERGY_PLASTIC) +
                            solid_energy_value(energies, SOLID_ENERGY_DAMPED);
    const double share = sim->job->watch.hourglass;
    const double all = internal + solid_energy_value(energies, SOLID_ENERGY_KINETIC);
    if (!(share > 0.0) || hourglass <= share * internal || hourglass <= LITTLE * all)
        return false;
    const struct solid_limits_fault fault =
        solid_limits_hourglass(&deform->solid, hourglass, internal, share);
    const struct solid_element_state *worst = &deform->solid.state[fault.element];
    const double own =
        fault.element >= 0 ? worst->hourglass_work + worst->hourglass_damped : -1.0;
    double most = own;
    comm_max(sim->comm, &most, 1);
    if (own == most)
        snprintf(sim->watch.what, sizeof sim->watch.what,
                 "%.3g of the internal energy of body '%.60s', most in element %d at (%.5g, "
                 "%.5g, %.5g) m",
                 hourglass / internal, sim->bodies.list[deform->body].name, fault.element + 1,
                 fault.place.x, fault.place.y, fault.place.z);
    return true;
}

void deform_energies(struct simulation *sim, struct solid_energies *energies)
{
    sim->deform.hourglass = false;
    for (int k = 0; k < sim->deform.n; k++) {
        struct solid_energies own = {.sums = {{{0}, 0, 0}}};
        solid_energies_add(&sim->deform.list[k].solid, deform_step(&sim->deform, sim->step),
                           deform_dt(&sim->deform, sim->dt), &own);
        exact_sum_reduce(sim->comm, own.sums, SOLID_N_ENERGIES);
        for (int e = 0; e < SOLID_N_ENERGIES; e++)
            exact_sum_merge(&energies->sums[e], &own.sums[e]);
        if (is_hourglass(sim, &sim->deform.list[k], &own))
            sim->deform.hourglass = true;
    }
}

/* Of one body.  Several elements may allow as little: where it is too little the first is
 * found. */
static struct deform_limit find_limit(const struct simulation *sim, int k, bool touched)
{
    const struct deform_body *deform = &sim->deform.list[k];
    struct node_springs springs;
    node_springs_find(&springs, sim, k);
    node_springs_slow(&springs, deform->solid.n_nodes, sim->deform.substeps);
    const struct solid_limits own =
        solid_limits_within(&deform->solid, springs.stiffness, springs.damping, touched,
                            deform_dt(&sim->deform, sim->dt) / sim->job->watch.step);
    const double step = sim->deform.substeps * own.step;
    struct deform_limit limit = {step, deform->body, -1, -1};
    comm_min(sim->comm, &limit.step, 1);
    if (sim->dt > sim->job->watch.step * limit.step) {
        const bool is_least = own.element >= 0 && step == limit.step;
        double first = is_least ? own.element : (double)INFINITY;
        comm_min(sim->comm, &first, 1);
        limit.element = is_least && own.element == first ? own.element : -1;
        limit.node = limit.element >= 0 ? own.node : -1;
    }
    node_springs_clear(&springs);
    return limit;
}

struct deform_limit deform_critical_step(const struct simulation *sim, bool touched)
{
    struct deform_limit least = {(double)INFINITY, -1, -1, -1};
    double *touches = array_allocate((size_t)sim->deform.n, sizeof *touches);
    if (touched) {
        node_springs_touched(sim, touches);
        comm_max(sim->comm, touches, sim->deform.n);
    }
    for (int k = 0; k < sim->deform.n; k++) {
        if (touched && !(touches[k] > 0.0))
            continue;
        const struct deform_limit limit = find_limit(sim, k, touched);
        if (limit.step < least.step)
            least = limit;
    }
    free(touches);
    return least;
}

int deform_name_limit(const struct simulation *sim, const struct deform_limit *limit,
                      char *text, int size)
{
    int k = 0;
    if (limit->element < 0)
        return 0;
    while (sim->deform.list[k].body != limit->body)
        k++;
    const struct solid *solid = &sim->deform.list[k].solid;
    const bool is_node = limit->node >= 0;
    const int node = is_node ? limit->node : solid->corners[limit->element][0];
    const double *at = solid_place(solid, node);
    return snprintf(text, (size_t)size, "%s %d of body '%.40s' at (%.5g, %.5g, %.5g) m",
                    is_node ? "node" : "element", (is_node ? node : limit->element) + 1,
                    sim->bodies.list[limit->body].name, at[0], at[1], at[2]);
}
