/* See facet_step.h. */
#include "contact/facet_step.h"

#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "contact/facet_groups.h"
#include "contact/facet_work.h"
#include "model/body.h"
#include "model/material.h"
#include "model/rigid.h"
#include "model/sphere.h"
#include "physics/contact_geometry.h"
#include "physics/contact_law.h"

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
static void push_skin(const struct facet_work_step *step, int k)
{
    const struct facet_work *work = step->facets->work;
    const struct body_skin *skin = step->bodies->list[work->batch.contact[k]->body].skin;
    const struct facet_work_pushed *pushed = &work->pushed[k];
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

static void empty_batch(const struct facet_work_step *step)
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

static void apply_run(const struct facet_work_step *step, const struct facet_kernel_run *run)
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

/* Puts a contact into the batch, of a body that does not move; returns where. */
static int add_resting(const struct facet_work_step *step, int entry,
                       const struct contact_geometry *at, double overlap)
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
    batch->width[k] = facet_work_width(step->facets, contact->sphere);
    step->facets->work->pushed[k] = (struct facet_work_pushed){0};
    return k;
}

/* Puts a contact into the batch; one that ends has no overlap, and what its spring still held
 * is counted as lost. */
static void add_contact(const struct facet_work_step *step, int entry,
                        const struct contact_geometry *at, double overlap)
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
static void move_with_skin(const struct facet_work_step *step, const struct body_skin *skin,
                           int k)
{
    struct facet_work *work = step->facets->work;
    const struct facet_work_pushed *pushed = &work->pushed[k];
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
static void add_part(const struct facet_work_step *step, int begin,
                     const struct facet_patch_part *part)
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
    work->pushed[k] = (struct facet_work_pushed){.pressure = pressure,
                                                 .elastic = vec3_scale(-pressure, part->facing),
                                                 .holds_energy = part == patch->parts};
    keep_corners(work, k, patch, part);
    move_with_skin(step, step->bodies->list[contact->body].skin, k);
}

/* A contact that has ended, as seen from the face that it was on last. */
static void end_part(const struct facet_work_step *step, int entry)
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
static void end_group(const struct facet_work_step *step, int begin, int end)
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

/* ---- Circles
 * ---------------------------------------------------------------------------------- */

/* For this step alone. */
static void add_passing(const struct facet_work_step *step, int g, int entry)
{
    (void)facet_groups_add_circle(step, &step->facets->work->passing, g, entry,
                                  (double)INFINITY);
}

static void press_circles(const struct facet_work_step *step,
                          struct facet_kernel_circles *circles)
{
    make_room(step->facets, circles->n);
    circles->travelled = step->facets->work->travelled;
    facet_circles_renew_means(circles);
    step->kernel.circles(step->kernel_work, circles);
}

static void press_passing(const struct facet_work_step *step)
{
    struct facet_kernel_circles *passing = &step->facets->work->passing;
    press_circles(step, passing);
    for (int k = 0; k < passing->n; k++)
        CHECK(passing->kind[k] == FACET_KERNEL_CIRCLE, "sphere %d is before no circle",
              passing->list[k].sphere);
    passing->n = 0;
}

/* A circle of a sphere for which other contacts may count before or behind. */
static void press_circle(const struct facet_work_step *step, int g, int entry)
{
    const struct facet_kernel_batch *batch = &step->facets->work->batch;
    if (batch->n > 0 && batch->sphere[batch->n - 1] == step->facets->list[entry].sphere)
        empty_batch(step);
    press_passing(step);
    add_passing(step, g, entry);
    press_passing(step);
}

/* What a ball covers of a body that deforms. */
static void gather_patch(const struct facet_work_step *step,
                         const struct facet_work_group *place, bool may_be_circle)
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
    const bool is_circle = patch->is_circle && !step->spheres->periodic.any;
    const int g = (int)(place - step->facets->work->groups);
    if (is_circle && place->is_alone && patch->n_ended == 0)
        add_passing(step, g, place->begin + patch->parts->entry);
    else if (is_circle)
        press_circle(step, g, place->begin + patch->parts->entry);
    for (int p = 0; p < patch->n_parts && !is_circle; p++)
        add_part(step, place->begin, &patch->parts[p]);
    for (int e = 0; e < patch->n_ended; e++)
        end_part(step, place->begin + patch->ended[e]);
}

/* All that may be circles as long as nothing has gone far.  What else balls cover, and those
 * that have gone, are looked at one by one: those from the last on, whose place others take. */
static void press_standing(const struct facet_work_step *step)
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
        facet_groups_look_again(step, g);
        if (work->groups[g].circle >= 0)
            gather_patch(step, &work->groups[g], true);
    }
}

/* Of the entries of a group, begin to end of the surveyed, one may be a circle and all others
 * nothing. */
static void decide(const struct facet_work_step *step, int begin, int end)
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
        facet_groups_look_again(step, g);
    if (n == 1 && surveyed->kind[found] == FACET_KERNEL_CIRCLE)
        add_passing(step, g, (int)(surveyed->list[found].contact - step->facets->list));
    else if (n > 0)
        gather_patch(step, &work->groups[g], true);
}

static void decide_surveyed(const struct facet_work_step *step)
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
static void gather_group(const struct facet_work_step *step, struct facet_work_group *place)
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
static void gather_one(const struct facet_work_step *step, int entry)
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

enum { AHEAD = 6 }; /* groups */

/* Lists are longer than caches: what comes soon is asked for before. */
static void fetch_group(const struct facet_work_step *step,
                        const struct facet_work_group *group)
{
    enum { LINE = 64 };
    const struct facet_work *work = step->facets->work;
    const int entry = group->begin + (group->n_near > 0 ? work->near[group->begin] : 0);
    const char *contact = (const char *)&step->facets->list[entry];
    for (size_t at = 0; at < sizeof(struct facet_contact); at += LINE)
        __builtin_prefetch(contact + at, 1);
    __builtin_prefetch(&step->spheres->motion[group->sphere]);
}

void facet_step_apply(struct facet_contacts *facets, struct spheres *spheres,
                      const struct bodies *bodies, const struct materials *materials, double dt,
                      bool ledger)
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
    const struct facet_work_step step = {
        facets, spheres, bodies, facet_kernel_choose(work->isa, materials->full, ledger),
        &kernel_work};
    if (!work->has_groups)
        facet_groups_list(facets, spheres, bodies);
    facets->through_max = 0.0;
    for (int r = 0; r < work->n_runs; r++)
        apply_run(&step, &work->runs[r]);
    facet_groups_examine(&step);
    press_standing(&step);
    facet_groups_survey(&step);
    for (int k = 0; k < work->n_busy; k++) {
        struct facet_work_group *group = &work->groups[work->busy[k]];
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
