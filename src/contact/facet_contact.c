/*
 * Contacts of spheres with rigid bodies: see facet_contact.h.
 *
 * Each step goes through the list sphere by sphere and body by body.  Of such a group most
 * features do not touch, which their distance says at once; for the few that do it is decided
 *   1 which stand: the deepest first, and it silences all that are the same contact;
 *   2 which memory passes on: what a feature held that stands no more goes to the one that
 *     begins to stand with nearly the same normal;
 *   3 what they do to each other: the contact law, in ascending order of features.
 * Only state and geometry enter, so the list may hold anything besides what touches.
 *
 * Drawback: one contact at a time, not blocks of them as between spheres.
 */
#include "contact/facet_contact.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "contact/facet_tree.h"
#include "model/body.h"
#include "model/material.h"
#include "model/sphere.h"
#include "physics/contact_geometry.h"
#include "physics/contact_law.h"

static const double SAME_NORMAL = 0.9659258262890683; /* cos 15 deg */
static const double HOLDS_ON = 1.01; /* a standing contact counts as this much deeper */
static const double IN_PLANE =
    1e-6; /* height over a tangent plane that counts as in it, in radii */

/* A feature that touches in this step. */
struct touch {
    int entry;
    bool settled, stands;
    double claim; /* its overlap, more if it stood before [m] */
    struct contact_geometry at;
};

struct facet_work {
    struct facet_tree *trees; /* one a body */
    bool has_trees;
    struct facet_tree_found found;
    int next_capacity;
    struct facet_contact *next; /* the list that is being made */
    int group_capacity;
    struct touch *touches;
    int *ended; /* entries that hold history and do not stand */
};

/* What a step's local search and law need, and one sphere's group of them. */
struct step {
    struct facet_contacts *facets;
    struct spheres *spheres;
    const struct bodies *bodies;
    const struct materials *materials;
    double dt;
    bool ledger;
};

struct group {
    int sphere, begin, end; /* entries */
    const struct body *body;
    struct body_load *load;
    const struct material_pair *pair;
    struct vec3 centre;
    double radius;
    int n_touches, n_ended;
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
    facets->work = array_allocate(1, sizeof *facets->work);
    facets->work->trees = array_allocate((size_t)n_bodies, sizeof *facets->work->trees);
}

void facet_contacts_clear(struct facet_contacts *facets)
{
    struct facet_work *work = facets->work;
    for (int b = 0; b < facets->n_bodies; b++)
        facet_tree_clear(&work->trees[b]);
    free(work->trees);
    free(work->found.features);
    free(work->next);
    free(work->touches);
    free(work->ended);
    free(work);
    free(facets->list);
    free(facets->loads);
    *facets = (struct facet_contacts){0};
}

/* ---- Global search ---------------------------------------------------------------------------- */

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

static void find_all_features(struct facet_tree_found *found, const struct mesh *mesh)
{
    found->n = mesh_n_features(mesh);
    ARRAY_GROW(found->features, found->n, found->capacity);
    for (int k = 0; k < found->n; k++)
        found->features[k] = k;
}

/* Appends what the old list (its entries from `old` on) holds of touching contacts before this one, and
 * the contact itself, with its history if it had any. */
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
        const struct vec3 centre = vec3_of(sphere_position(spheres, i));
        const double reach = sphere_radius(spheres, i) + spheres->allowance[i];
        for (int b = 0; b < bodies->n; b++) {
            const struct mesh *mesh = &bodies->list[b].mesh;
            if (all_pairs)
                find_all_features(found, mesh);
            else
                facet_tree_query(&work->trees[b], mesh, centre, reach + body_allowance[b],
                                 found);
            for (int k = 0; k < found->n; k++)
                list_contact(facets, (struct facet_contact){i, b, found->features[k], {0.0}},
                             &old, &n);
        }
    }
    for (; old < facets->n; old++)
        if (holds_history(&facets->list[old]))
            n = append(work, n, &facets->list[old]);
    exchange_lists(facets, n);
}

/* ---- Records ---------------------------------------------------------------------------------- */

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
        *contact = (struct facet_contact){
            sphere_of_record[r], records[r].body, records[r].feature, {0.0}};
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

/* ---- Local search ----------------------------------------------------------------------------- */

static void find_touches(const struct step *step, struct group *group)
{
    struct facet_work *work = step->facets->work;
    const struct mesh *mesh = &group->body->mesh;
    for (int k = group->begin; k < group->end; k++) {
        const struct facet_contact *contact = &step->facets->list[k];
        struct touch *touch = &work->touches[group->n_touches];
        if (contact_geometry_touches(mesh, contact->feature, group->centre, group->radius,
                                     &touch->at)) {
            const double overlap = group->radius - touch->at.distance;
            touch->entry = k;
            touch->claim = holds_history(contact) ? HOLDS_ON * overlap : overlap;
            touch->settled = touch->stands = false;
            group->n_touches++;
        } else if (holds_history(contact)) {
            work->ended[group->n_ended++] = k;
        }
    }
}

/* Is `other` the same contact as the one that stands: nearly the same normal, or nothing of it rises
 * above the plane that the standing one touches? */
