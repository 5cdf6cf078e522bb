/*
 * Contacts of spheres with rigid bodies: see facet_contact.h.
 *
 * Each step goes through the list sphere by sphere and body by body. The local search says
 * which contacts of such a group act; these, and those that end, are gathered into a batch, in
 * order, for which the law is then taken at once; what comes of it is added contact by contact
 * in the same order. So neither the list nor the size of a batch shows in the result.
 *
 * Where facets are finer than spheres, a group is long, and most of it is too far to touch
 * within the next steps. So each long group knows which of its entries are near, and looks at
 * the others only when the sphere and the body have together moved as far as these were from
 * touching. A sphere at rest looks at all once a search.
 */
#include "contact/facet_contact.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/exact_four.h"
#include "base/report.h"
#include "contact/facet_kernel.h"
#include "contact/facet_local.h"
#include "contact/facet_tree.h"
#include "model/body.h"
#include "model/material.h"
#include "model/rigid.h"
#include "model/sphere.h"
#include "physics/contact_geometry.h"
#include "physics/contact_law.h"

enum { MERGE_AFTER = 1 << 20 }; /* terms that quick sums hold at most */

/* Whose a contact of the batch is, and where. */
struct acting {
    int entry, sphere, body;
    struct vec3 point; /* [m] */
    struct vec3 wall;  /* velocity of the body there [m/s] */
    struct vec3 turns; /* angular velocity of the body [rad/s] */
};

/* Quick sums of a body: force and nothing, torque and work. */
struct quick_load {
    struct exact_four force, torque;
};

/* The entries of a sphere with a body, begin to end of the list; `near` numbers those from
 * begin on that may touch until the two have moved by `slack`. */
struct group {
    int begin, end, n_near;
    double slack;     /* [m]; negative: not looked at yet */
    double travelled; /* by the body when it was looked at [m] */
    struct vec3 from; /* where the sphere was [m] */
};

struct facet_work {
    struct facet_tree *trees; /* one a body */
    bool has_trees;
    struct facet_tree_found found, across;
    int next_capacity;
    struct facet_contact *next; /* the list that is being made */
    struct facet_local local;
    struct facet_kernel_batch batch;
    struct acting acting[FACET_KERNEL_BATCH];
    struct quick_load *loads; /* one a body */
    bool has_groups;
    int n_groups, group_capacity, near_capacity;
    struct group *groups;
    int *near;         /* of all groups, each at its entries' places */
    double *travelled; /* at most, one a body [m] */
};

/* What a step's contacts need. */
struct step {
    struct facet_contacts *facets;
    struct spheres *spheres;
    const struct bodies *bodies;
    const struct materials *materials;
    double dt;
    bool ledger;
};

static bool holds_history(const struct facet_contact *contact)
{
    return contact->history[CONTACT_RADIUS_LANE] > 0.0;
}

static struct vec3 vec3_of(const double *lane)
{
    return (struct vec3){lane[0], lane[1], lane[2]};
}

void facet_contacts_init(struct facet_contacts *facets, int n_bodies)
{
    *facets = (struct facet_contacts){.n_bodies = n_bodies};
    facets->loads = array_allocate((size_t)n_bodies, sizeof *facets->loads);
    facets->work = array_allocate_rows(1, sizeof *facets->work);
    facets->work->trees = array_allocate((size_t)n_bodies, sizeof *facets->work->trees);
    facets->work->loads = array_allocate((size_t)n_bodies, sizeof *facets->work->loads);
    facets->work->travelled = array_allocate((size_t)n_bodies, sizeof(double));
}

void facet_contacts_clear(struct facet_contacts *facets)
{
    struct facet_work *work = facets->work;
    for (int b = 0; b < facets->n_bodies; b++)
        facet_tree_clear(&work->trees[b]);
    free(work->trees);
    free(work->found.features);
    free(work->across.features);
    free(work->next);
    free(work->loads);
    free(work->groups);
    free(work->near);
    free(work->travelled);
    facet_local_clear(&work->local);
    free(work);
    free(facets->list);
    free(facets->loads);
    *facets = (struct facet_contacts){0};
}

