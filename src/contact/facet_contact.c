/*
 * Contacts of spheres with rigid bodies: see facet_contact.h.
 *
 * Spheres that may only touch one face of one body are put together face by face, and the
 * kernel finds out for whole vectors of them whether they do. Of all others each step goes
 * through the list sphere by sphere and body by body. The local search says which contacts of
 * such a group act; these, and those that end, are gathered into a batch, in order, for which
 * the law is then taken at once; what comes of it is added contact by contact in the same
 * order. So neither the list nor the size of a batch shows in the result.
 *
 * Where facets are finer than spheres, a group is long, and most of it is too far to touch
 * within the next steps. So each long group knows which of its entries are near, and looks at
 * the others only when the sphere and the body have together moved as far as these were from
 * touching. A sphere at rest looks at all once a search, and a group of which nothing is near
 * is not even visited before the fastest sphere may have gone that far.
 *
 * Before a surface that deforms nearly all balls cover a circle within one triangle or nothing.
 * Those for which one triangle is near stand in a list that the kernel goes through by itself;
 * of others it is asked what their triangles are covered of, and only where that is more than
 * one circle are patches found and added up (contact/facet_patch.h).
 */
#include "contact/facet_contact.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "contact/facet_circles.h"
#include "contact/facet_kernel.h"
#include "contact/facet_local.h"
#include "contact/facet_patch.h"
#include "contact/facet_tree.h"
#include "model/body.h"
#include "model/material.h"
#include "model/rigid.h"
#include "model/sphere.h"
#include "physics/contact_geometry.h"
#include "physics/contact_law.h"
#include "physics/contact_patch.h"

/* The entries of a sphere with a body, begin to end of the list; `near` numbers those from
 * begin on that may touch until the two have moved by `slack`. */
struct group {
    int begin, end, n_near;
    int sphere;       /* index */
    bool is_alone;    /* nothing else is listed of the sphere */
    int circle;       /* its place among the circles that may be; -1: not there */
    double slack;     /* [m]; negative: not looked at yet */
    double travelled; /* by bodies when it was looked at [m] */
    struct vec3 from; /* where the sphere was [m] */
};

/* Until when a group's near entries are all that may touch: what facet_contacts.moved and the
 * way of the fastest body may come to. */
struct due {
    double moved, travelled; /* [-], [m] */
};

/* What a batch's contact pushes of a surface that deforms. */
struct pushed {
    int begin, end;      /* corners; none of a contact that ends */
    double pressure;     /* of the normal spring [Pa] */
    struct vec3 elastic; /* its force, on the body [N] */
    bool holds_energy;   /* of the normal spring: of several parts one does */
};

struct facet_work {
    struct facet_tree *trees; /* one a body */
    bool has_trees;
    struct facet_tree_found found, across;
    int next_capacity;
    struct facet_contact *next; /* the list that is being made */
    struct facet_local local;
    struct facet_patch patch;
    enum isa isa;
    struct facet_kernel_batch batch;
    struct pushed pushed[FACET_KERNEL_BATCH]; /* of bodies that deform */
    struct facet_kernel_circles standing; /* of groups with one near entry, while that is so */
    struct facet_kernel_circles passing; /* of other groups in this step, circles for certain */
    struct facet_kernel_circles surveyed; /* entries of which one of a group may be */
    int n_corners, corner_capacity;
    struct facet_patch_corner *corners; /* of the batch's contacts with such bodies */
    struct facet_kernel_load *loads;    /* one a body */
    int n_summed;                       /* contacts in them, at most */
    struct facet_contact dummy;
    bool has_groups; /* and runs */
    int n_runs, run_capacity, n_plain, plain_capacity, faced_capacity;
    struct facet_kernel_run *runs;
    struct facet_contact **plain; /* contacts that may only touch one face */
    struct facet_contact **faced; /* those in runs, padded */
    int *faced_spheres;           /* theirs */
    int n_groups, group_capacity, near_capacity;
    struct group *groups;
    int *near; /* of all groups, each at its entries' places */
    int is_near_capacity;
    bool *is_near;      /* of one group */
    struct due *due;    /* of all groups */
    bool *is_busy;      /* those to be looked at in every step */
    int n_busy, *busy;  /* these, ascending */
    bool busy_is_stale; /* is_busy has changed, or what is near of them */
    double travelled;   /* by the fastest point of any body [m] */
};

/* What a step's contacts need. */
struct step {
    struct facet_contacts *facets;
    struct spheres *spheres;
    const struct bodies *bodies;
    struct facet_kernel kernel;
    struct facet_kernel_work *kernel_work;
};

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

/* ---- Step
 * ------------------------------------------------------------------------------------- */

