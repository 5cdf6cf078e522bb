/* Which features of a body a sphere touches: see facet_local.h. */
#include "contact/facet_local.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"

/* Normals this near to each other (cosine of 15 deg) are the same contact's. */
static const double SAME_NORMAL = 0.9659258262890683;
/* Nor may normals differ by more than this (cosine of 60 deg) where patches overlap. */
static const double NOT_OPPOSITE = 0.5;
/* Two that stood are two until they are nearer than this part of where one becomes two. */
static const double HOLDS_APART = 0.9;
/* A standing contact counts as this much deeper, so that memory does not go to and fro. */
static const double HOLDS_ON = 1.01;
/* Normals turn while depths differ by less than this part of them. Less would make a seam
 * stiffer along the wall than the wall is across: by 1 / (3 BLEND) of the angle's square. */
static const double BLEND = 0.1;
/* Two normals this near (1 - cosine) are those of one place, held by two features. */
static const double SAME_PLACE = 1e-13;
/* Height over a tangent plane that counts as in it, in radii: rounding, and no more. */
static const double IN_PLANE = 1e-6;

void facet_local_clear(struct facet_local *local)
{
    free(local->touches);
    free(local->ended);
    *local = (struct facet_local){0};
}

static void reserve(struct facet_local *local, int n)
{
    if (n <= local->capacity)
        return;
    const size_t capacity = array_capacity((size_t)local->capacity, (size_t)n);
    facet_local_clear(local);
    local->touches = array_allocate(capacity, sizeof *local->touches);
    local->ended = array_allocate(capacity, sizeof *local->ended);
    local->capacity = (int)capacity;
}

static void find_touches(struct facet_local *local, const struct facet_contact *group,
                         const int *near, int n, const struct mesh *mesh, struct vec3 centre,
                         double radius)
{
    local->n_touches = local->n_ended = 0;
    for (int m = 0; m < n; m++) {
        const int k = near[m];
        struct facet_local_touch *touch = &local->touches[local->n_touches];
        if (contact_geometry_touches(mesh, group[k].feature, centre, radius, &touch->at)) {
            const double overlap = radius - touch->at.distance;
            touch->entry = k;
            touch->claim = facet_contact_touched(&group[k]) ? HOLDS_ON * overlap : overlap;
            touch->stands_in = -1;
            touch->acts_at = touch->at;
            local->n_touches++;
        } else if (facet_contact_touched(&group[k])) {
            local->ended[local->n_ended++] = k;
        }
    }
}

/* Are patches nearer than a part of the sum of their radii, sqrt(R overlap) each (1.4)? */
static bool patches_overlap(const struct contact_geometry *a, double overlap_a,
                            const struct contact_geometry *b, double overlap_b, double radius,
                            double part)
{
    const struct vec3 apart = vec3_sub(b->point, a->point);
    const double sum_squared =
        radius * (overlap_a + overlap_b + 2.0 * sqrt(overlap_a * overlap_b));
    return vec3_dot(a->normal, b->normal) > NOT_OPPOSITE &&
           vec3_dot(apart, apart) < part * part * sum_squared;
}

/* Settles `other` if it is the same contact as touch d, which stands: nearly the same normal,
 * overlapping patches, or nothing of it rises above the plane that d touches. */
static void silence(struct facet_local *local, const struct facet_contact *group, int d,
                    struct facet_local_touch *other, double radius)
{
    const struct facet_local_touch *deepest = &local->touches[d];
    const struct vec3 apart = vec3_sub(other->at.point, deepest->at.point);
    const bool stood_apart = facet_contact_touched(&group[deepest->entry]) &&
                             facet_contact_touched(&group[other->entry]);
    const bool is_hidden = vec3_dot(deepest->at.normal, apart) <= IN_PLANE * radius;
    const bool is_near =
        vec3_dot(deepest->at.normal, other->at.normal) > SAME_NORMAL ||
        patches_overlap(&deepest->at, radius - deepest->at.distance, &other->at,
                        radius - other->at.distance, radius, stood_apart ? HOLDS_APART : 1.0);
    if (is_hidden || is_near)
        other->stands_in = d;
    other->one_with = is_near;
}