/* ---- Global search
 * ---------------------------------------------------------------------------- */

static int compare_contacts(const void *a, const void *b)
{
    const struct facet_contact *p = a, *q = b;
    if (p->sphere != q->sphere)
        return p->sphere < q->sphere ? -1 : 1;
    if (p->body != q->body)
        return p->body < q->body ? -1 : 1;
    return (p->feature > q->feature) - (p->feature < q->feature);
}

static int append(struct facet_work *work, int n, const struct facet_contact *contact)
{
    ARRAY_GROW(work->next, n + 1, work->next_capacity);
    work->next[n] = *contact;
    return n + 1;
}

/* The list that has been made becomes the list. */
static void exchange_lists(struct facet_contacts *facets, int n)
{
    struct facet_work *work = facets->work;
    struct facet_contact *list = facets->list;
    const int capacity = facets->capacity;
    facets->list = work->next;
    facets->capacity = work->next_capacity;
    facets->n = n;
    work->next = list;
    work->next_capacity = capacity;
    work->has_groups = false;
}

static void prepare_trees(struct facet_work *work, const struct bodies *bodies)
{
    for (int b = 0; b < bodies->n; b++) {
        if (!work->has_trees)
            facet_tree_build(&work->trees[b], &bodies->list[b].mesh);
        else if (bodies->list[b].moves)
            facet_tree_refit(&work->trees[b], &bodies->list[b].mesh);
    }
    work->has_trees = true;
}

void facet_contacts_refit(struct facet_contacts *facets, const struct bodies *bodies)
{
    prepare_trees(facets->work, bodies);
}

bool facet_contacts_meet(const struct facet_contacts *facets, const struct bodies *bodies,
                         struct vec3 centre, double radius)
{
    struct facet_work *work = facets->work;
    struct contact_geometry at;
    for (int b = 0; b < bodies->n; b++) {
        if (!bodies->list[b].exists)
            continue;
        const struct mesh *mesh = &bodies->list[b].mesh;
        facet_tree_query(&work->trees[b], mesh, centre, radius, &work->found);
        for (int k = 0; k < work->found.n; k++)
            if (contact_geometry_touches(mesh, work->found.features[k], centre, radius, &at))
                return true;
    }
    return false;
}

static void find_all_features(struct facet_tree_found *found, const struct mesh *mesh)
{
    found->n = mesh_n_features(mesh);
    ARRAY_GROW(found->features, found->n, found->capacity);
    for (int k = 0; k < found->n; k++)
        found->features[k] = k;
}

/* Appends what the old list (its entries from `old` on) holds of touching contacts before this
 * one, and the contact itself, with its history if it had any. */
static void list_contact(struct facet_contacts *facets, struct facet_contact contact, int *old,
                         int *n)
{
    for (; *old < facets->n; (*old)++) {
        const struct facet_contact *before = &facets->list[*old];
        const int order = compare_contacts(before, &contact);
        if (order > 0)
            break;
        if (order == 0)
            contact = *before;
        else if (holds_history(before))
            *n = append(facets->work, *n, before);
    }
    *n = append(facets->work, *n, &contact);
}

static int compare_features(const void *a, const void *b)
{
    int p, q;
    memcpy(&p, a, sizeof p);
    memcpy(&q, b, sizeof q);
    return (p > q) - (p < q);
}

/* Adds what sphere i comes near to on the other side of a periodic boundary: bodies are not
 * repeated, so each image that it may become before the next search looks for itself. */
