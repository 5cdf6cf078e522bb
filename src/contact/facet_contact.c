/* See facet_contact.h: which contacts there are, and what they hold. */
#include "contact/facet_contact.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "contact/facet_work.h"
#include "model/body.h"
#include "model/material.h"
#include "model/sphere.h"
#include "physics/contact_geometry.h"
#include "physics/contact_law.h"

static struct vec3 vec3_of(const double *lane)
{
    return (struct vec3){lane[0], lane[1], lane[2]};
}

void facet_contacts_init(struct facet_contacts *facets, int n_bodies, enum isa isa)
{
    *facets = (struct facet_contacts){.n_bodies = n_bodies, .moved = -1.0};
    facets->loads = array_allocate((size_t)n_bodies, sizeof *facets->loads);
    facets->work = array_allocate_rows(1, sizeof *facets->work);
    facets->work->trees = array_allocate((size_t)n_bodies, sizeof *facets->work->trees);
    facets->work->loads = array_allocate_rows((size_t)n_bodies, sizeof *facets->work->loads);
    facets->work->isa = isa_choose(isa);
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
    free(work->runs);
    free(work->plain);
    free(work->faced);
    free(work->faced_spheres);
    free(work->groups);
    free(work->near);
    free(work->is_near);
    free(work->due);
    free(work->is_busy);
    free(work->busy);
    facet_circles_clear(&work->standing);
    facet_circles_clear(&work->passing);
    facet_circles_clear(&work->surveyed);
    facet_local_clear(&work->local);
    facet_patch_clear(&work->patch);
    free(work->corners);
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
        facet_tree_query(&work->trees[b], mesh, false, centre, radius, &work->found);
        for (int k = 0; k < work->found.n; k++)
            if (contact_geometry_touches(mesh, work->found.features[k], centre, radius, &at))
                return true;
    }
    return false;
}

/* Of a body that deforms spheres meet faces alone. */
static bool meets_faces_alone(const struct body *body)
{
    return body->skin != NULL;
}

static void find_all_features(struct facet_tree_found *found, const struct body *body)
{
    found->n = meets_faces_alone(body) ? body->mesh.n_faces : mesh_n_features(&body->mesh);
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
        else if (facet_contact_touched(before))
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
static void find_across(struct facet_work *work, int b, const struct body *body,
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
        facet_tree_query(&work->trees[b], &body->mesh, meets_faces_alone(body), vec3_of(image),
                         reach, across);
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

static void find_features(struct facet_work *work, int b, const struct body *body,
                          const struct spheres *spheres, int i, double body_allowance)
{
    const double reach = sphere_reach(spheres, i) + body_allowance;
    facet_tree_query(&work->trees[b], &body->mesh, meets_faces_alone(body),
                     vec3_of(sphere_position(spheres, i)), reach, &work->found);
    if (spheres->periodic.any)
        find_across(work, b, body, spheres, i, reach);
}

static void keep_met(const struct facet_contacts *facets, struct facet_tree_found *found, int i,
                     int b)
{
    int n = 0;
    for (int k = 0; k < found->n && facets->meets != NULL; k++)
        if (facets->meets(facets->from, i, b, found->features[k]))
            found->features[n++] = found->features[k];
    found->n = facets->meets != NULL ? n : found->n;
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
            const struct body *body = &bodies->list[b];
            if (all_pairs)
                find_all_features(found, body);
            else
                find_features(work, b, body, spheres, i, body_allowance[b]);
            keep_met(facets, found, i, b);
            for (int k = 0; k < found->n; k++)
                list_contact(facets,
                             (struct facet_contact){
                                 .sphere = i, .body = b, .feature = found->features[k]},
                             &old, &n);
        }
    }
    for (; old < facets->n; old++)
        if (facet_contact_touched(&facets->list[old]))
            n = append(work, n, &facets->list[old]);
    exchange_lists(facets, n);
}

/* ---- Records
 * ---------------------------------------------------------------------------------- */

static bool is_recorded(const struct facet_contacts *facets, int k,
                        const struct spheres *spheres, int64_t begin, int64_t end)
{
    const int64_t id = spheres->id[facets->list[k].sphere];
    return facet_contact_touched(&facets->list[k]) && id >= begin && id < end;
}

