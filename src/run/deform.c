/* See deform.h. */
#include "run/deform.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "model/solid_condition.h"
#include "model/solid_mesh.h"
#include "run/simulation.h"
#include "solid/solid_limits.h"
#include "store/checkpoint.h"
#include "store/table.h"

/* ---- Building
 * --------------------------------------------------------------------------------- */

static void build_solid(struct solid *solid, const struct solid_mesh *mesh,
                        const struct job_body *body, const struct job_material *from,
                        enum isa isa)
{
    enum solid_element_shape *shapes = array_allocate((size_t)mesh->n_elements, sizeof *shapes);
    for (int e = 0; e < mesh->n_elements; e++)
        shapes[e] = solid_mesh_n_corners(mesh->elements[e]) == 8 ? SOLID_ELEMENT_HEXAHEDRON
                                                                 : SOLID_ELEMENT_TETRAHEDRON;
    const struct solid_yield_point line = {0.0, from->yield};
    struct solid_yield_point *points =
        array_allocate((size_t)from->n_hardening_table, sizeof *points);
    for (int k = 0; k < from->n_hardening_table; k++)
        points[k] = (struct solid_yield_point){from->hardening_table[k].strain,
                                               from->hardening_table[k].stress};
    const bool stiff = body->solid.hourglass.kind == JOB_HOURGLASS_STIFFNESS;
    const double held = body->solid.hourglass.coefficient;
    const struct solid_material material = {
        .density = from->density,
        .young = from->young,
        .poisson = from->poisson,
        .damping = body->solid.damping.stiffness,
        .hourglass_stiffness = stiff ? held : 0.0,
        .hourglass_viscosity = stiff ? 0.0 : held,
        .n_yield = from->n_hardening_table > 0 ? from->n_hardening_table : from->yield > 0.0,
        .yield = from->n_hardening_table > 0 ? points : &line,
        .hardening = from->n_hardening_table > 0 ? 0.0 : from->hardening,
    };
    const struct solid_parts parts = {.n_nodes = mesh->n_nodes,
                                      .places = (double(*)[3])mesh->nodes,
                                      .n_elements = mesh->n_elements,
                                      .shapes = shapes,
                                      .corners = mesh->elements};
    solid_create(solid, &parts, 1, &material, isa);
    free(shapes);
    free(points);
}