static void find_across(struct facet_work *work, int b, const struct mesh *mesh,
                        const struct spheres *spheres, int i, double reach)
{
    double shifts[PERIODIC_IMAGES][3];
    const int n_shifts = periodic_shifts(&spheres->periodic, shifts);
    const double *x = sphere_position(spheres, i), allowance = spheres->allowance[i];
    struct facet_tree_found *found = &work->found, *across = &work->across;
    for (int s = 1; s < n_shifts; s++) {
        double image[3];
        bool may_be = true;
        for (int k = 0; k < 3; k++) {
            image[k] = x[k] + shifts[s][k];
            may_be = may_be && (shifts[s][k] == 0.0 ||
                                (image[k] >= spheres->periodic.low[k] - allowance &&
                                 image[k] <= spheres->periodic.high[k] + allowance));
        }
        if (!may_be)
            continue;
        facet_tree_query(&work->trees[b], mesh, vec3_of(image), reach, across);
        for (int k = 0; k < across->n; k++) {
            ARRAY_GROW(found->features, found->n + 1, found->capacity);
            found->features[found->n++] = across->features[k];
        }
    }
    if (found->n > 1)
        qsort(found->features, (size_t)found->n, sizeof *found->features, compare_features);
    int n = 0;
    for (int k = 0; k < found->n; k++)
        if (n == 0 || found->features[n - 1] != found->features[k])
            found->features[n++] = found->features[k];
    found->n = n;
}

static void find_features(struct facet_work *work, int b, const struct mesh *mesh,
                          const struct spheres *spheres, int i, double body_allowance)
{
    const double reach = sphere_radius(spheres, i) + spheres->allowance[i] + body_allowance;
    facet_tree_query(&work->trees[b], mesh, vec3_of(sphere_position(spheres, i)), reach,
                     &work->found);
    if (spheres->periodic.any)
        find_across(work, b, mesh, spheres, i, reach);
}

void facet_contacts_search(struct facet_contacts *facets, const struct spheres *spheres,
                           const struct bodies *bodies, const double *body_allowance,
                           bool all_pairs)
{
    struct facet_work *work = facets->work;
    struct facet_tree_found *found = &work->found;
    CHECK(bodies->n == facets->n_bodies, "%d bodies became %d", facets->n_bodies, bodies->n);
    prepare_trees(work, bodies);
    int n = 0, old = 0;
    for (int i = 0; i < spheres->n_owned; i++) {
        for (int b = 0; b < bodies->n; b++) {
            const struct mesh *mesh = &bodies->list[b].mesh;
            if (all_pairs)
                find_all_features(found, mesh);
            else
                find_features(work, b, mesh, spheres, i, body_allowance[b]);
            for (int k = 0; k < found->n; k++)
                list_contact(facets,
                             (struct facet_contact){
                                 .sphere = i, .body = b, .feature = found->features[k]},
                             &old, &n);
        }
    }
    for (; old < facets->n; old++)
        if (holds_history(&facets->list[old]))
            n = append(work, n, &facets->list[old]);
    exchange_lists(facets, n);
}

/* ---- Records
 * ---------------------------------------------------------------------------------- */

int facet_contacts_records(const struct facet_contacts *facets, const struct spheres *spheres,
                           struct facet_contact_record **records)
{
    int n = 0;
    for (int k = 0; k < facets->n; k++)
        n += holds_history(&facets->list[k]);
    *records = array_resize(*records, 0, (size_t)n, sizeof **records);
    n = 0;
    for (int k = 0; k < facets->n; k++) {
        const struct facet_contact *contact = &facets->list[k];
        if (!holds_history(contact))
            continue;
        struct facet_contact_record *record = &(*records)[n++];
        *record = (struct facet_contact_record){
            spheres->id[contact->sphere], contact->body, contact->feature, {0.0}};
        memcpy(record->history, contact->history, sizeof record->history);
    }
    return n;
}

void facet_contacts_forget(struct facet_contacts *facets)
{
    facets->n = 0;
    facets->work->has_groups = false;
}