int facet_contacts_records(const struct facet_contacts *facets, const struct spheres *spheres,
                           int64_t begin, int64_t end, struct facet_contact_record **records)
{
    int n = 0;
    for (int k = 0; k < facets->n; k++)
        n += is_recorded(facets, k, spheres, begin, end);
    *records = array_resize(*records, 0, (size_t)n, sizeof **records);
    n = 0;
    for (int k = 0; k < facets->n; k++) {
        const struct facet_contact *contact = &facets->list[k];
        if (!is_recorded(facets, k, spheres, begin, end))
            continue;
        struct facet_contact_record *record = &(*records)[n++];
        *record = (struct facet_contact_record){
            spheres->id[contact->sphere], contact->body, contact->feature, {0.0}};
        memcpy(record->history, contact->history, sizeof record->history);
    }
    return n;
}

int facet_contacts_count(const struct facet_contacts *facets)
{
    int n = 0;
    for (int k = 0; k < facets->n; k++)
        n += facet_contact_touched(&facets->list[k]);
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

/* ---- Energies
 * --------------------------------------------------------------------------------- */

double facet_contacts_reach(const struct facet_contacts *facets, const struct spheres *spheres,
                            const struct bodies *bodies, int entry)
{
    const struct facet_contact *list = facets->list, *own = &list[entry];
    const struct vec3 centre = sphere_place(spheres, own->sphere);
    const double radius = sphere_radius(spheres, own->sphere);
    double most = 0.0;
    int k = entry;
    while (k > 0 && list[k - 1].sphere == own->sphere && list[k - 1].body == own->body)
        k--;
    for (; k < facets->n && list[k].sphere == own->sphere && list[k].body == own->body; k++) {
        const double reach =
            facet_patch_reach(&bodies->list[own->body].mesh, list[k].feature, centre, radius);
        most = reach > most ? reach : most;
    }
    return most;
}

/* What the contact across a surface that goes stores half a step before: that is what is lost
 * with it, between the last step with it and the first without. (7.4) */
static double held_energy(const struct spheres *spheres, const struct body *body,
                          const struct facet_contact *contact, const struct material_pair *pair,
                          double dt)
{
    const int i = contact->sphere;
    const struct vec3 centre = sphere_place(spheres, i);
    const struct vec3 drift =
        vec3_sub(vec3_of(sphere_velocity(spheres, i)), body_drift(body, centre));
    body_renew_face(body, contact->feature);
    const struct contact_geometry at = contact_geometry_closest(
        &body->mesh, contact->feature, vec3_axpy(centre, -0.5 * dt, drift));
    const double overlap = sphere_radius(spheres, i) - at.distance;
    if (!(overlap > 0.0))
        return 0.0;
    return contact_law_normal_energy(overlap, sphere_curvature(spheres, i), pair);
}

void facet_contacts_held(const struct facet_contacts *facets, const struct spheres *spheres,
                         const struct bodies *bodies, const struct materials *materials,
                         double dt, struct exact_sum *sum)
{
    for (int k = 0; k < facets->n; k++) {
        const struct facet_contact *contact = &facets->list[k];
        const struct body *body = &bodies->list[contact->body];
        const int material = spheres->material[contact->sphere];
        if (!body->exists && facet_contact_touched(contact))
            exact_sum_add(
                sum, facet_work_width(facets, contact->sphere) *
                         held_energy(
                             spheres, body, contact,
                             &materials->pairs[material * materials->n + body->material], dt));
    }
}

void facet_contacts_elastic_energy(const struct facet_contacts *facets,
                                   const struct spheres *spheres, const struct bodies *bodies,
                                   const struct materials *materials, struct exact_sum *normal,
                                   struct exact_sum *springs)
{
    for (int k = 0; k < facets->n; k++) {
        const struct facet_contact *contact = &facets->list[k];
        if (!facet_contact_touched(contact))
            continue;
        const int i = contact->sphere, wall = bodies->list[contact->body].material;
        const struct material_pair *pair =
            &materials->pairs[spheres->material[i] * materials->n + wall];
        exact_sum_add(normal, facet_work_width(facets, i) *
                                  contact_law_normal_energy(
                                      contact->overlap, sphere_curvature(spheres, i), pair));
        exact_sum_add(springs, contact_law_spring_energy(pair, contact->history));
    }
}