/* What bodies felt in this step so far goes to their loads. */
static void merge_loads(struct facet_contacts *facets, int b)
{
    struct facet_kernel_load *step = &facets->work->loads[b];
    struct body_load *load = &facets->loads[b];
    for (int x = 0; x < 3; x++) {
        lanes_exact_merge(&step->sums[x], step->n_terms, &load->force[x]);
        lanes_exact_merge(&step->sums[3 + x], step->n_terms, &load->torque[x]);
    }
    lanes_exact_merge(&step->sums[6], step->n_terms, &load->work);
    lanes_exact_merge(&step->sums[7], step->n_terms, &load->wound);
    load->force[0].overflow += step->n_overflow;
    step->n_terms = step->n_overflow = 0;
}

static void merge_all_loads(struct facet_contacts *facets)
{
    for (int b = 0; b < facets->n_bodies; b++)
        if (facets->work->loads[b].n_terms > 0)
            merge_loads(facets, b);
    facets->work->n_summed = 0;
}

/* Before n more contacts, so that no sum is filled. */
static void make_room(struct facet_contacts *facets, int n)
{
    if (facets->work->n_summed + n > LANES_EXACT_TERMS)
        merge_all_loads(facets);
    facets->work->n_summed += n;
}

/* Gives the force of a batch's contact to the corners of a surface that deforms: that of the
 * normal spring as a pressure on the covered area, all else by the corners' weights.  The last
 * one has what is left, so that shares add up to the force but for rounding. */
static void push_skin(const struct step *step, int k)
{
    const struct facet_work *work = step->facets->work;
    const struct body_skin *skin = step->bodies->list[work->batch.contact[k]->body].skin;
    const struct pushed *pushed = &work->pushed[k];
    if (skin == NULL || pushed->begin == pushed->end)
        return;
    const double elastic[3] = {pushed->elastic.x, pushed->elastic.y, pushed->elastic.z};
    struct exact_vector *last = body_skin_push(skin, work->corners[pushed->end - 1].corner);
    for (int x = 0; x < 3; x++) {
        const double force = work->batch.force[x][k], rest = force - elastic[x];
        double left = force;
        for (int c = pushed->begin; c < pushed->end - 1; c++) {
            const struct facet_patch_corner *corner = &work->corners[c];
            const double area[3] = {corner->pushed.x, corner->pushed.y, corner->pushed.z};
            const double share = corner->weight * rest - pushed->pressure * area[x];
            exact_vector_add(body_skin_push(skin, corner->corner), x, share);
            left -= share;
        }
        exact_vector_add(last, x, left);
    }
    if (!pushed->holds_energy)
        work->batch.contact[k]->overlap = 0.0;
}

static void empty_batch(const struct step *step)
{
    struct facet_kernel_batch *batch = &step->facets->work->batch;
    if (batch->n == 0)
        return;
    make_room(step->facets, batch->n);
    step->kernel.batch(step->kernel_work, batch);
    for (int k = 0; k < batch->n; k++)
        push_skin(step, k);
    batch->n = step->facets->work->n_corners = 0;
}

static void apply_run(const struct step *step, const struct facet_kernel_run *run)
{
    make_room(step->facets, run->n);
    step->kernel.run(step->kernel_work, run);
}

static void put_lanes(double places[3][FACET_KERNEL_BATCH], int k, struct vec3 value)
{
    places[0][k] = value.x;
    places[1][k] = value.y;
    places[2][k] = value.z;
}

static double width_of(const struct facet_contacts *facets, int sphere)
{
    return facets->width != NULL ? facets->width[sphere] : 1.0;
}

/* Puts a contact into the batch, of a body that does not move; returns where. */
static int add_resting(const struct step *step, int entry, const struct contact_geometry *at,
                       double overlap)
{
    struct facet_kernel_batch *batch = &step->facets->work->batch;
    const struct facet_kernel_work *work = step->kernel_work;
    struct facet_contact *contact = &step->facets->list[entry];
    if (batch->n == FACET_KERNEL_BATCH)
        empty_batch(step);
    const int k = batch->n++;
    batch->contact[k] = contact;
    batch->sphere[k] = contact->sphere;
    batch->load[k] = &step->facets->work->loads[contact->body];
    batch->pair[k] = &work->pairs[work->material[contact->sphere] * work->n_materials +
                                  step->bodies->list[contact->body].material];
    put_lanes(batch->normal, k, vec3_scale(-1.0, at->normal)); /* sphere to body */
    put_lanes(batch->point, k, at->point);
    put_lanes(batch->wall, k, (struct vec3){0.0, 0.0, 0.0});
    put_lanes(batch->turns, k, (struct vec3){0.0, 0.0, 0.0});
    batch->overlap[k] = overlap;
    batch->yield[k] = 0.0;
    batch->width[k] = width_of(step->facets, contact->sphere);
    step->facets->work->pushed[k] = (struct pushed){0};
    return k;
}

