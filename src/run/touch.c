/* See touch.h. */
#include "run/touch.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "contact/facet_step.h"
#include "job/job.h"
#include "model/rigid.h"
#include "model/solid_ball.h"
#include "physics/critical_step.h"
#include "run/simulation.h"
#include "store/checkpoint.h"
#include "store/table.h"

/* A face of a ball's own body counts if it was farther than this at the start, in radii. */
static const double APART = 2.0;

static bool is_on(const struct touch *touch)
{
    return touch->n_balls > 0;
}

/* The body of a ball among those that deform, and its vertex. */
struct where {
    int deform, vertex;
};

static struct where find_ball(const struct deform *deform, int ball)
{
    int b = 0;
    while (b + 1 < deform->n && deform->list[b + 1].first_ball <= ball)
        b++;
    return (struct where){b, ball - deform->list[b].first_ball};
}

/* ---- Building
 * --------------------------------------------------------------------------------- */

static void build_materials(struct materials *materials, const struct job *job)
{
    const size_t n = (size_t)job->n_materials;
    materials->n = job->n_materials;
    materials->pairs = array_allocate(n * n, sizeof *materials->pairs);
    for (int k = 0; k < job->n_pairs; k++) {
        const int a = job->pairs[k].a, b = job->pairs[k].b;
        materials->pairs[a * job->n_materials + b] =
            materials->pairs[b * job->n_materials + a] = material_touch(job, &job->pairs[k]);
    }
}

/* Was a face of the ball's own body apart from it at the start? */
static bool was_apart(const struct mesh *mesh, int face, struct vec3 centre, double radius)
{
    const struct mesh_face *f = &mesh->faces[face];
    struct vec3 middle = {0.0, 0.0, 0.0};
    double reach2 = 0.0;
    for (int k = 0; k < f->n; k++)
        middle = vec3_axpy(middle, 1.0 / f->n, mesh->reference[f->vertices[k]]);
    for (int k = 0; k < f->n; k++) {
        const struct vec3 arm = vec3_sub(mesh->reference[f->vertices[k]], middle);
        reach2 = vec3_dot(arm, arm) > reach2 ? vec3_dot(arm, arm) : reach2;
    }
    return vec3_norm(vec3_sub(centre, middle)) > sqrt(reach2) + APART * radius;
}

/* Means over a ball's nodes of what `of` gives. */
static struct vec3 mean_of(const struct solid *solid, const struct solid_ball *ball,
                           const double *(*of)(const struct solid *, int))
{
    const double *p = of(solid, ball->outer);
    double q[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < ball->n_inner; k++)
        for (int x = 0; x < 3; x++)
            q[x] += of(solid, ball->inner[k])[x];
    for (int x = 0; x < 3; x++)
        q[x] = p[x] + ball->part * (q[x] / ball->n_inner - p[x]);
    return (struct vec3){q[0], q[1], q[2]};
}

static const double *place(const struct solid *solid, int i)
{
    return solid_place(solid, i);
}

static const double *velocity(const struct solid *solid, int i)
{
    return solid_velocity(solid, i);
}

static const double *reference(const struct solid *solid, int i)
{
    return solid->reference[i];
}

/* May a ball touch this feature? */
static bool meets(const void *from, int sphere, int body, int feature)
{
    const struct simulation *sim = from;
    const struct where where = find_ball(&sim->deform, sim->touch.owned[sphere]);
    const struct deform_body *deform = &sim->deform.list[where.deform];
    const struct solid_ball *ball = &deform->balls[where.vertex];
    if (body != deform->body)
        return true;
    return sim->job->bodies[body].solid.touches.what == JOB_TOUCHES_ITSELF &&
           was_apart(&sim->bodies.list[body].mesh, feature,
                     mean_of(&deform->solid, ball, reference), ball->radius);
}

static double mean_radius(const struct deform *deform)
{
    double sum = 0.0;
    int n = 0;
    for (int b = 0; b < deform->n; b++)
        for (int k = 0; k < deform->list[b].n_balls; k++) {
            sum += deform->list[b].balls[k].radius;
            n += deform->list[b].balls[k].n_inner > 0;
        }
    return n > 0 ? sum / n : (double)INFINITY;
}