void facet_contacts_restore(struct facet_contacts *facets, int n,
                            const struct facet_contact_record *records,
                            const int *sphere_of_record)
{
    struct facet_work *work = facets->work;
    struct facet_contact *held = array_allocate((size_t)n, sizeof *held);
    int n_held = 0, n_next = 0, k = 0;
    for (int r = 0; r < n; r++) {
        if (sphere_of_record[r] < 0)
            continue;
        struct facet_contact *contact = &held[n_held++];
        *contact = (struct facet_contact){.sphere = sphere_of_record[r],
                                          .body = records[r].body,
                                          .feature = records[r].feature};
        memcpy(contact->history, records[r].history, sizeof contact->history);
    }
    qsort(held, (size_t)n_held, sizeof *held, compare_contacts);
    for (int h = 0; h < n_held; h++) {
        while (k < facets->n && compare_contacts(&facets->list[k], &held[h]) < 0)
            n_next = append(work, n_next, &facets->list[k++]);
        if (k < facets->n && compare_contacts(&facets->list[k], &held[h]) == 0)
            k++;
        n_next = append(work, n_next, &held[h]);
    }
    while (k < facets->n)
        n_next = append(work, n_next, &facets->list[k++]);
    free(held);
    exchange_lists(facets, n_next);
}

/* ---- Step
 * ------------------------------------------------------------------------------------- */

static double size_of(double x)
{
    return x < 0.0 ? -x : x;
}

static void merge_loads(struct facet_contacts *facets, int b)
{
    struct quick_load *quick = &facets->work->loads[b];
    struct body_load *load = &facets->loads[b];
    for (int x = 0; x < 3; x++) {
        exact_four_merge(&quick->force, x, &load->force[x]);
        exact_four_merge(&quick->torque, x, &load->torque[x]);
    }
    exact_four_merge(&quick->torque, 3, &load->work);
    memset(quick, 0, sizeof *quick);
}

/* Gives a body the force on it, its torque (`twist` besides the force's) and the work of its
 * motion. `force` becomes what the exact sums took, so that the sphere's is the opposite to the
 * last bit. */
static void load_body(const struct step *step, const struct acting *acting, double force[4],
                      struct vec3 twist)
{
    struct quick_load *load = &step->facets->work->loads[acting->body];
    const struct vec3 p = acting->point, path = vec3_scale(step->dt, acting->wall);
    const double size = size_of(force[0]) + size_of(force[1]) + size_of(force[2]);
    const double arm = size_of(p.x) + size_of(p.y) + size_of(p.z);
    const double way = size_of(path.x) + size_of(path.y) + size_of(path.z);
    const struct vec3 turn = vec3_scale(step->dt, acting->turns);
    const double twists = (size_of(twist.x) + size_of(twist.y) + size_of(twist.z)) *
                          (1.0 + size_of(turn.x) + size_of(turn.y) + size_of(turn.z));
    if (!(size * (1.0 + arm + way) + twists < EXACT_FOUR_LIMIT)) {
        /* Something has run away: the sum takes note of it, as it does of single terms. */
        step->facets->loads[acting->body].force[0].overflow++;
        force[0] = force[1] = force[2] = 0.0;
        return;
    }
    exact_four_add(&load->force, force, force);
    const struct vec3 taken = {force[0], force[1], force[2]};
    const struct vec3 torque = vec3_add(vec3_cross(p, taken), twist);
    double others[4] = {torque.x, torque.y, torque.z,
                        -vec3_dot(taken, path) - vec3_dot(twist, turn)};
    exact_four_add(&load->torque, others, others);
    if (load->force.n_terms >= MERGE_AFTER)
        merge_loads(step->facets, acting->body);
}

/* Adds what contact k of the batch does to its sphere and its body. */
static void press(const struct step *step, int k)
{
    const struct facet_kernel_batch *batch = &step->facets->work->batch;
    const struct acting *acting = &step->facets->work->acting[k];
    const int i = acting->sphere;
    const struct vec3 n = {batch->normal[0][k], batch->normal[1][k], batch->normal[2][k]};
    const struct vec3 grip = {batch->grip[0][k], batch->grip[1][k], batch->grip[2][k]};
    const struct vec3 torque =
        vec3_scale(-sphere_radius(step->spheres, i), vec3_cross(n, grip));
    double force[4] = {batch->push[k] * n.x + grip.x, batch->push[k] * n.y + grip.y,
                       batch->push[k] * n.z + grip.z, 0.0}; /* on the body [N] */
    struct vec3 twist = {0.0, 0.0, 0.0};                    /* on the body [N m] */
    if (step->materials->full)
        twist = (struct vec3){batch->torque[0][k], batch->torque[1][k], batch->torque[2][k]};
    load_body(step, acting, force, twist);

    double *row = step->spheres->force[i].lane;
    row[0] -= force[0];
    row[1] -= force[1];
    row[2] -= force[2];
    row[4] += torque.x - twist.x;
    row[5] += torque.y - twist.y;
    row[6] += torque.z - twist.z;
    if (step->ledger) {
        row[3] += batch->lost_friction[k];
        row[7] += batch->lost_damping[k];
        step->spheres->dissipated_tangential[i] += batch->lost_law[k];
    }
    struct facet_contact *contact = &step->facets->list[acting->entry];
    contact->overlap = batch->overlap[k];
    for (int h = 0; h < CONTACT_LANES; h++)
        if (contact_lane_used(h, step->materials->full, step->ledger))
            contact->history[h] = batch->history[h][k];
}