/* Puts a contact into the batch; one that ends has no overlap, and what its spring still held
 * is counted as lost. */
static void add_contact(const struct step *step, int entry, const struct contact_geometry *at,
                        double overlap)
{
    struct facet_kernel_batch *batch = &step->facets->work->batch;
    const struct body *body = &step->bodies->list[step->facets->list[entry].body];
    const int k = add_resting(step, entry, at, overlap);
    const struct vec3 normal = vec3_scale(-1.0, at->normal);
    if (body->rigid != NULL)
        batch->yield[k] = rigid_yield(body->rigid, at->point, normal);
    if (body->moves || body->surface_runs) {
        put_lanes(batch->wall, k, body_velocity(body, at->point, normal));
        put_lanes(batch->turns, k, body_spin(body));
    }
}

/* ---- Surfaces that deform
 * ----------------------------------------------------------------------- */

static const double PI = 3.14159265358979323846;

/* How the covered part of the surface moves [m/s], and how easily it yields [1/kg]. */
static void move_with_skin(const struct step *step, const struct body_skin *skin, int k)
{
    struct facet_work *work = step->facets->work;
    const struct pushed *pushed = &work->pushed[k];
    struct vec3 velocity = {0.0, 0.0, 0.0};
    double yield = 0.0;
    for (int c = pushed->begin; c < pushed->end; c++) {
        const struct facet_patch_corner *corner = &work->corners[c];
        velocity = vec3_axpy(velocity, corner->weight, skin->velocity[corner->corner]);
        yield += corner->weight * corner->weight * skin->inverse_mass[corner->corner];
    }
    put_lanes(work->batch.wall, k, velocity);
    work->batch.yield[k] = yield;
}

/* Takes the corners of a part over for contact k. */
static void keep_corners(struct facet_work *work, int k, const struct facet_patch *patch,
                         const struct facet_patch_part *part)
{
    const int n = part->end - part->begin;
    ARRAY_GROW(work->corners, work->n_corners + n, work->corner_capacity);
    memcpy(work->corners + work->n_corners, patch->corners + part->begin,
           (size_t)n * sizeof *work->corners);
    work->pushed[k].begin = work->n_corners;
    work->pushed[k].end = work->n_corners += n;
}

/* The contact on a smooth part of the surface. (2.7) */
static void add_part(const struct step *step, int begin, const struct facet_patch_part *part)
{
    struct facet_work *work = step->facets->work;
    const struct facet_patch *patch = &work->patch;
    const struct facet_contact *contact = &step->facets->list[begin + part->entry];
    const double radius = sphere_radius(step->spheres, contact->sphere);
    const double facing = vec3_norm(part->facing), inverse = facing > 0.0 ? 1.0 / facing : 0.0;
    const struct vec3 centre = sphere_place(step->spheres, contact->sphere);
    struct contact_geometry at = {.normal = vec3_scale(inverse, part->facing)};
    at.point = vec3_axpy(centre, patch->depth - radius, at.normal); /* pressure has no moment */
    const int k = add_resting(step, begin + part->entry, &at, patch->depth);
    const double plane = PI * patch->depth * (2.0 * radius - patch->depth); /* [m2] */
    const double curvature = sphere_curvature(step->spheres, contact->sphere);
    const double pressure =
        work->batch.width[k] *
        contact_law_normal_force(patch->depth, curvature, work->batch.pair[k]) / plane;
    work->batch.width[k] *= facing / plane;
    work->pushed[k] = (struct pushed){.pressure = pressure,
                                      .elastic = vec3_scale(-pressure, part->facing),
                                      .holds_energy = part == patch->parts};
    keep_corners(work, k, patch, part);
    move_with_skin(step, step->bodies->list[contact->body].skin, k);
}

/* A contact that has ended, as seen from the face that it was on last. */
static void end_part(const struct step *step, int entry)
{
    struct facet_work *work = step->facets->work;
    const struct facet_contact *contact = &step->facets->list[entry];
    const struct body *body = &step->bodies->list[contact->body];
    body_renew_face(body, contact->feature);
    facet_patch_whole(&work->patch, body, contact->feature);
    const struct facet_patch_part *part = work->patch.parts;
    const struct contact_geometry at = {.normal = part->facing};
    const int k = add_resting(step, entry, &at, 0.0);
    keep_corners(work, k, &work->patch, part);
    move_with_skin(step, body->skin, k);
}

/* What a body that is not there still holds ends. */
static void end_group(const struct step *step, int begin, int end)
{
    for (int k = begin; k < end; k++) {
        const struct facet_contact *contact = &step->facets->list[k];
        if (!facet_contact_touched(contact))
            continue;
        const struct body *body = &step->bodies->list[contact->body];
        body_renew_face(body, contact->feature);
        const struct contact_geometry at = contact_geometry_closest(
            &body->mesh, contact->feature, sphere_place(step->spheres, contact->sphere));
        add_contact(step, k, &at, 0.0);
    }
}