void touch_init(struct touch *touch, const struct simulation *sim, enum isa isa)
{
    *touch = (struct touch){
        .n_balls = sim->deform.n_balls, .n_changes = -1, .buffer = (double)INFINITY};
    if (!is_on(touch))
        return;
    touch->buffer = 0.5 * mean_radius(&sim->deform);
    const size_t n = (size_t)touch->n_balls;
    touch->owned = array_allocate(n, sizeof *touch->owned);
    touch->place = array_allocate(n, sizeof *touch->place);
    touch->width = array_allocate(n, sizeof *touch->width);
    touch->extents = array_allocate((size_t)sim->comm->n_ranks, sizeof *touch->extents);
    spheres_init(&touch->spheres);
    build_materials(&touch->materials, sim->job);
    facet_contacts_init(&touch->contacts, sim->bodies.n, isa);
    touch->contacts.width = touch->width;
    touch->contacts.meets = meets;
    touch->contacts.from = sim;
}

void touch_clear(struct touch *touch)
{
    if (!is_on(touch))
        return;
    free(touch->owned);
    free(touch->place);
    free(touch->width);
    free(touch->extents);
    free(touch->waiting);
    spheres_clear(&touch->spheres);
    facet_contacts_clear(&touch->contacts);
    materials_clear(&touch->materials);
    *touch = (struct touch){0};
}

/* ---- Who has which balls
 * ----------------------------------------------------------------------- */

static void put_ball(struct spheres *spheres, int i, const struct solid *solid,
                     const struct solid_ball *ball)
{
    const struct vec3 x = mean_of(solid, ball, place), v = mean_of(solid, ball, velocity);
    const double values[2][3] = {{x.x, x.y, x.z}, {v.x, v.y, v.z}};
    memcpy(spheres->motion[i].lane, values[0], sizeof values[0]);
    memcpy(spheres->motion[i].lane + 4, values[1], sizeof values[1]);
    spheres->force[i] = (struct sphere_row){{0.0}};
}

void touch_find_extents(struct simulation *sim)
{
    struct touch *touch = &sim->touch;
    const size_t n = (size_t)sim->comm->n_ranks;
    if (!is_on(touch))
        return;
    double *most = array_allocate(6 * n, sizeof *most);
    for (size_t k = 0; k < 6 * n; k++)
        most[k] = -1e300;
    for (int b = 0; b < sim->deform.n; b++) {
        const struct deform_body *deform = &sim->deform.list[b];
        const struct solid *solid = &deform->solid;
        for (int v = 0; v < deform->n_balls; v++) {
            const struct solid_ball *ball = &deform->balls[v];
            if (ball->n_inner == 0 || !solid->moves[ball->outer])
                continue;
            const struct vec3 centre = mean_of(solid, ball, place);
            const double at[3] = {centre.x, centre.y, centre.z};
            const double reach = ball->radius + sim->body_allowance[deform->body];
            double *extent =
                most + 6 * boxes_owner(&sim->boxes, solid_place(solid, ball->outer));
            for (int x = 0; x < 3; x++) {
                const double below = reach - at[x], above = at[x] + reach;
                extent[x] = below > extent[x] ? below : extent[x];
                extent[3 + x] = above > extent[3 + x] ? above : extent[3 + x];
            }
        }
    }
    comm_max(sim->comm, most, (int)(6 * n));
    for (size_t q = 0; q < n; q++)
        for (int x = 0; x < 3; x++) {
            touch->extents[q].low[x] = -most[6 * q + (size_t)x];
            touch->extents[q].high[x] = most[6 * q + 3 + (size_t)x];
        }
    free(most);
}

bool touch_reaches(const struct touch *touch, int rank, const double low[3],
                   const double high[3])
{
    if (!is_on(touch))
        return false;
    const struct touch_extent *extent = &touch->extents[rank];
    for (int x = 0; x < 3; x++)
        if (low[x] > extent->high[x] || high[x] < extent->low[x])
            return false;
    return true;
}