static void empty_batch(const struct step *step)
{
    struct facet_kernel_batch *batch = &step->facets->work->batch;
    facet_kernel_apply(batch, step->dt, step->materials->full, step->ledger);
    for (int k = 0; k < batch->n; k++)
        press(step, k);
    batch->n = 0;
}

/* Puts a contact into the batch; one that ends has no overlap, and what its spring still held
 * is counted as lost. */
static void add_contact(const struct step *step, int entry, const struct contact_geometry *at,
                        double overlap)
{
    const struct spheres *spheres = step->spheres;
    struct facet_kernel_batch *batch = &step->facets->work->batch;
    if (batch->n == FACET_KERNEL_BATCH)
        empty_batch(step);
    const int k = batch->n++;
    const struct facet_contact *contact = &step->facets->list[entry];
    const struct body *body = &step->bodies->list[contact->body];
    const struct material_pair *pair =
        &step->materials
             ->pairs[spheres->material[contact->sphere] * step->materials->n + body->material];
    const double *spin = spheres->spin[contact->sphere].lane;
    const struct vec3 normal = vec3_scale(-1.0, at->normal);       /* sphere to body */
    const struct vec3 rolling = vec3_cross(vec3_of(spin), normal); /* R w x n [m/s] */
    const struct vec3 surface =
        vec3_add(vec3_of(sphere_velocity(spheres, contact->sphere)), rolling);
    struct vec3 wall = {0.0, 0.0, 0.0}, turns = {0.0, 0.0, 0.0};
    if (body->moves || body->surface_runs) {
        wall = body_velocity(body, at->point, normal);
        turns = body_spin(body);
    }
    const struct vec3 velocity = vec3_sub(wall, surface);
    const double normals[3] = {normal.x, normal.y, normal.z};
    const double velocities[3] = {velocity.x, velocity.y, velocity.z};
    const double spins[3] = {turns.x - spin[4], turns.y - spin[5], turns.z - spin[6]};

    step->facets->work->acting[k] =
        (struct acting){entry, contact->sphere, contact->body, at->point, wall, turns};
    for (int x = 0; x < 3; x++) {
        batch->normal[x][k] = normals[x];
        batch->velocity[x][k] = velocities[x];
        batch->spin[x][k] = spins[x];
    }
    batch->overlap[k] = overlap;
    batch->inverse_radius[k] = spin[3];
    batch->inverse_mass[k] = spin[7];
    if (body->rigid != NULL)
        batch->inverse_mass[k] += rigid_yield(body->rigid, at->point, normal);
    batch->pair[k] = pair;
    for (int h = 0; h < CONTACT_LANES; h++)
        if (contact_lane_used(h, step->materials->full, step->ledger))
            batch->history[h][k] = contact->history[h];
    const double relative = overlap * spin[3];
    if (relative > step->facets->overlap_max)
        step->facets->overlap_max = relative;
}

/* What a body that is not there still holds ends. */
static void end_group(const struct step *step, int begin, int end)
{
    for (int k = begin; k < end; k++) {
        const struct facet_contact *contact = &step->facets->list[k];
        if (!holds_history(contact))
            continue;
        const struct mesh *mesh = &step->bodies->list[contact->body].mesh;
        const struct contact_geometry at = contact_geometry_closest(
            mesh, contact->feature, sphere_place(step->spheres, contact->sphere));
        add_contact(step, k, &at, 0.0);
    }
}