/* ---- Groups
 * ----------------------------------------------------------------------------------- */

enum {
    LONG_GROUP = 6,     /* shorter ones are looked at as a whole */
    LONG_PATCH = 2,     /* of a body that deforms: to look at a face costs more */
    RUN_MOST = 1 << 16, /* contacts */
    AHEAD = 6,          /* groups */
};
/* How far beyond touching counts as near: of the radius, and in steps of the present speed; and
 * how far where it should be few. */
static const double NEAR_RADII = 0.05, NEAR_STEPS = 8.0, CLOSE_RADII = 0.001,
                    CLOSE_STEPS = 40.0;
static const double SLACK_TAKEN = 0.9999; /* the rest is for rounding */

static void add_group(struct facet_work *work, int begin, int end, int sphere, bool is_alone)
{
    ARRAY_GROW(work->groups, work->n_groups + 1, work->group_capacity);
    work->groups[work->n_groups++] = (struct group){.begin = begin,
                                                    .end = end,
                                                    .sphere = sphere,
                                                    .is_alone = is_alone,
                                                    .circle = -1,
                                                    .slack = -1.0};
}

/* May the kernel find out by itself whether these touch, all that is listed of a sphere? */
static bool are_plain(const struct facet_contact *entries, int n, const struct bodies *bodies)
{
    const struct body *body = &bodies->list[entries->body];
    return n == 1 && entries->feature < body->mesh.n_faces && body->rigid == NULL &&
           body->surface == NULL && body->skin == NULL;
}

/* By face, then in order. */
static int compare_plain(const void *a, const void *b)
{
    const struct facet_contact *const *p = a, *const *q = b;
    if ((*p)->body != (*q)->body)
        return (*p)->body < (*q)->body ? -1 : 1;
    if ((*p)->feature != (*q)->feature)
        return (*p)->feature < (*q)->feature ? -1 : 1;
    return (*p > *q) - (*p < *q);
}

/* Padding at most doubles a run. */
static void reserve_faced(struct facet_work *work)
{
    const int needed = 2 * work->n_plain + FACET_KERNEL_AHEAD + FACET_KERNEL_PAD;
    int capacity = work->faced_capacity;
    ARRAY_GROW(work->faced_spheres, needed, capacity);
    ARRAY_GROW(work->faced, needed, work->faced_capacity);
}

static void add_faced(struct facet_work *work, int *n, struct facet_contact *contact)
{
    work->faced[*n] = contact;
    work->faced_spheres[(*n)++] = contact->sphere;
}

/* Makes runs of the plain contacts; those of faces with few go one by one. */
static void list_runs(struct facet_contacts *facets, const struct bodies *bodies)
{
    struct facet_work *work = facets->work;
    int n = 0;
    if (work->n_plain > 1)
        qsort(work->plain, (size_t)work->n_plain, sizeof *work->plain, compare_plain);
    reserve_faced(work);
    for (int k = 0, end; k < work->n_plain; k = end) {
        const struct facet_contact *first = work->plain[k];
        for (end = k + 1; end < work->n_plain; end++)
            if (work->plain[end]->body != first->body ||
                work->plain[end]->feature != first->feature || end - k == RUN_MOST)
                break;
        if (end - k < FACET_KERNEL_PAD / 2) {
            for (int m = k; m < end; m++)
                add_group(work, (int)(work->plain[m] - facets->list),
                          (int)(work->plain[m] - facets->list) + 1, work->plain[m]->sphere,
                          true);
            continue;
        }
        struct facet_kernel_run run = {.body = &bodies->list[first->body],
                                       .face = first->feature,
                                       .contacts = work->faced + n,
                                       .spheres = work->faced_spheres + n,
                                       .load = &work->loads[first->body]};
        for (int m = k; m < end; m++)
            add_faced(work, &n, work->plain[m]);
        for (run.n = end - k; run.n % FACET_KERNEL_PAD != 0; run.n++)
            add_faced(work, &n, &work->dummy);
        ARRAY_GROW(work->runs, work->n_runs + 1, work->run_capacity);
        work->runs[work->n_runs++] = run;
    }
    for (int ahead = 0; ahead < FACET_KERNEL_AHEAD + FACET_KERNEL_PAD; ahead++)
        add_faced(work, &n, &work->dummy);
}

/* None has been looked at. */
static void begin_groups(struct facet_work *work)
{
    const size_t n = (size_t)work->n_groups;
    free(work->due);
    free(work->is_busy);
    free(work->busy);
    work->due = array_allocate(n, sizeof *work->due);
    work->is_busy = array_allocate(n, sizeof *work->is_busy);
    work->busy = array_allocate(n, sizeof *work->busy);
    for (int g = 0; g < work->n_groups; g++)
        work->due[g] = (struct due){-(double)INFINITY, -(double)INFINITY};
    work->n_busy = work->standing.n = work->surveyed.n = 0;
    work->busy_is_stale = false;
}