static void add_support(struct solid *solid, const struct solid_condition *condition)
{
    static const enum solid_support_kind kinds[] = {
        [SOLID_CONDITION_FIXED] = SOLID_SUPPORT_FIXED,
        [SOLID_CONDITION_DISPLACEMENT] = SOLID_SUPPORT_DISPLACEMENT,
        [SOLID_CONDITION_VELOCITY] = SOLID_SUPPORT_VELOCITY};
    struct solid_table table = solid_table_of(condition);
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

struct place_of_node {
    double along; /* [m] */
    int node;
};

static int compare_places(const void *a, const void *b)
{
    const struct place_of_node *p = a, *q = b;
    if (p->along != q->along)
        return p->along < q->along ? -1 : 1;
    return (p->node > q->node) - (p->node < q->node);
}

static int longest_side(const struct solid *solid)
{
    double size[3];
    int longest = 0;
    for (int d = 0; d < 3; d++) {
        double low = solid->reference[0][d], high = low;
        for (int i = 1; i < solid->n_nodes; i++) {
            low = solid->reference[i][d] < low ? solid->reference[i][d] : low;
            high = solid->reference[i][d] > high ? solid->reference[i][d] : high;
        }
        size[d] = high - low;
        longest = size[d] > size[longest] ? d : longest;
    }
    return longest;
}

/* Slabs with as many nodes each. */
static void share_out(struct deform_body *deform, const struct comm *comm)
{
    struct solid *solid = &deform->solid;
    const int along = longest_side(solid), n = solid->n_nodes;
    struct place_of_node *order = array_allocate((size_t)n, sizeof *order);
    bool *moves = array_allocate((size_t)n, sizeof *moves);
    deform->owner = array_allocate((size_t)n, sizeof *deform->owner);
    for (int i = 0; i < n; i++)
        order[i] = (struct place_of_node){solid->reference[i][along], i};
    qsort(order, (size_t)n, sizeof *order, compare_places);
    deform->by_owner = array_allocate((size_t)n, sizeof *deform->by_owner);
    deform->sizes = array_allocate((size_t)comm->n_ranks, sizeof *deform->sizes);
    for (int k = 0; k < n; k++) {
        const int q = (int)((int64_t)k * comm->n_ranks / n);
        deform->by_owner[k] = order[k].node;
        deform->owner[order[k].node] = q;
        deform->sizes[q] += (int)sizeof *solid->node;
        deform->first_own += q < comm->rank;
    }
    if (comm->n_ranks > 1)
        deform->told = array_allocate_rows((size_t)n, sizeof *deform->told);
    comm_mail_init(&deform->mail, comm);
    for (int i = 0; i < n; i++)
        moves[i] = deform->owner[i] == comm->rank;
    solid_assign(solid, moves);
    free(moves);
    free(order);
}

static void build_body(struct deform *deform, const struct simulation *sim, int b, enum isa isa)
{
    struct deform_body *own = &deform->list[deform->n++];
    const struct job_body *body = &sim->job->bodies[b];
    struct body_skin *skin = sim->bodies.list[b].skin;
    struct solid_mesh mesh;
    int n_vertices, (*facets)[4];
    *own = (struct deform_body){
        .body = b, .first_node = deform->n_nodes, .first_element = deform->n_elements};
    solid_mesh_build(&mesh, body);
    solid_mesh_skin(&mesh, &n_vertices, &own->nodes, &facets);
    CHECK(n_vertices == sim->bodies.list[b].mesh.n_corners, "a skin of %d vertices",
          n_vertices);
    build_solid(&own->solid, &mesh, body, &sim->job->materials[body->material], isa);
    prescribe(&own->solid, &mesh, body);
    share_out(own, sim->comm);
    for (int v = 0; v < n_vertices; v++)
        skin->inverse_mass[v] = 1.0 / own->solid.mass[own->nodes[v]];
    deform->n_nodes += own->solid.n_nodes;
    deform->n_elements += own->solid.n_elements;
    free(facets);
    solid_mesh_clear(&mesh);
}

void deform_init(struct deform *deform, const struct simulation *sim, enum isa isa)
{
    *deform = (struct deform){0};
    deform->list = array_allocate((size_t)sim->bodies.n, sizeof *deform->list);
    for (int b = 0; b < sim->bodies.n; b++)
        if (sim->job->bodies[b].model == JOB_MODEL_SOLID)
            build_body(deform, sim, b, isa);
}

void deform_clear(struct deform *deform)
{
    for (int k = 0; k < deform->n; k++) {
        solid_destroy(&deform->list[k].solid);
        free(deform->list[k].nodes);
        free(deform->list[k].owner);
        free(deform->list[k].by_owner);
        free(deform->list[k].sizes);
        free(deform->list[k].told);
        comm_mail_clear(&deform->list[k].mail);
    }
    free(deform->list);
    *deform = (struct deform){0};
}

/* ---- The step
 * --------------------------------------------------------------------------------- */

static struct vec3 vec3_of(const double *lane)
{
    return (struct vec3){lane[0], lane[1], lane[2]};
}

static void place_skin(const struct deform_body *deform, struct body *body)
{
    struct mesh *mesh = &body->mesh;
    double speed2_max = 0.0;
    for (int v = 0; v < mesh->n_corners; v++) {
        const int node = deform->nodes[v];
        const struct vec3 velocity = vec3_of(solid_velocity(&deform->solid, node));
        const double speed2 = vec3_dot(velocity, velocity);
        mesh->place[v] = vec3_of(solid_place(&deform->solid, node));
        body->skin->velocity[v] = velocity;
        memset(body->skin->force[v], 0, sizeof body->skin->force[v]);
        speed2_max = speed2 > speed2_max ? speed2 : speed2_max;
    }
    for (int v = mesh->n_corners; v < mesh->n_vertices; v++) {
        struct vec3 mean = {0.0, 0.0, 0.0};
        for (int k = 0; k < 4; k++)
            mean = vec3_axpy(mean, 0.25, mesh->place[mesh->mean_of[v - mesh->n_corners][k]]);
        mesh->place[v] = mean;
    }
    body->speed_max = sqrt(speed2_max);
    mesh_update(mesh);
}

void deform_begin(struct simulation *sim)
{
    for (int k = 0; k < sim->deform.n; k++)
        place_skin(&sim->deform.list[k], &sim->bodies.list[sim->deform.list[k].body]);
}

/* Sums of nothing are zero in every limb. */
static bool is_pushed(const struct exact_sum force[3])
{
    for (int x = 0; x < 3; x++)
        if ((force[x].limb[0] | force[x].limb[1] | force[x].limb[2] | force[x].overflow) != 0)
            return true;
    return false;
}

/* What this rank's spheres do to nodes that others move goes to these. */
struct push {
    int vertex;
    struct exact_sum force[3];
};

static void exchange_pushes(const struct simulation *sim, struct deform_body *deform,
                            struct body_skin *skin)
{
    const struct comm *comm = sim->comm;
    const int n = sim->bodies.list[deform->body].mesh.n_corners;
    struct push push;
    memset(&push, 0, sizeof push);
    comm_mail_begin(&deform->mail);
    for (int v = 0; v < n; v++) {
        const int owner = deform->owner[deform->nodes[v]];
        if (owner == comm->rank || !is_pushed(skin->force[v]))
            continue;
        push.vertex = v;
        memcpy(push.force, skin->force[v], sizeof push.force);
        comm_mail_pack(&deform->mail, owner, &push, sizeof push);
    }
    comm_mail_exchange(&deform->mail, comm);
    for (int q = 0; q < comm->n_ranks; q++)
        while (comm_mail_waits(&deform->mail, q)) {
            comm_mail_unpack(&deform->mail, q, &push, sizeof push);
            for (int x = 0; x < 3; x++)
                exact_sum_merge(&skin->force[push.vertex][x], &push.force[x]);
        }
}

/* Which element failed, and how. */
static void explain(const struct simulation *sim, const struct deform_body *deform, char *what,
                    size_t size)
{
    static const char *const failures[] = {[SOLID_LIMITS_FINE] = "has failed",
                                           [SOLID_LIMITS_INVERTED] = "is turned inside out",
                                           [SOLID_LIMITS_NOT_A_NUMBER] =
                                               "is no more at places that are numbers"};
    const struct solid_limits_fault fault = solid_limits_fault(&deform->solid, sim->dt);
    snprintf(what, size, "element %d of body '%.60s' at (%.5g, %.5g, %.5g) m %s",
             fault.element + 1, sim->bodies.list[deform->body].name, fault.place.x,
             fault.place.y, fault.place.z, failures[fault.failure]);
}

void deform_plan(struct simulation *sim)
{
    sim->deform.failed = false;
    for (int k = 0; k < sim->deform.n; k++) {
        struct deform_body *deform = &sim->deform.list[k];
        const struct body *body = &sim->bodies.list[deform->body];
        struct solid *solid = &deform->solid;
        if (sim->comm->n_ranks > 1)
            exchange_pushes(sim, deform, body->skin);
        for (int v = 0; v < body->mesh.n_corners; v++) {
            double *force = solid->contact[deform->nodes[v]];
            for (int x = 0; x < 3; x++)
                force[x] = exact_sum_value(&body->skin->force[v][x]);
        }
        solid->gravity[0] = sim->gravity.x;
        solid->gravity[1] = sim->gravity.y;
        solid->gravity[2] = sim->gravity.z;
        if (!solid_forces(solid, sim->step, sim->dt)) {
            sim->deform.failed = true;
            explain(sim, deform, sim->watch.what, sizeof sim->watch.what);
        }
    }
}

/* Nodes' places and velocities from those who moved them. */
static void tell_places(struct deform_body *deform, const struct comm *comm)
{
    struct solid *solid = &deform->solid;
    const int n_own = deform->sizes[comm->rank] / (int)sizeof *solid->node;
    for (int k = deform->first_own; k < deform->first_own + n_own; k++)
        deform->told[k] = solid->node[deform->by_owner[k]];
    comm_gather_parts(comm, deform->told, deform->sizes);
    for (int k = 0; k < solid->n_nodes; k++)
        solid->node[deform->by_owner[k]] = deform->told[k];
}

void deform_move(struct simulation *sim)
{
    for (int k = 0; k < sim->deform.n; k++) {
        struct deform_body *deform = &sim->deform.list[k];
        solid_move(&deform->solid, sim->step, sim->dt);
        if (sim->comm->n_ranks > 1)
            tell_places(deform, sim->comm);
    }
}

/* ---- What others ask
 * -------------------------------------------------------------------------- */

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
    if (!(share > 0.0) || hourglass <= share * internal)
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
        solid_energies_add(&sim->deform.list[k].solid, sim->step, sim->dt, &own);
        exact_sum_reduce(sim->comm, own.sums, SOLID_N_ENERGIES);
        for (int e = 0; e < SOLID_N_ENERGIES; e++)
            exact_sum_merge(&energies->sums[e], &own.sums[e]);
        if (is_hourglass(sim, &sim->deform.list[k], &own))
            sim->deform.hourglass = true;
    }
}