static bool is_same_contact(const struct touch *standing, const struct touch *other,
                            double radius)
{
    const struct vec3 apart = vec3_sub(other->at.point, standing->at.point);
    return vec3_dot(standing->at.normal, other->at.normal) > SAME_NORMAL ||
           vec3_dot(standing->at.normal, apart) <= IN_PLANE * radius;
}

/* The deepest stands and silences its like, then the deepest of the rest. */
static void choose_standing(const struct step *step, struct group *group)
{
    struct facet_work *work = step->facets->work;
    struct touch *touches = work->touches;
    for (;;) {
        struct touch *deepest = NULL;
        for (int t = 0; t < group->n_touches; t++)
            if (!touches[t].settled && (deepest == NULL || touches[t].claim > deepest->claim))
                deepest = &touches[t];
        if (deepest == NULL)
            break;
        deepest->settled = deepest->stands = true;
        for (int t = 0; t < group->n_touches; t++)
            if (!touches[t].settled && is_same_contact(deepest, &touches[t], group->radius))
                touches[t].settled = true;
    }
    for (int t = 0; t < group->n_touches; t++)
        if (!touches[t].stands && holds_history(&step->facets->list[touches[t].entry]))
            work->ended[group->n_ended++] = touches[t].entry;
}

/* The tangential force of the old contact, turned into the new tangent plane, its size kept. */
static void turn_history(double *history, struct vec3 normal)
{
    const struct vec3 force = vec3_of(history);
    const struct vec3 flat = vec3_axpy(force, -vec3_dot(force, normal), normal);
    const double size = vec3_norm(force), flat_size = vec3_norm(flat);
    const double scale = flat_size > 0.0 ? size / flat_size : 0.0;
    history[0] = scale * flat.x;
    history[1] = scale * flat.y;
    history[2] = scale * flat.z;
}

/* What features held that stand no more passes to those that begin to stand in their place. */
static void hand_over(const struct step *step, const struct group *group)
{
    struct facet_work *work = step->facets->work;
    for (int e = 0; e < group->n_ended; e++) {
        struct facet_contact *old = &step->facets->list[work->ended[e]];
        const struct contact_geometry was =
            contact_geometry_closest(&group->body->mesh, old->feature, group->centre);
        struct touch *heir = NULL;
        double closest = SAME_NORMAL;
        for (int t = 0; t < group->n_touches; t++) {
            struct touch *touch = &work->touches[t];
            const double turn = vec3_dot(was.normal, touch->at.normal);
            if (touch->stands && turn > closest &&
                !holds_history(&step->facets->list[touch->entry])) {
                heir = touch;
                closest = turn;
            }
        }
        if (heir == NULL)
            continue;
        double *history = step->facets->list[heir->entry].history;
        memcpy(history, old->history, sizeof old->history);
        memset(old->history, 0, sizeof old->history);
        turn_history(history, heir->at.normal);
    }
}

/* ---- Law -------------------------------------------------------------------------------------- */

static struct vec3 wall_velocity(const struct body *body, struct vec3 point)
{
    if (!body->moves)
        return (struct vec3){0.0, 0.0, 0.0};
    const struct vec3 arm = vec3_sub(point, body->pivot_now);
    return vec3_add(body->velocity_now, vec3_cross(body->spin_now, arm));
}

/* The sphere is the first of the two, the wall the second. */
static struct contact_law_meeting meet(const struct step *step, const struct group *group,
                                       const struct contact_geometry *at, struct vec3 wall)
{
    const struct spheres *spheres = step->spheres;
    const double *spin = spheres->spin[group->sphere].lane;
    const struct vec3 normal = vec3_scale(-1.0, at->normal);
    const struct vec3 rolling = vec3_cross(vec3_of(spin), normal); /* R w x n [m/s] */
    const struct vec3 surface =
        vec3_add(vec3_of(sphere_velocity(spheres, group->sphere)), rolling);
    const double overlap = group->radius - at->distance;
    return (struct contact_law_meeting){
        .normal = {normal.x, normal.y, normal.z},
        .velocity = {wall.x - surface.x, wall.y - surface.y, wall.z - surface.z},
        .overlap = overlap > 0.0 ? overlap : 0.0,
        .inverse_radius = spin[3],
        .inverse_mass = spin[7],
    };
}

static void count_losses(const struct step *step, int sphere,
                         const struct contact_law_result *result)
{
    double *force = step->spheres->force[sphere].lane;
    force[3] += result->lost_friction;
    force[7] += result->lost_damping;
    step->spheres->dissipated_tangential[sphere] += result->lost_law;
}

/* Gives the body its force and torque and returns the force on the sphere, which is minus what the
 * body's exact sum took. */
static struct vec3 share_force(struct body_load *load, const double on_body[3],
                               struct vec3 point)
{
    const struct vec3 taken = {
        exact_sum_add(&load->force[0], on_body[0]),
        exact_sum_add(&load->force[1], on_body[1]),
        exact_sum_add(&load->force[2], on_body[2]),
    };
    const struct vec3 torque = vec3_cross(point, taken);
    exact_sum_add(&load->torque[0], torque.x);
    exact_sum_add(&load->torque[1], torque.y);
    exact_sum_add(&load->torque[2], torque.z);
    return vec3_scale(-1.0, taken);
}