/* ---- Groups
 * ----------------------------------------------------------------------------------- */

enum { LONG_GROUP = 6 }; /* shorter ones are looked at as a whole */
/* How far beyond touching counts as near: of the radius, and in steps of the present speed. */
static const double NEAR_RADII = 0.05, NEAR_STEPS = 8.0;

static void list_groups(struct facet_contacts *facets)
{
    struct facet_work *work = facets->work;
    const struct facet_contact *list = facets->list;
    work->n_groups = 0;
    ARRAY_GROW(work->near, facets->n, work->near_capacity);
    for (int k = 0, end; k < facets->n; k = end) {
        for (end = k + 1; end < facets->n; end++)
            if (list[end].sphere != list[k].sphere || list[end].body != list[k].body)
                break;
        ARRAY_GROW(work->groups, work->n_groups + 1, work->group_capacity);
        work->groups[work->n_groups++] = (struct group){.begin = k, .end = end, .slack = -1.0};
    }
    work->has_groups = true;
}

/* Finds out which entries of a group are near. */
static void look_around(const struct step *step, struct group *group, struct vec3 centre)
{
    struct facet_work *work = step->facets->work;
    const struct facet_contact *entries = &step->facets->list[group->begin];
    const struct body *body = &step->bodies->list[entries->body];
    const double radius = sphere_radius(step->spheres, entries->sphere);
    const double speed = vec3_norm(vec3_of(sphere_velocity(step->spheres, entries->sphere))) +
                         (body->moves ? body->speed_max : 0.0);
    const int n = group->end - group->begin;
    const bool is_long = n >= LONG_GROUP;
    group->n_near = 0;
    group->from = centre;
    group->travelled = work->travelled[entries->body];
    group->slack =
        is_long ? NEAR_RADII * radius + NEAR_STEPS * step->dt * speed : (double)INFINITY;
    for (int k = 0; k < n; k++)
        if (!is_long || holds_history(&entries[k]) ||
            contact_geometry_reaches(&body->mesh, entries[k].feature, centre,
                                     radius + group->slack))
            work->near[group->begin + group->n_near++] = k;
}

static bool must_look(const struct step *step, const struct group *group, struct vec3 centre)
{
    const int body = step->facets->list[group->begin].body;
    const double left = group->slack - (step->facets->work->travelled[body] - group->travelled);
    const struct vec3 moved = vec3_sub(centre, group->from);
    return !(left > 0.0 && vec3_dot(moved, moved) < left * left);
}

/* Bodies are where they are in this step: no point of one has gone farther than this. */
static void count_travel(const struct step *step)
{
    for (int b = 0; b < step->bodies->n; b++)
        if (step->bodies->list[b].moves)
            step->facets->work->travelled[b] +=
                1.001 * step->bodies->list[b].speed_max * step->dt;
}

/* The contacts of one sphere with one body. */
static void gather_group(const struct step *step, struct group *place)
{
    const int begin = place->begin;
    struct facet_contact *group = &step->facets->list[begin];
    struct facet_local *local = &step->facets->work->local;
    const struct mesh *mesh = &step->bodies->list[group->body].mesh;
    const struct vec3 centre = sphere_place(step->spheres, group->sphere);
    const double radius = sphere_radius(step->spheres, group->sphere);
    if (must_look(step, place, centre))
        look_around(step, place, centre);
    if (place->n_near == 0)
        return;
    facet_local_search(local, group, &step->facets->work->near[begin], place->n_near, mesh,
                       &step->spheres->periodic, centre, radius);
    for (int t = 0; t < local->n_touches; t++) {
        const struct facet_local_touch *touch = &local->touches[t];
        if (facet_local_stands(local, t))
            add_contact(step, begin + touch->entry, &touch->acts_at,
                        radius - touch->acts_at.distance);
    }
    for (int e = 0; e < local->n_ended; e++) {
        struct facet_contact *ended = &group[local->ended[e]];
        const struct contact_geometry at =
            contact_geometry_closest(mesh, ended->feature, centre);
        add_contact(step, begin + local->ended[e], &at, 0.0);
    }
}

