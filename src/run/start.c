/* See start.h.  All spheres stand in one crowd, with their images over periodic boundaries, and
 * each asks it once. */
#include "run/start.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "model/body.h"
#include "model/crowd.h"
#include "model/packings.h"
#include "model/periodic.h"
#include "model/region.h"

/* Whose sphere it is: of the state before (group -1) or of a group, from 0. */
struct owner {
    int group;
    int64_t k;
};

struct scene {
    const struct job *job;
    const struct packings *packings;
    const struct packing *before;
    struct periodic periodic;
    double radius; /* the greatest [m] */
    struct crowd crowd;
    int n, capacity;
    struct owner *owners; /* of what stands in the crowd; an image's k is -1 */
};

static const struct packing *packing_of(const struct scene *scene, int group)
{
    return group < 0 ? scene->before : &scene->packings->groups[group];
}

static const char *name_of(const struct scene *scene, struct owner owner)
{
    return owner.group < 0 ? "start" : scene->job->spheres[owner.group].name;
}

/* Lists "spheres 'heap': sphere 3 at (0, 1, 2) m" and what is wrong with it; counted from 1, as
 * the rows of a file. */
static void complain(const struct scene *scene, struct owner owner, struct mistakes *mistakes,
                     const char *what)
{
    const struct job *job = scene->job;
    const struct vec3 x = packing_get(packing_of(scene, owner.group), owner.k).position;
    struct job_place place = {0, 0};
    if (owner.group >= 0)
        place = job->spheres[owner.group].place;
    mistakes_add(mistakes, job->path, place.line, place.column,
                 "spheres '%s': sphere %lld at (%.6g, %.6g, %.6g) m %s", name_of(scene, owner),
                 (long long)owner.k + 1, x.x, x.y, x.z, what);
}

/* ------------------------------------------------------------------------------- others */

static void enter_group(struct scene *scene, int group)
{
    const struct packing *packing = packing_of(scene, group);
    for (int64_t k = 0; k < packing->n; k++) {
        const struct packing_sphere sphere = packing_get(packing, k);
        crowd_add_repeated(&scene->crowd, &scene->periodic,
                           periodic_settled(&scene->periodic, sphere.position), sphere.radius,
                           sphere.radius + scene->radius);
        ARRAY_GROW(scene->owners, scene->crowd.n, scene->capacity);
        for (bool image = false; scene->n < scene->crowd.n; image = true)
            scene->owners[scene->n++] = (struct owner){group, image ? -1 : k};
    }
}

/* The sphere that an entry of the crowd is, or is an image of. */
static struct owner owner_of(const struct scene *scene, int entry)
{
    while (scene->owners[entry].k < 0)
        entry--;
    return scene->owners[entry];
}

static void check_others(const struct scene *scene, int group, struct mistakes *mistakes)
{
    const double limit = scene->job->watch.overlap;
    int n = 0, first = -1, partner = -1;
    for (int s = 0; s < scene->n; s++) {
        if (scene->owners[s].group != group || scene->owners[s].k < 0)
            continue;
        const int other = crowd_overlapping(&scene->crowd, s, limit);
        if (other < 0 || (group < 0 && scene->owners[other].group < 0))
            continue;
        first = n == 0 ? s : first;
        partner = n++ == 0 ? other : partner;
    }
    if (n == 0)
        return;
    const struct owner other = owner_of(scene, partner);
    char *what = array_format(
        "overlaps sphere %lld of '%s' by %.3g of a radius, more than watch.overlap = %.3g, the "
        "first of %d that do; places farther apart are expected",
        (long long)other.k + 1, name_of(scene, other),
        crowd_overlap(&scene->crowd, first, partner), limit, n);
    complain(scene, scene->owners[first], mistakes, what);
    free(what);
}

/* ------------------------------------------------------------------------------- bodies */

/* Distance from a surface that is known to be nearer than this. */
static double distance_to(const struct region_surface *surface, struct vec3 x, double near)
{
    double from = 0.0;
    for (int k = 0; k < 40; k++) {
        const double middle = 0.5 * (from + near);
        if (region_surface_is_near(surface, x, middle))
            near = middle;
        else
            from = middle;
    }
    return near;
}

/* "body 'bin'"; of a drawing also its file and its width, of a sheet that is thick beside its
 * size its thickness: these may be in other units.  The caller frees it. */
static char *name_body(const struct job_body *asked, const struct body *body)
{
    static const double LIKELY = 0.1; /* thickness of a sheet, of the body's size */
    const struct mesh_survey survey = mesh_survey(&body->mesh);
    const struct vec3 size = vec3_sub(survey.high, survey.low);
    const double thickness =
        job_deforms(asked) && asked->model != JOB_MODEL_SOLID ? asked->sheet.thickness : 0.0;
    if (thickness > LIKELY * vec3_norm(size))
        return array_format("body '%s', %.3g m thick (is the unit of its thickness right?),",
                            body->name, thickness);
    if (asked->file == NULL)
        return array_format("body '%s'", body->name);
    const double wide = size.x > size.y ? size.x : size.y;
    const char *slash = strrchr(asked->file, '/');
    return array_format("body '%s', %s, %.3g m wide,", body->name,
                        slash != NULL ? slash + 1 : asked->file, size.z > wide ? size.z : wide);
}

/* Spheres of a group that overlap a body's surface or, if `inside`, are in it clear of that;
 * returns how many, and the first. */