/* Who is looked at in groups, and who in runs: a sphere's contacts with several bodies follow
 * each other in the order of the list. */
static void list_groups(struct facet_contacts *facets, const struct spheres *spheres,
                        const struct bodies *bodies)
{
    struct facet_work *work = facets->work;
    struct facet_contact *list = facets->list;
    work->n_groups = work->n_runs = work->n_plain = 0;
    work->dummy = (struct facet_contact){.sphere = spheres->n_all};
    ARRAY_GROW(work->near, facets->n, work->near_capacity);
    for (int k = 0, end; k < facets->n; k = end) {
        for (end = k + 1; end < facets->n && list[end].sphere == list[k].sphere; end++)
            continue;
        if (are_plain(&list[k], end - k, bodies) && !spheres->periodic.any &&
            facets->width == NULL) {
            ARRAY_GROW(work->plain, work->n_plain + 1, work->plain_capacity);
            work->plain[work->n_plain++] = &list[k];
            continue;
        }
        for (int begin = k, m = k + 1; m <= end; m++)
            if (m == end || list[m].body != list[begin].body) {
                add_group(work, begin, m, list[k].sphere, list[k].body == list[end - 1].body);
                begin = m;
            }
    }
    list_runs(facets, bodies);
    begin_groups(work);
    work->has_groups = true;
}

/* Finds out which entries of a body a ball of this radius reaches. */
static void find_near(const struct step *step, const struct body *body, int n,
                      const struct facet_contact *entries, struct vec3 centre, double radius,
                      bool *is_near)
{
    if (body->skin == NULL) {
        for (int k = 0; k < n; k++)
            is_near[k] =
                contact_geometry_reaches(&body->mesh, entries[k].feature, centre, radius);
        return;
    }
    for (int k = 0; k < n && body->mesh.n_vertices > body->mesh.n_corners; k++)
        body_renew_mean(body, entries[k].feature);
    step->kernel.reaches(body, n, entries, centre, radius, is_near);
}

/* Lists entries that may touch until sphere and body have moved by the group's slack. */
static void list_near(const struct step *step, struct group *group, struct vec3 centre)
{
    struct facet_work *work = step->facets->work;
    const struct facet_contact *entries = &step->facets->list[group->begin];
    const struct body *body = &step->bodies->list[entries->body];
    const double reach = sphere_radius(step->spheres, entries->sphere) + group->slack;
    const int n = group->end - group->begin;
    const bool all = !(reach < (double)INFINITY);
    group->n_near = 0;
    ARRAY_GROW(work->is_near, n, work->is_near_capacity);
    if (!all)
        find_near(step, body, n, entries, centre, reach, work->is_near);
    for (int k = 0; k < n; k++)
        if (all || facet_contact_touched(&entries[k]) || work->is_near[k])
            work->near[group->begin + group->n_near++] = k;
}

/* How far a ball that touches none of a body's near faces is from all of them at least [m]; less
 * than nothing where it may touch. */
static double gap_of(const struct step *step, const struct group *group, struct vec3 centre)
{
    const struct facet_contact *entries = &step->facets->list[group->begin];
    const struct body *body = &step->bodies->list[entries->body];
    const int *near = &step->facets->work->near[group->begin];
    double least = (double)INFINITY;
    for (int m = 0; m < group->n_near; m++) {
        const struct facet_contact *entry = &entries[near[m]];
        if (facet_contact_touched(entry))
            return 0.0;
        body_renew_face(body, entry->feature);
        const double distance =
            contact_geometry_closest(&body->mesh, entry->feature, centre).distance;
        least = distance < least ? distance : least;
    }
    return least - sphere_radius(step->spheres, group->sphere);
}

/* Finds out which entries of a group are near.  What faces of a body that deforms are near is
 * looked at in every step: none are as far as the nearest is away.  A ball covers far more of a
 * plane where it is but a little deeper: where that makes several of them near, less may make
 * it one. */
static void look_around(const struct step *step, struct group *group, struct vec3 centre)
{
    const struct facet_contact *entries = &step->facets->list[group->begin];
    const struct body *body = &step->bodies->list[entries->body];
    const double radius = sphere_radius(step->spheres, entries->sphere);
    const double speed = vec3_norm(vec3_of(sphere_velocity(step->spheres, entries->sphere))) +
                         (body->moves ? body->speed_max : 0.0);
    const double way = step->kernel_work->dt * speed;
    const bool is_long =
        group->end - group->begin >= (body->skin != NULL ? LONG_PATCH : LONG_GROUP);
    group->from = centre;
    group->travelled = step->facets->work->travelled;
    group->slack = is_long ? NEAR_RADII * radius + NEAR_STEPS * way : (double)INFINITY;
    list_near(step, group, centre);
    if (body->skin == NULL || group->n_near == 0)
        return;
    const double close = CLOSE_RADII * radius + CLOSE_STEPS * way;
    const double gap = SLACK_TAKEN * gap_of(step, group, centre);
    if (group->n_near == 1 && gap < close)
        return;
    group->slack = gap > close ? gap : close;
    list_near(step, group, centre);
}