/* The same where only one feature is near: nothing to choose from. */
static void gather_one(const struct step *step, int entry)
{
    const struct facet_contact *contact = &step->facets->list[entry];
    const struct mesh *mesh = &step->bodies->list[contact->body].mesh;
    const struct vec3 centre = sphere_place(step->spheres, contact->sphere);
    const double radius = sphere_radius(step->spheres, contact->sphere);
    struct contact_geometry at;
    if (contact_geometry_touches(mesh, contact->feature, centre, radius, &at)) {
        add_contact(step, entry, &at, radius - at.distance);
    } else if (holds_history(contact)) {
        at = contact_geometry_closest(mesh, contact->feature, centre);
        add_contact(step, entry, &at, 0.0);
    }
}

void facet_contacts_apply(struct facet_contacts *facets, struct spheres *spheres,
                          const struct bodies *bodies, const struct materials *materials,
                          double dt, bool ledger)
{
    const struct step step = {facets, spheres, bodies, materials, dt, ledger};
    struct facet_work *work = facets->work;
    facets->overlap_max = 0.0;
    if (!work->has_groups)
        list_groups(facets);
    count_travel(&step);
    for (int g = 0; g < work->n_groups; g++) {
        struct group *group = &work->groups[g];
        if (!bodies->list[facets->list[group->begin].body].exists)
            end_group(&step, group->begin, group->end);
        else if (group->end == group->begin + 1)
            gather_one(&step, group->begin);
        else
            gather_group(&step, group);
    }
    empty_batch(&step);
    for (int b = 0; b < facets->n_bodies; b++)
        if (facets->work->loads[b].force.n_terms > 0)
            merge_loads(facets, b);
}

/* What the contact across a surface that goes stores half a step before: that is what is lost
 * with it, between the last step with it and the first without. (7.4) */
static double held_energy(const struct spheres *spheres, const struct body *body,
                          const struct facet_contact *contact, const struct material_pair *pair,
                          double dt)
{
    const double none[CONTACT_LANES] = {0.0};
    const int i = contact->sphere;
    const struct vec3 centre = sphere_place(spheres, i);
    const struct vec3 drift =
        vec3_sub(vec3_of(sphere_velocity(spheres, i)), body_drift(body, centre));
    const struct contact_geometry at = contact_geometry_closest(
        &body->mesh, contact->feature, vec3_axpy(centre, -0.5 * dt, drift));
    const double overlap = sphere_radius(spheres, i) - at.distance;
    if (!(overlap > 0.0))
        return 0.0;
    return contact_law_elastic_energy(overlap, spheres->spin[i].lane[3], pair, none);
}

void facet_contacts_held(const struct facet_contacts *facets, const struct spheres *spheres,
                         const struct bodies *bodies, const struct materials *materials,
                         double dt, struct exact_sum *sum)
{
    for (int k = 0; k < facets->n; k++) {
        const struct facet_contact *contact = &facets->list[k];
        const struct body *body = &bodies->list[contact->body];
        const int material = spheres->material[contact->sphere];
        if (!body->exists && holds_history(contact))
            exact_sum_add(
                sum,
                held_energy(spheres, body, contact,
                            &materials->pairs[material * materials->n + body->material], dt));
    }
}

void facet_contacts_elastic_energy(const struct facet_contacts *facets,
                                   const struct spheres *spheres, const struct bodies *bodies,
                                   const struct materials *materials, struct exact_sum *sum)
{
    for (int k = 0; k < facets->n; k++) {
        const struct facet_contact *contact = &facets->list[k];
        if (!holds_history(contact))
            continue;
        const int i = contact->sphere, wall = bodies->list[contact->body].material;
        exact_sum_add(sum, contact_law_elastic_energy(
                               contact->overlap, spheres->spin[i].lane[3],
                               &materials->pairs[spheres->material[i] * materials->n + wall],
                               contact->history));
    }
}