static int64_t find_spheres(const struct scene *scene, int group,
                            const struct region_surface *surface, bool inside, int64_t *first)
{
    const double limit = scene->job->watch.overlap;
    const struct packing *packing = packing_of(scene, group);
    int64_t n = 0;
    for (int64_t k = 0; k < packing->n; k++) {
        const struct packing_sphere sphere = packing_get(packing, k);
        const struct vec3 x = periodic_settled(&scene->periodic, sphere.position);
        if (inside && !region_surface_holds(surface, x))
            continue;
        if (region_surface_is_near(surface, x, sphere.radius * (1.0 - limit)) == inside)
            continue;
        *first = n++ == 0 ? k : *first;
    }
    return n;
}

static void check_body(const struct scene *scene, int group, int b, const struct body *body,
                       const struct region_surface *surface, struct mistakes *mistakes)
{
    const double limit = scene->job->watch.overlap;
    int64_t first = -1;
    const int64_t n = find_spheres(scene, group, surface, false, &first);
    if (n == 0)
        return;
    const struct packing_sphere sphere = packing_get(packing_of(scene, group), first);
    const struct vec3 x = periodic_settled(&scene->periodic, sphere.position);
    const double distance = distance_to(surface, x, sphere.radius);
    char *name = name_body(&scene->job->bodies[b], body);
    char *what = array_format(
        "overlaps %s by %.3g of a radius, more than watch.overlap = %.3g, the first of %lld "
        "that do; places clear of bodies are expected",
        name, 1.0 - distance / sphere.radius, limit, (long long)n);
    free(name);
    complain(scene, (struct owner){group, first}, mistakes, what);
    free(what);
}

/* Spheres in a body of elements, clear of its surface: nothing would tell them out of it. */
static void check_inside(const struct scene *scene, int group, const struct body *body,
                         const struct region_surface *surface, struct mistakes *mistakes)
{
    int64_t first = -1;
    const int64_t n = find_spheres(scene, group, surface, true, &first);
    if (n == 0)
        return;
    char *what =
        array_format("is inside body '%s', which is solid, the first of %lld that are; "
                     "places outside are expected",
                     body->name, (long long)n);
    complain(scene, (struct owner){group, first}, mistakes, what);
    free(what);
}

static void check_bodies(const struct scene *scene, const struct bodies *bodies,
                         struct mistakes *mistakes)
{
    for (int b = 0; b < bodies->n; b++) {
        const struct body *body = &bodies->list[b];
        if (body->comes_and_goes && body->active[0] > 0.0)
            continue;
        struct region_surface *surface =
            region_surface_build(&body->mesh, body->mesh.reference);
        for (int g = 0; g < scene->packings->n; g++)
            check_body(scene, g, b, body, surface, mistakes);
        const bool is_solid = scene->job->bodies[b].model == JOB_MODEL_SOLID;
        for (int g = 0; is_solid && g < scene->packings->n; g++)
            check_inside(scene, g, body, surface, mistakes);
        region_surface_destroy(surface);
    }
}

/* ------------------------------------------------------------------------------- domain */

static bool is_inside(const struct job *job, struct vec3 x)
{
    const struct vec3 low = job->domain.min, high = job->domain.max;
    return ((x.x >= low.x && x.x <= high.x) || (job->domain.periodic & JOB_DIRECTION_X) != 0) &&
           ((x.y >= low.y && x.y <= high.y) || (job->domain.periodic & JOB_DIRECTION_Y) != 0) &&
           ((x.z >= low.z && x.z <= high.z) || (job->domain.periodic & JOB_DIRECTION_Z) != 0);
}

static void check_domain(const struct scene *scene, int group, struct mistakes *mistakes)
{
    const struct packing *packing = packing_of(scene, group);
    int64_t n = 0, first = -1;
    for (int64_t k = 0; k < packing->n; k++)
        if (!is_inside(scene->job, packing_get(packing, k).position))
            first = n++ == 0 ? k : first;
    if (n == 0)
        return;
    char *what = array_format(
        "is outside the domain, the first of %lld that are; places within domain.min and "
        "domain.max, or domain.leavers remove or ignore, are expected",
        (long long)n);
    complain(scene, (struct owner){group, first}, mistakes, what);
    free(what);
}

/* ------------------------------------------------------------------------------- all */

static void look(struct scene *scene, const struct bodies *bodies, struct mistakes *mistakes)
{
    crowd_init(&scene->crowd, scene->radius);
    for (int g = -1; g < scene->packings->n; g++)
        enter_group(scene, g);
    for (int g = -1; g < scene->packings->n; g++) {
        check_others(scene, g, mistakes);
        if (scene->job->domain.leavers == JOB_LEAVERS_STOP)
            check_domain(scene, g, mistakes);
    }
    check_bodies(scene, bodies, mistakes);
    crowd_clear(&scene->crowd);
    free(scene->owners);
}

void start_check(const struct job *job, const struct bodies *bodies,
                 const struct packings *packings, const struct packing *before,
                 struct mistakes *mistakes)
{
    struct scene scene = {.job = job, .packings = packings, .before = before};
    int64_t n = 0;
    periodic_init(&scene.periodic, job);
    for (int g = -1; g < packings->n; g++) {
        const double radius = packing_greatest(packing_of(&scene, g));
        scene.radius = radius > scene.radius ? radius : scene.radius;
        n += packing_of(&scene, g)->n;
    }
    if (n > 0 && n <= START_SPHERES_MOST)
        look(&scene, bodies, mistakes);
}