/* How far a group's sphere may be from where it was, and bodies that move have travelled,
 * before the near entries are not all that may touch. */
static double reach_of(const struct group *group)
{
    return SLACK_TAKEN * group->slack + group->travelled;
}

/* Bodies are where they are in this step: no point of one has gone farther than this. */
static void count_travel(const struct step *step)
{
    double most = 0.0;
    for (int b = 0; b < step->bodies->n; b++) {
        const struct body *body = &step->bodies->list[b];
        if (body->moves && body->speed_max > most)
            most = body->speed_max;
    }
    step->facets->work->travelled += 1.001 * most * step->kernel_work->dt;
}

static const struct body *body_of(const struct step *step, const struct group *group)
{
    return &step->bodies->list[step->facets->list[group->begin].body];
}

/* May a kernel find out by itself what near entries cover? */
static bool may_be_seen(const struct step *step, const struct group *group)
{
    const struct body *body = body_of(step, group);
    return body->skin != NULL && group->is_alone && !body->comes_and_goes &&
           !step->spheres->periodic.any;
}

/* When a group is to be looked at again: half of what is left is the body's.  In the next step
 * if nobody says how far spheres go, or where they may come out on the other side. */
static struct due due_of(const struct step *step, const struct group *group, double left)
{
    const double moved = step->facets->moved;
    const bool moves = body_of(step, group)->moves;
    const double own = (moves ? 0.499 : 0.999) * left;
    struct due due = {(double)INFINITY, (double)INFINITY};
    if (group->n_near > 0 && may_be_seen(step, group)) /* the kernel sees to it */
        return due;
    if (moves)
        due.travelled = step->facets->work->travelled + own;
    due.moved = moved + own * step->spheres->inverse_allowance[group->sphere][0];
    if ((moved < 0.0 || step->spheres->periodic.any) && left < (double)INFINITY)
        due.moved = moved;
    return due;
}

/* ---- Circles
 * ---------------------------------------------------------------------------------- */

static int add_circle(const struct step *step, struct facet_kernel_circles *circles, int g,
                      int entry, double reach)
{
    struct facet_contact *contact = &step->facets->list[entry];
    const struct vec3 from = step->facets->work->groups[g].from;
    return facet_circles_add(
        circles, &(struct facet_kernel_entry){.from = {from.x, from.y, from.z},
                                              .reach = reach,
                                              .contact = contact,
                                              .body = &step->bodies->list[contact->body],
                                              .load = &step->facets->work->loads[contact->body],
                                              .sphere = contact->sphere,
                                              .group = g});
}

/* For this step alone. */
static void add_passing(const struct step *step, int g, int entry)
{
    (void)add_circle(step, &step->facets->work->passing, g, entry, (double)INFINITY);
}

static void take_standing(struct facet_work *work, struct group *group)
{
    struct facet_kernel_circles *standing = &work->standing;
    if (group->circle < 0)
        return;
    work->groups[standing->list[standing->n - 1].group].circle = group->circle;
    facet_circles_take(standing, group->circle);
    group->circle = -1;
}

/* A group's near entries have been found. */
static void sort_group(const struct step *step, int g)
{
    struct facet_work *work = step->facets->work;
    struct group *group = &work->groups[g];
    const bool stands = group->n_near == 1 && may_be_seen(step, group);
    const bool is_busy = !stands && (group->n_near > 0 || body_of(step, group)->comes_and_goes);
    take_standing(work, group);
    if (stands)
        group->circle = add_circle(step, &work->standing, g,
                                   group->begin + work->near[group->begin], reach_of(group));
    work->busy_is_stale = work->busy_is_stale || is_busy || work->is_busy[g];
    work->is_busy[g] = is_busy;
}

static void look_again(const struct step *step, int g)
{
    struct facet_work *work = step->facets->work;
    struct group *group = &work->groups[g];
    look_around(step, group, sphere_place(step->spheres, group->sphere));
    sort_group(step, g);
    work->due[g] = due_of(step, group, group->slack);
}

/* Looks at a group that is due, if its sphere has gone so far. */
static void examine(const struct step *step, int g)
{
    const struct group *group = &step->facets->work->groups[g];
    const struct vec3 centre = sphere_place(step->spheres, group->sphere);
    const double travelled =
        body_of(step, group)->moves ? step->facets->work->travelled : group->travelled;
    const double left = reach_of(group) - travelled - vec3_norm(vec3_sub(centre, group->from));
    if (left > 0.0)
        step->facets->work->due[g] = due_of(step, group, left);
    else
        look_again(step, g);
}