double deform_critical_step(const struct simulation *sim, int *body)
{
    double least = (double)INFINITY;
    for (int k = 0; k < sim->deform.n; k++) {
        double step = solid_limits_find(&sim->deform.list[k].solid, NULL, NULL).step;
        comm_min(sim->comm, &step, 1);
        if (step < least) {
            least = step;
            *body = sim->deform.list[k].body;
        }
    }
    return least;
}

/* ---- State
 * ------------------------------------------------------------------------------------ */

enum { NODES, ELEMENTS };

/* Copies the fields of a node or element behind each other into a record (`pack`), or back. */
static void move_fields(const struct solid *solid, int which, int i, unsigned char *record,
                        bool pack)
{
    const int n = which == NODES ? SOLID_NODE_N_FIELDS : SOLID_ELEMENT_N_FIELDS;
    const struct field *fields = which == NODES ? solid_node_fields : solid_element_fields;
    for (int f = 0; f < n; f++) {
        const struct field_view view =
            which == NODES ? solid_node_view(solid, (enum solid_node_field)f)
                           : solid_element_view(solid, (enum solid_element_field)f);
        const size_t size = field_size(&fields[f]);
        memcpy(pack ? record : field_at(&view, i), pack ? field_at(&view, i) : record, size);
        record += size;
    }
}