static int deepest_unsettled(const struct facet_local *local)
{
    int deepest = -1;
    for (int t = 0; t < local->n_touches; t++) {
        const struct facet_local_touch *touch = &local->touches[t];
        if (touch->stands_in < 0 &&
            (deepest < 0 || touch->claim > local->touches[deepest].claim))
            deepest = t;
    }
    return deepest;
}

/* The deepest stands and silences its like, then the deepest of the rest. */
static void choose_standing(struct facet_local *local, const struct facet_contact *group,
                            double radius)
{
    int d;
    while ((d = deepest_unsettled(local)) >= 0) {
        local->touches[d].stands_in = d;
        local->touches[d].one_with = true;
        for (int t = 0; t < local->n_touches; t++)
            if (local->touches[t].stands_in < 0)
                silence(local, group, d, &local->touches[t], radius);
    }
    for (int t = 0; t < local->n_touches; t++) {
        const struct facet_local_touch *touch = &local->touches[t];
        if (!facet_local_stands(local, t) && facet_contact_touched(&group[touch->entry]))
            local->ended[local->n_ended++] = touch->entry;
    }
}

/* ---- Depth and normal of a contact that stands for several
 * ---------------------------------------- */

static int deepest_of(const struct facet_local *local, int standing)
{
    int deepest = standing;
    for (int t = 0; t < local->n_touches; t++) {
        const struct facet_local_touch *touch = &local->touches[t];
        if (touch->stands_in == standing && touch->one_with &&
            touch->at.distance < local->touches[deepest].at.distance)
            deepest = t;
    }
    return deepest;
}

/* How much the normal of `other` counts beside that of the deepest (2.2). */
static double weight_of(const struct contact_geometry *other,
                        const struct contact_geometry *deepest, double radius)
{
    const double gap = other->distance - deepest->distance;
    const double rise = (1.0 - vec3_dot(deepest->normal, other->normal)) * other->distance;
    const double depth = BLEND * (radius - deepest->distance);
    const double width = depth < rise ? depth : rise;
    return gap < width ? 1.0 - gap / width : 0.0;
}

/* Does an earlier touch of the same contact, or the deepest, lie at the same place as t? */
static bool is_counted(const struct facet_local *local, int deepest, int t)
{
    const struct facet_local_touch *touch = &local->touches[t];
    for (int s = 0; s < local->n_touches; s++) {
        const struct facet_local_touch *other = &local->touches[s];
        if ((s < t || s == deepest) && other->stands_in == touch->stands_in &&
            other->one_with && 1.0 - vec3_dot(other->at.normal, touch->at.normal) < SAME_PLACE)
            return true;
    }
    return false;
}

/* Where the contact of `standing` is, with all that it stands for. */
static struct contact_geometry blended(const struct facet_local *local, int standing,
                                       double radius)
{
    const int deepest = deepest_of(local, standing);
    struct contact_geometry at = local->touches[deepest].at;
    struct vec3 sum = at.normal;
    bool turned = false;
    for (int t = 0; t < local->n_touches; t++) {
        const struct facet_local_touch *touch = &local->touches[t];
        if (t == deepest || touch->stands_in != standing || !touch->one_with)
            continue;
        const double weight = weight_of(&touch->at, &local->touches[deepest].at, radius);
        if (!(weight > 0.0) || is_counted(local, deepest, t))
            continue;
        sum = vec3_axpy(sum, weight, touch->at.normal);
        turned = true;
    }
    if (!turned)
        return at;
    const struct vec3 centre = vec3_axpy(at.point, at.distance, at.normal);
    at.normal = vec3_scale(1.0 / vec3_norm(sum), sum);
    at.point = vec3_axpy(centre, -at.distance, at.normal);
    return at;
}

static void blend(struct facet_local *local, double radius)
{
    for (int t = 0; t < local->n_touches; t++)
        if (facet_local_stands(local, t))
            local->touches[t].acts_at = blended(local, t, radius);
}

/* ---- History
 * ---------------------------------------------------------------------------------- */