static void examine_due(const struct step *step)
{
    const struct facet_work *work = step->facets->work;
    const double moved = step->facets->moved, travelled = work->travelled;
    for (int g = 0; g < work->n_groups; g++)
        if (!(moved < work->due[g].moved && travelled < work->due[g].travelled))
            examine(step, g);
}

/* All near entries of a group of which nothing else is listed. */
static void survey(const struct step *step, int g)
{
    struct facet_work *work = step->facets->work;
    const struct group *group = &work->groups[g];
    for (int m = 0; m < group->n_near; m++)
        (void)add_circle(step, &work->surveyed, g, group->begin + work->near[group->begin + m],
                         reach_of(group));
}

/* Lists groups that are looked at in every step, and entries that a kernel surveys. */
static void list_busy(const struct step *step)
{
    struct facet_work *work = step->facets->work;
    if (!work->busy_is_stale)
        return;
    work->busy_is_stale = false;
    work->n_busy = work->surveyed.n = 0;
    for (int g = 0; g < work->n_groups; g++) {
        if (!work->is_busy[g])
            continue;
        if (may_be_seen(step, &work->groups[g]))
            survey(step, g);
        else
            work->busy[work->n_busy++] = g;
    }
}

static void gather_patch(const struct step *step, const struct group *place,
                         bool may_be_circle);

static void press_circles(const struct step *step, struct facet_kernel_circles *circles)
{
    make_room(step->facets, circles->n);
    circles->travelled = step->facets->work->travelled;
    facet_circles_renew_means(circles);
    step->kernel.circles(step->kernel_work, circles);
}

static void press_passing(const struct step *step)
{
    struct facet_kernel_circles *passing = &step->facets->work->passing;
    press_circles(step, passing);
    for (int k = 0; k < passing->n; k++)
        CHECK(passing->kind[k] == FACET_KERNEL_CIRCLE, "sphere %d is before no circle",
              passing->list[k].sphere);
    passing->n = 0;
}

/* All that may be circles as long as nothing has gone far.  What else balls cover, and those
 * that have gone, are looked at one by one: those from the last on, whose place others take. */
static void press_standing(const struct step *step)
{
    struct facet_work *work = step->facets->work;
    struct facet_kernel_circles *standing = &work->standing;
    press_circles(step, standing);
    for (int k = standing->n - 1; k >= 0; k--) {
        const int g = standing->list[k].group;
        if (standing->kind[k] == FACET_KERNEL_OTHER)
            gather_patch(step, &work->groups[g], false);
        if (standing->kind[k] != FACET_KERNEL_GONE)
            continue;
        look_again(step, g);
        if (work->groups[g].circle >= 0)
            gather_patch(step, &work->groups[g], true);
    }
}

/* A circle of a sphere; where other contacts of it may count before or behind, now. */
static void press_circle(const struct step *step, const struct group *place, int entry,
                         bool is_alone)
{
    struct facet_work *work = step->facets->work;
    if (is_alone) {
        add_passing(step, (int)(place - work->groups), entry);
        return;
    }
    if (work->batch.n > 0 && work->batch.sphere[work->batch.n - 1] == place->sphere)
        empty_batch(step);
    press_passing(step);
    add_passing(step, (int)(place - work->groups), entry);
    press_passing(step);
}

/* What a ball covers of a body that deforms. */
static void gather_patch(const struct step *step, const struct group *place, bool may_be_circle)
{
    struct facet_patch *patch = &step->facets->work->patch;
    struct facet_contact *group = &step->facets->list[place->begin];
    const struct vec3 centre = sphere_place(step->spheres, place->sphere);
    const double radius = sphere_radius(step->spheres, place->sphere);
    facet_patch_search(patch, group, &step->facets->work->near[place->begin], place->n_near,
                       &step->bodies->list[group->body], centre, radius);
    if (patch->through > step->facets->through_max * radius)
        step->facets->through_max = patch->through / radius;
    CHECK(may_be_circle || !patch->is_circle, "face %d: a kernel does not see a circle",
          group[patch->parts->entry].feature);
    if (patch->is_circle && !step->spheres->periodic.any)
        press_circle(step, place, place->begin + patch->parts->entry,
                     place->is_alone && patch->n_ended == 0);
    else
        for (int p = 0; p < patch->n_parts; p++)
            add_part(step, place->begin, &patch->parts[p]);
    for (int e = 0; e < patch->n_ended; e++)
        end_part(step, place->begin + patch->ended[e]);
}

/* Of the entries of a group, begin to end of the surveyed, one may be a circle and all others
 * nothing. */
