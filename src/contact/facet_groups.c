/* See facet_groups.h. */
#include "contact/facet_groups.h"

#include <stdlib.h>

#include "base/array.h"
#include "contact/facet_work.h"
#include "model/body.h"
#include "model/sphere.h"
#include "physics/contact_geometry.h"

static struct vec3 vec3_of(const double *lane)
{
    return (struct vec3){lane[0], lane[1], lane[2]};
}

enum {
    LONG_GROUP = 6,     /* shorter ones are looked at as a whole */
    LONG_PATCH = 2,     /* of a body that deforms: to look at a face costs more */
    RUN_MOST = 1 << 16, /* contacts */
};
/* How far beyond touching counts as near: of the radius, and in steps of the present speed; and
 * how far where it should be few. */
static const double NEAR_RADII = 0.05, NEAR_STEPS = 8.0, CLOSE_RADII = 0.001,
                    CLOSE_STEPS = 40.0;
static const double SLACK_TAKEN = 0.9999; /* the rest is for rounding */

static void add_group(struct facet_work *work, int begin, int end, int sphere, bool is_alone)
{
    ARRAY_GROW(work->groups, work->n_groups + 1, work->group_capacity);
    work->groups[work->n_groups++] = (struct facet_work_group){.begin = begin,
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
        work->due[g] = (struct facet_work_due){-(double)INFINITY, -(double)INFINITY};
    work->n_busy = work->standing.n = work->surveyed.n = 0;
    work->busy_is_stale = false;
}

void facet_groups_list(struct facet_contacts *facets, const struct spheres *spheres,
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
static void find_near(const struct facet_work_step *step, const struct body *body, int n,
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
static void list_near(const struct facet_work_step *step, struct facet_work_group *group,
                      struct vec3 centre)
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

/* How far a ball that touches none of a body's near faces is from all of them at least [m];
 * less than nothing where it may touch. */
static double gap_of(const struct facet_work_step *step, const struct facet_work_group *group,
                     struct vec3 centre)
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
static void look_around(const struct facet_work_step *step, struct facet_work_group *group,
                        struct vec3 centre)
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
static double reach_of(const struct facet_work_group *group)
{
    return SLACK_TAKEN * group->slack + group->travelled;
}

/* Bodies are where they are in this step: no point of one has gone farther than this. */
static void count_travel(const struct facet_work_step *step)
{
    double most = 0.0;
    for (int b = 0; b < step->bodies->n; b++) {
        const struct body *body = &step->bodies->list[b];
        if (body->moves && body->speed_max > most)
            most = body->speed_max;
    }
    step->facets->work->travelled += 1.001 * most * step->kernel_work->dt;
}

static const struct body *body_of(const struct facet_work_step *step,
                                  const struct facet_work_group *group)
{
    return &step->bodies->list[step->facets->list[group->begin].body];
}

bool facet_groups_may_be_seen(const struct facet_work_step *step,
                              const struct facet_work_group *group)
{
    const struct body *body = body_of(step, group);
    return body->skin != NULL && group->is_alone && !body->comes_and_goes &&
           !step->spheres->periodic.any;
}

/* When a group is to be looked at again: half of what is left is the body's.  In the next step
 * if nobody says how far spheres go, or where they may come out on the other side. */
static struct facet_work_due due_of(const struct facet_work_step *step,
                                    const struct facet_work_group *group, double left)
{
    const double moved = step->facets->moved;
    const bool moves = body_of(step, group)->moves;
    const double own = (moves ? 0.499 : 0.999) * left;
    struct facet_work_due due = {(double)INFINITY, (double)INFINITY};
    if (group->n_near > 0 && facet_groups_may_be_seen(step, group)) /* the kernel sees to it */
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

int facet_groups_add_circle(const struct facet_work_step *step,
                            struct facet_kernel_circles *circles, int g, int entry,
                            double reach)
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

static void take_standing(struct facet_work *work, struct facet_work_group *group)
{
    struct facet_kernel_circles *standing = &work->standing;
    if (group->circle < 0)
        return;
    work->groups[standing->list[standing->n - 1].group].circle = group->circle;
    facet_circles_take(standing, group->circle);
    group->circle = -1;
}

/* A group's near entries have been found. */
static void sort_group(const struct facet_work_step *step, int g)
{
    struct facet_work *work = step->facets->work;
    struct facet_work_group *group = &work->groups[g];
    const bool stands = group->n_near == 1 && facet_groups_may_be_seen(step, group);
    const bool is_busy = !stands && (group->n_near > 0 || body_of(step, group)->comes_and_goes);
    take_standing(work, group);
    if (stands)
        group->circle = facet_groups_add_circle(
            step, &work->standing, g, group->begin + work->near[group->begin], reach_of(group));
    work->busy_is_stale = work->busy_is_stale || is_busy || work->is_busy[g];
    work->is_busy[g] = is_busy;
}

void facet_groups_look_again(const struct facet_work_step *step, int g)
{
    struct facet_work *work = step->facets->work;
    struct facet_work_group *group = &work->groups[g];
    look_around(step, group, sphere_place(step->spheres, group->sphere));
    sort_group(step, g);
    work->due[g] = due_of(step, group, group->slack);
}

/* Looks at a group that is due, if its sphere has gone so far. */
static void examine(const struct facet_work_step *step, int g)
{
    const struct facet_work_group *group = &step->facets->work->groups[g];
    const struct vec3 centre = sphere_place(step->spheres, group->sphere);
    const double travelled =
        body_of(step, group)->moves ? step->facets->work->travelled : group->travelled;
    const double left = reach_of(group) - travelled - vec3_norm(vec3_sub(centre, group->from));
    if (left > 0.0)
        step->facets->work->due[g] = due_of(step, group, left);
    else
        facet_groups_look_again(step, g);
}

void facet_groups_examine(const struct facet_work_step *step)
{
    const struct facet_work *work = step->facets->work;
    count_travel(step);
    const double moved = step->facets->moved, travelled = work->travelled;
    for (int g = 0; g < work->n_groups; g++)
        if (!(moved < work->due[g].moved && travelled < work->due[g].travelled))
            examine(step, g);
}

/* All near entries of a group of which nothing else is listed. */
static void survey_group(const struct facet_work_step *step, int g)
{
    struct facet_work *work = step->facets->work;
    const struct facet_work_group *group = &work->groups[g];
    for (int m = 0; m < group->n_near; m++)
        (void)facet_groups_add_circle(step, &work->surveyed, g,
                                      group->begin + work->near[group->begin + m],
                                      reach_of(group));
}

void facet_groups_survey(const struct facet_work_step *step)
{
    struct facet_work *work = step->facets->work;
    if (!work->busy_is_stale)
        return;
    work->busy_is_stale = false;
    work->n_busy = work->surveyed.n = 0;
    for (int g = 0; g < work->n_groups; g++) {
        if (!work->is_busy[g])
            continue;
        if (facet_groups_may_be_seen(step, &work->groups[g]))
            survey_group(step, g);
        else
            work->busy[work->n_busy++] = g;
    }
}
