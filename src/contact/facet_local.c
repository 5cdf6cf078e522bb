/* Which features of a body a sphere touches: see facet_local.h. */
#include "contact/facet_local.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"

/* Normals this near to each other (cosine of 15 deg) are the same contact's. */
static const double SAME_NORMAL = 0.9659258262890683;
/* A standing contact counts as this much deeper, so that two do not take turns. */
static const double HOLDS_ON = 1.01;
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

static bool holds_history(const struct facet_contact *contact)
{
    return contact->history[CONTACT_RADIUS_LANE] > 0.0;
}

static void find_touches(struct facet_local *local, const struct facet_contact *group, int n,
                         const struct mesh *mesh, struct vec3 centre, double radius)
{
    local->n_touches = local->n_ended = 0;
    for (int k = 0; k < n; k++) {
        struct facet_local_touch *touch = &local->touches[local->n_touches];
        if (contact_geometry_touches(mesh, group[k].feature, centre, radius, &touch->at)) {
            const double overlap = radius - touch->at.distance;
            touch->entry = k;
            touch->claim = holds_history(&group[k]) ? HOLDS_ON * overlap : overlap;
            touch->settled = touch->stands = false;
            local->n_touches++;
        } else if (holds_history(&group[k])) {
            local->ended[local->n_ended++] = k;
        }
    }
}

/* Is `other` the same contact as the one that stands: nearly the same normal, or nothing of it
 * rises above the plane that the standing one touches? */
static bool is_same_contact(const struct facet_local_touch *standing,
                            const struct facet_local_touch *other, double radius)
{
    const struct vec3 apart = vec3_sub(other->at.point, standing->at.point);
    return vec3_dot(standing->at.normal, other->at.normal) > SAME_NORMAL ||
           vec3_dot(standing->at.normal, apart) <= IN_PLANE * radius;
}

static struct facet_local_touch *deepest_unsettled(const struct facet_local *local)
{
    struct facet_local_touch *deepest = NULL;
    for (int t = 0; t < local->n_touches; t++) {
        struct facet_local_touch *touch = &local->touches[t];
        if (!touch->settled && (deepest == NULL || touch->claim > deepest->claim))
            deepest = touch;
    }
    return deepest;
}

/* The deepest stands and silences its like, then the deepest of the rest. */
static void choose_standing(struct facet_local *local, const struct facet_contact *group,
                            double radius)
{
    struct facet_local_touch *deepest;
    while ((deepest = deepest_unsettled(local)) != NULL) {
        deepest->settled = deepest->stands = true;
        for (int t = 0; t < local->n_touches; t++) {
            struct facet_local_touch *other = &local->touches[t];
            if (!other->settled && is_same_contact(deepest, other, radius))
                other->settled = true;
        }
    }
    for (int t = 0; t < local->n_touches; t++) {
        const struct facet_local_touch *touch = &local->touches[t];
        if (!touch->stands && holds_history(&group[touch->entry]))
            local->ended[local->n_ended++] = touch->entry;
    }
}

/* Which new contact, if any, goes on where one with this normal has ended. */
static const struct facet_local_touch *heir_of(const struct facet_local *local,
                                               const struct facet_contact *group,
                                               struct vec3 normal)
{
    const struct facet_local_touch *heir = NULL;
    double nearest = SAME_NORMAL;
    for (int t = 0; t < local->n_touches; t++) {
        const struct facet_local_touch *touch = &local->touches[t];
        const double turn = vec3_dot(normal, touch->at.normal);
        if (touch->stands && turn > nearest && !holds_history(&group[touch->entry])) {
            heir = touch;
            nearest = turn;
        }
    }
    return heir;
}

/* Moves a history; its force is turned into the new tangent plane, its size kept. */
static void move_history(double *from, double *to, struct vec3 normal)
{
    const struct vec3 force = {from[0], from[1], from[2]};
    const struct vec3 flat = vec3_axpy(force, -vec3_dot(force, normal), normal);
    const double size = vec3_norm(force), flat_size = vec3_norm(flat);
    const double scale = flat_size > 0.0 ? size / flat_size : 0.0;
    memcpy(to, from, CONTACT_LANES * sizeof *to);
    to[0] = scale * flat.x;
    to[1] = scale * flat.y;
    to[2] = scale * flat.z;
    memset(from, 0, CONTACT_LANES * sizeof *from);
}

static void hand_over(struct facet_local *local, struct facet_contact *group,
                      const struct mesh *mesh, struct vec3 centre)
{
    int n_left = 0;
    for (int e = 0; e < local->n_ended; e++) {
        struct facet_contact *old = &group[local->ended[e]];
        const struct contact_geometry was =
            contact_geometry_closest(mesh, old->feature, centre);
        const struct facet_local_touch *heir = heir_of(local, group, was.normal);
        if (heir != NULL)
            move_history(old->history, group[heir->entry].history, heir->at.normal);
        else
            local->ended[n_left++] = local->ended[e];
    }
    local->n_ended = n_left;
}

void facet_local_search(struct facet_local *local, struct facet_contact *group, int n,
                        const struct mesh *mesh, struct vec3 centre, double radius)
{
    reserve(local, n);
    find_touches(local, group, n, mesh, centre, radius);
    if (local->n_touches > 1)
        choose_standing(local, group, radius);
    else if (local->n_touches == 1)
        local->touches[0].stands = true;
    if (local->n_ended > 0 && local->n_touches > 0)
        hand_over(local, group, mesh, centre);
}