/* Contacts of all ranks' balls, on each. */
static struct facet_contact_record *gather_contacts(struct simulation *sim, int *n)
{
    const struct comm *comm = sim->comm;
    const struct touch *touch = &sim->touch;
    struct facet_contact_record *own = NULL;
    const int n_own =
        facet_contacts_records(&touch->contacts, &touch->spheres, 0, touch->n_balls, &own);
    struct facet_contact_record *all = comm_gather_records(comm, own, n_own, sizeof *own, n);
    free(own);
    return all;
}

/* Lists the balls whose nodes are moved here. */
static void list_balls(struct simulation *sim)
{
    struct touch *touch = &sim->touch;
    struct spheres *spheres = &touch->spheres;
    int n = 0;
    for (int ball = 0; ball < touch->n_balls; ball++) {
        const struct where where = find_ball(&sim->deform, ball);
        const struct deform_body *deform = &sim->deform.list[where.deform];
        const struct solid_ball *at = &deform->balls[where.vertex];
        touch->place[ball] = -1;
        if (at->n_inner == 0 || !deform->solid.moves[at->outer])
            continue;
        const double near = 1.0 - at->part, far = at->part / at->n_inner;
        double inverse_mass = near * near / deform->solid.mass[at->outer];
        for (int k = 0; k < at->n_inner; k++)
            inverse_mass += far * far / deform->solid.mass[at->inner[k]];
        spheres_reserve(spheres, n + 1);
        touch->owned[n] = ball;
        touch->place[ball] = n;
        touch->width[n] =
            sim->job->bodies[deform->body].solid.touches.stiffness * at->area / at->depth;
        spheres->id[n] = ball;
        spheres->material[n] = sim->bodies.list[deform->body].material;
        spheres->motion[n] =
            (struct sphere_row){{0.0, 0.0, 0.0, at->radius, 0.0, 0.0, 0.0, at->radius}};
        spheres->spin[n] =
            (struct sphere_row){{0.0, 0.0, 0.0, 1.0 / at->radius, 0.0, 0.0, 0.0, inverse_mass}};
        n++;
    }
    spheres->n_owned = spheres->n_all = n;
    spheres_reserve(spheres, n);
    spheres_pad(spheres);
}

/* Gives contacts to the lists of those who have their balls now. */
static void take_contacts(struct touch *touch, int n,
                          const struct facet_contact_record *records)
{
    int *spheres = array_allocate((size_t)n, sizeof *spheres);
    for (int r = 0; r < n; r++)
        spheres[r] = touch->place[records[r].id];
    facet_contacts_forget(&touch->contacts);
    facet_contacts_restore(&touch->contacts, n, records, spheres);
    free(spheres);
}

void touch_search(struct simulation *sim, bool all_pairs)
{
    struct touch *touch = &sim->touch;
    int64_t n_changes = 0;
    if (!is_on(touch))
        return;
    for (int b = 0; b < sim->deform.n; b++)
        n_changes += sim->deform.list[b].share.n_changes;
    if (n_changes != touch->n_changes) {
        int n = touch->n_waiting;
        struct facet_contact_record *records =
            touch->waiting != NULL ? touch->waiting : gather_contacts(sim, &n);
        list_balls(sim);
        take_contacts(touch, n, records);
        free(records);
        touch->waiting = NULL;
        touch->n_waiting = 0;
        touch->n_changes = n_changes;
    }
    touch_begin(sim);
    for (int i = 0; i < touch->spheres.n_owned; i++) {
        const struct where where = find_ball(&sim->deform, touch->owned[i]);
        touch->spheres.allowance[i] = sim->body_allowance[sim->deform.list[where.deform].body];
    }
    facet_contacts_search(&touch->contacts, &touch->spheres, &sim->bodies, sim->body_allowance,
                          all_pairs);
}

/* ---- The step
 * --------------------------------------------------------------------------------- */

void touch_begin(struct simulation *sim)
{
    struct touch *touch = &sim->touch;
    for (int i = 0; i < touch->spheres.n_owned; i++) {
        const struct where where = find_ball(&sim->deform, touch->owned[i]);
        const struct deform_body *deform = &sim->deform.list[where.deform];
        put_ball(&touch->spheres, i, &deform->solid, &deform->balls[where.vertex]);
    }
}