static void press(const struct step *step, const struct group *group, const struct touch *touch)
{
    double *history = step->facets->list[touch->entry].history;
    const struct vec3 wall = wall_velocity(group->body, touch->at.point);
    const struct contact_law_meeting meeting = meet(step, group, &touch->at, wall);
    struct contact_law_result result;
    contact_law_scalar(&meeting, group->pair, step->dt, step->ledger, history, &result);

    const double *n = meeting.normal, *t = result.tangential;
    const double on_body[3] = {result.normal * n[0] + t[0], result.normal * n[1] + t[1],
                               result.normal * n[2] + t[2]}; /* [N] */
    const struct vec3 force = share_force(group->load, on_body, touch->at.point);
    const struct vec3 torque =
        vec3_scale(-group->radius, vec3_cross(vec3_of(n), vec3_of(t))); /* [N m] */
    double *row = step->spheres->force[group->sphere].lane;
    row[0] += force.x;
    row[1] += force.y;
    row[2] += force.z;
    row[4] += torque.x;
    row[5] += torque.y;
    row[6] += torque.z;
    if (group->body->moves)
        exact_sum_add(&group->load->work, vec3_dot(force, wall) * step->dt);
    if (step->ledger)
        count_losses(step, group->sphere, &result);
    const double overlap = meeting.overlap * meeting.inverse_radius;
    if (overlap > step->facets->overlap_max)
        step->facets->overlap_max = overlap;
}

/* The end of a contact: what its spring still held is lost. */
static void release(const struct step *step, const struct group *group, int entry)
{
    struct facet_contact *contact = &step->facets->list[entry];
    if (!holds_history(contact))
        return; /* handed over */
    if (step->ledger) {
        const struct contact_geometry at =
            contact_geometry_closest(&group->body->mesh, contact->feature, group->centre);
        const struct vec3 wall = wall_velocity(group->body, at.point);
        struct contact_law_meeting meeting = meet(step, group, &at, wall);
        meeting.overlap = 0.0;
        struct contact_law_result result;
        contact_law_scalar(&meeting, group->pair, step->dt, true, contact->history, &result);
        count_losses(step, group->sphere, &result);
    }
    memset(contact->history, 0, sizeof contact->history);
}

static void apply_group(const struct step *step, struct group *group)
{
    struct facet_work *work = step->facets->work;
    find_touches(step, group);
    if (group->n_touches > 1)
        choose_standing(step, group);
    else if (group->n_touches == 1)
        work->touches[0].stands = true;
    if (group->n_ended > 0 && group->n_touches > 0)
        hand_over(step, group);
    for (int t = 0; t < group->n_touches; t++)
        if (work->touches[t].stands)
            press(step, group, &work->touches[t]);
    for (int e = 0; e < group->n_ended; e++)
        release(step, group, work->ended[e]);
}

/* The entries from `begin` on that belong to the same sphere and body. */
static struct group group_at(const struct step *step, int begin)
{
    const struct facet_contacts *facets = step->facets;
    const struct facet_contact *first = &facets->list[begin];
    const int i = first->sphere, b = first->body;
    int end = begin + 1;
    while (end < facets->n && facets->list[end].sphere == i && facets->list[end].body == b)
        end++;
    const struct body *body = &step->bodies->list[b];
    const struct materials *materials = step->materials;
    return (struct group){
        .sphere = i,
        .begin = begin,
        .end = end,
        .body = body,
        .load = &facets->loads[b],
        .pair = &materials->pairs[step->spheres->material[i] * materials->n + body->material],
        .centre = vec3_of(sphere_position(step->spheres, i)),
        .radius = sphere_radius(step->spheres, i),
    };
}

static void reserve_group(struct facet_work *work, int n)
{
    if (n <= work->group_capacity)
        return;
    const size_t capacity = array_capacity((size_t)work->group_capacity, (size_t)n);
    free(work->touches);
    free(work->ended);
    work->touches = array_allocate(capacity, sizeof *work->touches);
    work->ended = array_allocate(capacity, sizeof *work->ended);
    work->group_capacity = (int)capacity;
}

void facet_contacts_apply(struct facet_contacts *facets, struct spheres *spheres,
                          const struct bodies *bodies, const struct materials *materials,
                          double dt, bool ledger)
{
    const struct step step = {facets, spheres, bodies, materials, dt, ledger};
    facets->overlap_max = 0.0;
    for (int k = 0; k < facets->n;) {
        struct group group = group_at(&step, k);
        reserve_group(facets->work, group.end - group.begin);
        apply_group(&step, &group);
        k = group.end;
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
        const double a = contact->history[CONTACT_RADIUS_LANE];
        const double curvature = spheres->spin[i].lane[3]; /* 1/R* [1/m] */
        exact_sum_add(sum, contact_law_elastic_energy(
                               a * a * curvature, curvature,
                               &materials->pairs[spheres->material[i] * materials->n + wall],
                               contact->history));
    }
}