/* Nodes or elements of a solid, and the id of the first. */
static int rows_of(const struct deform_body *deform, int which, int64_t *first)
{
    *first = which == NODES ? deform->first_node : deform->first_element;
    return which == NODES ? deform->solid.n_nodes : deform->solid.n_elements;
}

static void collect(struct table *table, const struct simulation *sim, int which, int64_t begin,
                    int64_t end)
{
    unsigned char *record = array_allocate(1, table->record_size);
    for (int k = 0; k < sim->deform.n; k++) {
        const struct solid *solid = &sim->deform.list[k].solid;
        int64_t id;
        const int n = rows_of(&sim->deform.list[k], which, &id);
        for (int i = 0; i < n; i++, id++) {
            const bool counts = which == NODES ? solid->moves[i] : solid_counts(solid, i);
            if (!counts || id < begin || id >= end)
                continue;
            memcpy(record, &id, sizeof id);
            move_fields(solid, which, i, record + sizeof id, true);
            table_append(table, record, 1);
        }
    }
    free(record);
}

static void collect_nodes(struct table *table, const void *from, int64_t begin, int64_t end)
{
    collect(table, from, NODES, begin, end);
}

static void collect_elements(struct table *table, const void *from, int64_t begin, int64_t end)
{
    collect(table, from, ELEMENTS, begin, end);
}

int deform_tables(const struct simulation *sim, struct checkpoint_more *tables)
{
    if (sim->deform.n == 0)
        return 0;
    tables[NODES] = (struct checkpoint_more){.name = "nodes",
                                             .n_fields = SOLID_NODE_N_FIELDS,
                                             .fields = solid_node_fields,
                                             .n_ids = sim->deform.n_nodes,
                                             .collect = collect_nodes,
                                             .from = sim};
    tables[ELEMENTS] = (struct checkpoint_more){.name = "elements",
                                                .n_fields = SOLID_ELEMENT_N_FIELDS,
                                                .fields = solid_element_fields,
                                                .n_ids = sim->deform.n_elements,
                                                .collect = collect_elements,
                                                .from = sim};
    return 2;
}

void deform_restore(struct simulation *sim, const struct checkpoint_more *tables)
{
    for (int k = 0; k < sim->deform.n; k++) {
        struct solid *solid = &sim->deform.list[k].solid;
        for (int which = 0; which < 2; which++) {
            int64_t id;
            const int n = rows_of(&sim->deform.list[k], which, &id);
            for (int i = 0; i < n; i++, id++)
                move_fields(solid, which, i,
                            tables[which].records + (size_t)id * tables[which].record_size +
                                sizeof id,
                            false);
        }
        bool *moves = array_allocate((size_t)solid->n_nodes, sizeof *moves);
        memcpy(moves, solid->moves, (size_t)solid->n_nodes * sizeof *moves);
        solid_assign(solid, moves);
        free(moves);
    }
}