/* What bodies feel of balls goes to what they feel of spheres. */
static void merge_loads(struct simulation *sim)
{
    for (int b = 0; b < sim->bodies.n; b++) {
        struct body_load *from = &sim->touch.contacts.loads[b], *to = &sim->facets.loads[b];
        for (int x = 0; x < 3; x++) {
            exact_sum_merge(&to->force[x], &from->force[x]);
            exact_sum_merge(&to->torque[x], &from->torque[x]);
        }
        exact_sum_merge(&to->work, &from->work);
        exact_sum_merge(&to->wound, &from->wound);
        *from = (struct body_load){0};
    }
}

/* Gives what a ball feels to its two nodes and to what its body feels. */
static void push_ball(struct simulation *sim, int i)
{
    const struct where where = find_ball(&sim->deform, sim->touch.owned[i]);
    const struct deform_body *deform = &sim->deform.list[where.deform];
    const struct solid_ball *ball = &deform->balls[where.vertex];
    const struct body_skin *skin = sim->bodies.list[deform->body].skin;
    struct body_load *load = &sim->facets.loads[deform->body];
    const double *f = sim->touch.spheres.force[i].lane;
    const double *c = sim->touch.spheres.motion[i].lane;
    const int *inner = deform->inner + SOLID_BALL_INNER * where.vertex;
    const double share = ball->part / ball->n_inner;
    if (f[0] == 0.0 && f[1] == 0.0 && f[2] == 0.0)
        return;
    for (int x = 0; x < 3; x++) {
        const int y = (x + 1) % 3, z = (x + 2) % 3;
        struct exact_vector *outer = body_skin_push(skin, where.vertex);
        exact_vector_add(outer, x, f[x]);
        for (int m = 0; m < ball->n_inner; m++)
            exact_vector_add(
                outer, x, -exact_vector_add(body_skin_push(skin, inner[m]), x, share * f[x]));
        exact_sum_add(&load->force[x], f[x]);
        exact_sum_add(&load->torque[x], c[y] * f[z] - c[z] * f[y]);
    }
}

/* A ball whose centre is through the surface would feel it no more; and at the start bodies may
 * be in each other only by what rounding and coarse curves make of it.  In radii. */
static const double THROUGH = 0.9, AT_START = 0.2;

static void watch_depth(struct simulation *sim)
{
    const struct touch *touch = &sim->touch;
    const double most = sim->step == 0 ? AT_START : THROUGH;
    if (!(touch->contacts.overlap_max > most) || sim->deform.failed)
        return;
    for (int k = 0; k < touch->contacts.n; k++) {
        const struct facet_contact *contact = &touch->contacts.list[k];
        const int i = contact->sphere;
        const double below =
            sim->bodies.list[contact->body].skin != NULL
                ? facet_contacts_reach(&touch->contacts, &touch->spheres, &sim->bodies, k)
                : 0.0;
        const double depth = contact->overlap > below ? contact->overlap : below;
        if (!facet_contact_touched(contact) ||
            !(depth > most * sphere_radius(&touch->spheres, i)))
            continue;
        const struct where where = find_ball(&sim->deform, touch->owned[i]);
        const struct deform_body *deform = &sim->deform.list[where.deform];
        const double *at = solid_place(&deform->solid, deform->balls[where.vertex].outer);
        sim->deform.failed = true;
        char reach[48] = "at the start; move them apart";
        if (sim->step > 0)
            snprintf(reach, sizeof reach, "its contact reaches %.3g m",
                     sphere_radius(&touch->spheres, i));
        snprintf(
            sim->watch.what, sizeof sim->watch.what,
            "node %d of body '%.40s' at (%.5g, %.5g, %.5g) m is %.3g m in body '%.40s'; %s",
            deform->balls[where.vertex].outer + 1, sim->bodies.list[deform->body].name, at[0],
            at[1], at[2], depth, sim->bodies.list[contact->body].name, reach);
        return;
    }
}

void touch_apply(struct simulation *sim)
{
    struct touch *touch = &sim->touch;
    if (!is_on(touch))
        return;
    facet_step_apply(&touch->contacts, &touch->spheres, &sim->bodies, &touch->materials,
                     sim->dt, sim->job->energy_ledger);
    merge_loads(sim);
    for (int i = 0; i < touch->spheres.n_owned; i++)
        push_ball(sim, i);
    watch_depth(sim);
}