/* Which new contact, if any, goes on where one ended that acted there with this overlap. */
static const struct facet_local_touch *heir_of(const struct facet_local *local,
                                               const struct facet_contact *group,
                                               const struct contact_geometry *was,
                                               double overlap, double radius)
{
    const struct facet_local_touch *heir = NULL;
    double nearest = -1.0;
    for (int t = 0; t < local->n_touches; t++) {
        const struct facet_local_touch *touch = &local->touches[t];
        const double turn = vec3_dot(was->normal, touch->at.normal);
        if (!facet_local_stands(local, t) || !(turn > nearest) ||
            facet_contact_touched(&group[touch->entry]))
            continue;
        if (turn > SAME_NORMAL || patches_overlap(was, overlap, &touch->at,
                                                  radius - touch->at.distance, radius, 1.0)) {
            heir = touch;
            nearest = turn;
        }
    }
    return heir;
}

/* Turns a force into a tangent plane, its size kept. */
static void turn_force(double force[3], struct vec3 normal)
{
    const struct vec3 old = {force[0], force[1], force[2]};
    const struct vec3 flat = vec3_axpy(old, -vec3_dot(old, normal), normal);
    const double size = vec3_norm(old), flat_size = vec3_norm(flat);
    const double scale = flat_size > 0.0 ? size / flat_size : 0.0;
    force[0] = scale * flat.x;
    force[1] = scale * flat.y;
    force[2] = scale * flat.z;
}

/* Moves a history; its forces are turned with the normal. */
static void move_history(double *from, double *to, struct vec3 normal)
{
    memcpy(to, from, CONTACT_LANES * sizeof *to);
    memset(from, 0, CONTACT_LANES * sizeof *from);
    turn_force(to, normal);
    turn_force(to + CONTACT_ROLLING_LANE, normal);
}

/* Where the feature was touched last, as seen from the centre: from that image of it which is
 * nearest, as the sphere may have come in again on the other side. */
static struct contact_geometry closest_image(const struct mesh *mesh, int feature,
                                             const struct periodic *periodic,
                                             struct vec3 centre)
{
    struct contact_geometry nearest = contact_geometry_closest(mesh, feature, centre);
    double shifts[PERIODIC_IMAGES][3];
    const int n = periodic->any ? periodic_shifts(periodic, shifts) : 0;
    for (int s = 1; s < n; s++) {
        const struct vec3 shift = {shifts[s][0], shifts[s][1], shifts[s][2]};
        struct contact_geometry at =
            contact_geometry_closest(mesh, feature, vec3_add(centre, shift));
        at.point = vec3_sub(at.point, shift);
        nearest = at.distance < nearest.distance ? at : nearest;
    }
    return nearest;
}

static void hand_over(struct facet_local *local, struct facet_contact *group,
                      const struct mesh *mesh, const struct periodic *periodic,
                      struct vec3 centre, double radius)
{
    int n_left = 0;
    for (int e = 0; e < local->n_ended; e++) {
        struct facet_contact *old = &group[local->ended[e]];
        const struct contact_geometry was = closest_image(mesh, old->feature, periodic, centre);
        const double patch = old->history[CONTACT_RADIUS_LANE];
        const struct facet_local_touch *heir =
            heir_of(local, group, &was, patch * patch / radius, radius);
        if (heir != NULL)
            move_history(old->history, group[heir->entry].history, heir->acts_at.normal);
        else
            local->ended[n_left++] = local->ended[e];
    }
    local->n_ended = n_left;
}

void facet_local_search(struct facet_local *local, struct facet_contact *group, const int *near,
                        int n, const struct mesh *mesh, const struct periodic *periodic,
                        struct vec3 centre, double radius)
{
    reserve(local, n);
    find_touches(local, group, near, n, mesh, centre, radius);
    if (local->n_touches > 1) {
        choose_standing(local, group, radius);
        blend(local, radius);
    } else if (local->n_touches == 1) {
        local->touches[0].stands_in = 0;
    }
    if (local->n_ended > 0 && local->n_touches > 0)
        hand_over(local, group, mesh, periodic, centre, radius);
}