static void decide(const struct step *step, int begin, int end)
{
    struct facet_work *work = step->facets->work;
    const struct facet_kernel_circles *surveyed = &work->surveyed;
    const int g = surveyed->list[begin].group;
    int found = begin, n = 0;
    for (int k = begin; k < end; k++)
        if (surveyed->kind[k] != FACET_KERNEL_NOTHING) {
            found = k;
            n++;
        }
    if (surveyed->kind[found] == FACET_KERNEL_GONE) /* then all are */
        look_again(step, g);
    if (n == 1 && surveyed->kind[found] == FACET_KERNEL_CIRCLE)
        add_passing(step, g, (int)(surveyed->list[found].contact - step->facets->list));
    else if (n > 0)
        gather_patch(step, &work->groups[g], true);
}

static void decide_surveyed(const struct step *step)
{
    struct facet_kernel_circles *surveyed = &step->facets->work->surveyed;
    surveyed->travelled = step->facets->work->travelled;
    facet_circles_renew_means(surveyed);
    step->kernel.kinds(step->kernel_work, surveyed);
    for (int k = 0, end; k < surveyed->n; k = end) {
        for (end = k + 1;
             end < surveyed->n && surveyed->list[end].group == surveyed->list[k].group; end++)
            continue;
        decide(step, k, end);
    }
}

/* The contacts of one sphere with one body. */
static void gather_group(const struct step *step, struct group *place)
{
    const int begin = place->begin;
    struct facet_contact *group = &step->facets->list[begin];
    struct facet_local *local = &step->facets->work->local;
    const struct body *body = &step->bodies->list[group->body];
    const struct mesh *mesh = &body->mesh;
    const struct vec3 centre = sphere_place(step->spheres, group->sphere);
    const double radius = sphere_radius(step->spheres, group->sphere);
    if (body->skin != NULL) {
        gather_patch(step, place, true);
        return;
    }
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
    } else if (facet_contact_touched(contact)) {
        at = contact_geometry_closest(mesh, contact->feature, centre);
        add_contact(step, entry, &at, 0.0);
    }
}

/* Lists are longer than caches: what comes soon is asked for before. */
static void fetch_group(const struct step *step, const struct group *group)
{
    enum { LINE = 64 };
    const struct facet_work *work = step->facets->work;
    const int entry = group->begin + (group->n_near > 0 ? work->near[group->begin] : 0);
    const char *contact = (const char *)&step->facets->list[entry];
    for (size_t at = 0; at < sizeof(struct facet_contact); at += LINE)
        __builtin_prefetch(contact + at, 1);
    __builtin_prefetch(&step->spheres->motion[group->sphere]);
}

void facet_contacts_apply(struct facet_contacts *facets, struct spheres *spheres,
                          const struct bodies *bodies, const struct materials *materials,
                          double dt, bool ledger)
{
    struct facet_work *work = facets->work;
    struct facet_kernel_work kernel_work = {
        .motion = spheres->motion,
        .spin = spheres->spin,
        .force = spheres->force,
        .material = spheres->material,
        .n_materials = materials->n,
        .pairs = materials->pairs,
        .width = facets->width,
        .dummy = &work->dummy,
        .dt = dt,
    };
    const struct step step = {facets, spheres, bodies,
                              facet_kernel_choose(work->isa, materials->full, ledger),
                              &kernel_work};
    if (!work->has_groups)
        list_groups(facets, spheres, bodies);
    count_travel(&step);
    facets->through_max = 0.0;
    for (int r = 0; r < work->n_runs; r++)
        apply_run(&step, &work->runs[r]);
    examine_due(&step);
    press_standing(&step);
    list_busy(&step);
    for (int k = 0; k < work->n_busy; k++) {
        struct group *group = &work->groups[work->busy[k]];
        if (k + AHEAD < work->n_busy)
            fetch_group(&step, &work->groups[work->busy[k + AHEAD]]);
        const struct body *body = &bodies->list[facets->list[group->begin].body];
        if (!body->exists)
            end_group(&step, group->begin, group->end);
        else if (group->end == group->begin + 1 && body->skin == NULL)
            gather_one(&step, group->begin);
        else
            gather_group(&step, group);
    }
    decide_surveyed(&step);
    press_passing(&step);
    empty_batch(&step);
    facets->overlap_max = kernel_work.overlap_max > facets->through_max
                              ? kernel_work.overlap_max
                              : facets->through_max;
    merge_all_loads(facets);
}

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
                sum, width_of(facets, contact->sphere) *
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
        exact_sum_add(normal, width_of(facets, i) *
                                  contact_law_normal_energy(
                                      contact->overlap, sphere_curvature(spheres, i), pair));
        exact_sum_add(springs, contact_law_spring_energy(pair, contact->history));
    }
}