int touch_count(const struct touch *touch)
{
    return is_on(touch) ? facet_contacts_count(&touch->contacts) : 0;
}

void touch_end(struct simulation *sim)
{
    for (int i = 0; sim->job->energy_ledger && i < sim->touch.spheres.n_owned; i++) {
        const double *force = sim->touch.spheres.force[i].lane;
        exact_sum_add(&sim->observe.totals[OBSERVE_TOUCH_FRICTION], force[3]);
        exact_sum_add(&sim->observe.totals[OBSERVE_TOUCH_DAMPING], force[7]);
    }
}

void touch_load_bodies(const struct touch *touch, const struct bodies *bodies,
                       struct exact_sum *sums)
{
    for (int k = 0; is_on(touch) && k < touch->contacts.n; k++) {
        const struct facet_contact *contact = &touch->contacts.list[k];
        const struct body *body = &bodies->list[contact->body];
        const double width = contact->history[CONTACT_RADIUS_LANE];
        const int i = contact->sphere;
        if (!(width > 0.0) || body->rigid == NULL)
            continue;
        const double yield = rigid_yield_most(body->rigid, sphere_place(&touch->spheres, i));
        const struct critical_step_contact felt = critical_step_contact(
            &touch->materials
                 .pairs[touch->spheres.material[i] * touch->materials.n + body->material],
            width, 1.0 / (sphere_inverse_mass(&touch->spheres, i) + yield));
        exact_sum_add(&sums[2 * contact->body], critical_step_stiffest(felt.stiffness) * yield);
        exact_sum_add(&sums[2 * contact->body + 1],
                      critical_step_stiffest(felt.damping) * yield);
    }
}

void touch_energies(const struct simulation *sim, struct exact_sum *normal,
                    struct exact_sum *springs, struct exact_sum *friction,
                    struct exact_sum *damping)
{
    const struct touch *touch = &sim->touch;
    if (!is_on(touch))
        return;
    facet_contacts_elastic_energy(&touch->contacts, &touch->spheres, &sim->bodies,
                                  &touch->materials, normal, springs);
    for (int i = 0; i < touch->spheres.n_owned; i++) {
        exact_sum_add(friction, touch->spheres.force[i].lane[3]);
        exact_sum_add(damping, 0.5 * touch->spheres.force[i].lane[7]);
    }
}

/* ---- State
 * ------------------------------------------------------------------------------------ */

static void collect(struct table *table, const void *from, int64_t begin, int64_t end)
{
    const struct touch *touch = &((const struct simulation *)from)->touch;
    struct facet_contact_record *records = NULL;
    const int n =
        facet_contacts_records(&touch->contacts, &touch->spheres, begin, end, &records);
    table_append(table, records, n);
    free(records);
}

int touch_table(const struct simulation *sim, struct checkpoint_more *table)
{
    if (!is_on(&sim->touch))
        return 0;
    *table = (struct checkpoint_more){.name = "node_contacts",
                                      .contacts = true,
                                      .n_ids = sim->touch.n_balls,
                                      .n_rows = facet_contacts_count(&sim->touch.contacts),
                                      .collect = collect,
                                      .from = sim};
    return 1;
}

bool touch_fits(const struct simulation *sim, const struct checkpoint_more *table)
{
    const struct facet_contact_record *records = (const void *)table->records;
    bool fits = true;
    for (int64_t r = 0; is_on(&sim->touch) && fits && r < table->n_rows; r++) {
        fits =
            records[r].body >= 0 && records[r].body < sim->bodies.n && records[r].feature >= 0;
        if (!fits)
            break;
        const struct body *body = &sim->bodies.list[records[r].body];
        fits = records[r].feature <
               (body->skin != NULL ? body->mesh.n_faces : mesh_n_features(&body->mesh));
    }
    return fits;
}

void touch_restore(struct simulation *sim, struct checkpoint_more *table)
{
    if (!is_on(&sim->touch))
        return;
    sim->touch.waiting = (void *)table->records;
    sim->touch.n_waiting = (int)table->n_rows;
    table->records = NULL;
}
