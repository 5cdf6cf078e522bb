/* See check.h. */
#include "run/check.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "model/body.h"
#include "model/material.h"
#include "model/packings.h"
#include "model/region.h"
#include "model/rigid.h"
#include "physics/critical_step.h"
#include "run/advise.h"
#include "run/chain.h"
#include "run/inflow.h"
#include "run/limits.h"
#include "run/simulation.h"
#include "run/solid_step.h"
#include "run/solid_survey.h"
#include "run/start.h"
#include "run/step.h"
#include "run/survey.h"
#include "store/crc32.h"
#include "store/file.h"
#include "store/sphere_file.h"
#include "store/surface_file.h"

enum { ALL_PAIRS_MOST = 20000 }; /* 2e8 pairs */

/* A box around points. */
struct extent {
    struct vec3 low, high;
};

static struct extent extent_nothing(void)
{
    return (struct extent){{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
}

static void extent_add(struct extent *extent, struct vec3 x, double margin)
{
    const struct vec3 low = {x.x - margin, x.y - margin, x.z - margin};
    const struct vec3 high = {x.x + margin, x.y + margin, x.z + margin};
    extent->low.x = low.x < extent->low.x ? low.x : extent->low.x;
    extent->low.y = low.y < extent->low.y ? low.y : extent->low.y;
    extent->low.z = low.z < extent->low.z ? low.z : extent->low.z;
    extent->high.x = high.x > extent->high.x ? high.x : extent->high.x;
    extent->high.y = high.y > extent->high.y ? high.y : extent->high.y;
    extent->high.z = high.z > extent->high.z ? high.z : extent->high.z;
}

/* A group's spheres in short. */
struct group_summary {
    int64_t n;
    double mass, radius_least, radius_most; /* [kg], [m] */
    double speed;                           /* largest [m/s] */
    int material;                           /* -1: several */
    struct extent extent, centres;
};

static struct group_summary summarise(const struct job *job, const struct packing *packing)
{
    struct group_summary summary = {.n = packing->n,
                                    .radius_least = 1e300,
                                    .extent = extent_nothing(),
                                    .centres = extent_nothing()};
    for (int64_t k = 0; k < packing->n; k++) {
        const struct packing_sphere s = packing_get(packing, k);
        const double volume =
            4.0 / 3.0 * 3.14159265358979323846 * s.radius * s.radius * s.radius;
        summary.mass += volume * job->materials[s.material].density;
        summary.radius_least =
            s.radius < summary.radius_least ? s.radius : summary.radius_least;
        summary.radius_most = s.radius > summary.radius_most ? s.radius : summary.radius_most;
        extent_add(&summary.extent, s.position, s.radius);
        extent_add(&summary.centres, s.position, 0.0);
        const double speed = vec3_norm(s.velocity);
        summary.speed = speed > summary.speed ? speed : summary.speed;
        summary.material = k == 0 || s.material == summary.material ? s.material : -1;
    }
    return summary;
}

static void add_bodies(const struct bodies *bodies, struct extent *extent)
{
    for (int b = 0; b < bodies->n; b++) {
        for (int v = 0; v < bodies->list[b].mesh.n_vertices; v++)
            extent_add(extent, bodies->list[b].mesh.reference[v], 0.0);
    }
}

/* The domain where the job gives none: the scene, grown by its largest side. */
static void choose_domain(struct job *job, const struct extent *extent)
{
    if (job->domain.given)
        return;
    const struct vec3 size = vec3_sub(extent->high, extent->low);
    double margin = size.x > size.y ? size.x : size.y;
    margin = size.z > margin ? size.z : margin;
    const struct vec3 grow = {margin, margin, margin};
    job->domain.min = vec3_sub(extent->low, grow);
    job->domain.max = vec3_add(extent->high, grow);
    job->domain.given = true;
}

/* The highest speed that can be foreseen: of a sphere or a body at the start, or after a fall
 * [m/s]. */
static double foresee_speed(const struct job *job, const struct bodies *bodies,
                            double speed_at_start)
{
    const double fall = limits_fall_speed(job);
    double speed = speed_at_start > fall ? speed_at_start : fall;
    for (int b = 0; b < bodies->n; b++) {
        const struct body *body = &bodies->list[b];
        speed = body->speed_max > speed ? body->speed_max : speed;
        speed = body->surface_speed_max > speed ? body->surface_speed_max : speed;
        const double own = vec3_norm(job->bodies[b].solid.velocity); /* of one that deforms */
        speed = own > speed ? own : speed;
    }
    return speed;
}

/* What the spheres of a group allow. */
static void add_limits(struct limits *limits, const struct job *job,
                       const struct materials *materials, const struct packing *packing)
{
    if (packing->n == 0)
        return; /* a run that continues none has no group either */
    const bool alike = packing->rows == NULL && !packing->group->sizes.given;
    const int64_t n = alike ? 1 : packing->n;
    for (int64_t k = 0; k < n; k++) {
        const struct packing_sphere sphere = packing_get(packing, k);
        limits_add(limits, job, materials, &sphere);
    }
}

/* Ends and intervals that are whole numbers of steps. */
static void round_times(struct job *job)
{
    const double n_steps = (double)simulation_steps(job->time.end, job->time.step);
    job->time.end = (n_steps > 1.0 ? n_steps : 1.0) * job->time.step;
    double *const periods[] = {&job->output.series_every, &job->output.snapshots.every};
    for (size_t k = 0; k < sizeof periods / sizeof *periods; k++) {
        const double n = (double)simulation_steps(*periods[k], job->time.step);
        if (*periods[k] > 0.0)
            *periods[k] = (n > 1.0 ? n : 1.0) * job->time.step;
    }
}

/* Insertions bring some of all spheres. */
static void add_inflows(const struct job *job, struct limits_spheres *all)
{
    for (int k = 0; k < job->n_insertions; k++) {
        const struct inflow inflow = inflow_of(job, k);
        all->speed = inflow.speed > all->speed ? inflow.speed : all->speed;
        all->mass += inflow.mass;
    }
}

static void choose_times(struct job *job, const struct bodies *bodies,
                         const struct packings *packings, const struct packing *before,
                         struct limits_spheres *all)
{
    struct limits limits = limits_nothing(all);
    struct materials materials;
    materials_build(&materials, job);
    for (int g = 0; g < job->n_spheres; g++)
        add_limits(&limits, job, &materials, &packings->groups[g]);
    add_limits(&limits, job, &materials, before);
    for (int k = 0; k < job->n_insertions; k++)
        inflow_add_limits(&limits, job, &materials, k);
    if (limits.rayleigh < 1e299)
        job->time.step = limits_step(&limits, job->time.safety);
    const double solids = solid_step_auto(job, bodies, &materials, all);
    materials_clear(&materials);
    if (solids < 1e299 && (!(job->time.step > 0.0) || solids < job->time.step))
        job->time.step = critical_step_round_down(solids);
    round_times(job);
}

/* A surface says "file:line:column: what"; the place goes where places go. */
static void add_file_mistake(struct mistakes *mistakes, const char *file, const char *why)
{
    int line = 0, column = 0, begin = 0;
    const char *rest = why + strlen(file);
    if (sscanf(rest, ":%d:%d: %n", &line, &column, &begin) < 2)
        begin = 2; /* "file: what" */
    mistakes_add(mistakes, file, line, column, "%s", rest + begin);
}

/* Checksum of a file that has just been read; 0 when it has gone. */
static int64_t checksum(const char *path)
{
    struct crc32 crc;
    uint32_t sum = 0;
    char bytes[16384];
    FILE *file = fopen(path, "rb");
    crc32_init(&crc);
    for (size_t n; file != NULL && (n = fread(bytes, 1, sizeof bytes, file)) > 0;)
        sum = crc32_more(&crc, sum, bytes, n);
    if (file != NULL)
        fclose(file);
    return (int64_t)sum;
}

/* What only the bodies' surfaces can show. */
static void check_bodies(const struct job *job, const struct bodies *bodies,
                         struct mistakes *mistakes)
{
    for (int b = 0; b < bodies->n; b++) {
        const char *fault = rigid_fault(&job->bodies[b], &bodies->list[b].mesh);
        if (fault != NULL)
            mistakes_add(mistakes, job->path, 0, 0,
                         "bodies.%d.free.density: the surface of '%s' %s; a closed surface, or "
                         "mass, inertia and centre, are expected",
                         b, bodies->list[b].name, fault);
    }
    for (int r = 0; r < job->n_damping_regions; r++) {
        struct region region;
        char *why = NULL;
        if (region_build(&region, &job->damping_regions[r].region, bodies, &why))
            region_clear(&region);
        else
            mistakes_add(mistakes, job->path, 0, 0, "damping_regions.%d.region: %s", r, why);
        free(why);
    }
}

static void read_surfaces(struct job *job, struct mistakes *mistakes)
{
    for (int b = 0; b < job->n_bodies; b++) {
        struct job_body *body = &job->bodies[b];
        char *why = surface_file_has(body) ? surface_file_read(body) : NULL;
        if (why != NULL)
            add_file_mistake(mistakes, body->file, why);
        free(why);
    }
}

/* Two spheres must never touch twice, in one place and over the boundary; nor one itself. */
static void add_period_mistakes(struct mistakes *mistakes, const struct job *job, double radius)
{
    for (int i = 0; i < job->n_insertions; i++) {
        const double incoming = inflow_of(job, i).radius_most;
        radius = incoming > radius ? incoming : radius;
    }
    static const double DIAMETERS = 2.5; /* two, and what overlaps and motion take */
    const struct vec3 size = vec3_sub(job->domain.max, job->domain.min);
    const double sizes[3] = {size.x, size.y, size.z};
    for (int k = 0; k < 3; k++)
        if ((job->domain.periodic & 1 << k) && sizes[k] < DIAMETERS * 2.0 * radius)
            mistakes_add(mistakes, job->path, 0, 0,
                         "domain.periodic repeats every %.4g m along %c; at least %.1f of the "
                         "largest diameters, %.4g m, are expected",
                         sizes[k], "xyz"[k], DIAMETERS, DIAMETERS * 2.0 * radius);
}

/* Replaces the groups that come with the spheres of the start. */
static void name_groups(struct job *job, int n, const char *const *names)
{
    struct job_start_group *groups = array_allocate((size_t)n, sizeof *groups);
    for (int k = 0; k < n; k++)
        groups[k].name = array_string(names[k]);
    for (int k = 0; k < job->start.n_groups; k++)
        free(job->start.groups[k].name);
    free(job->start.groups);
    job->start.groups = groups;
    job->start.n_groups = n;
}

/* Takes over which checkpoint the run started from, as far as the job does not say. */
static void recall_start(struct job *job, const struct job *used)
{
    if (job->start.checkpoint == NULL && used->start.checkpoint != NULL)
        job->start.checkpoint = array_string(used->start.checkpoint);
    if (job->start.sum == 0)
        job->start.sum = used->start.sum;
}

static void recall_groups(struct job *job, const struct job *used)
{
    const int n = used->start.n_groups;
    const char **names = array_allocate((size_t)n, sizeof *names);
    for (int k = 0; k < n; k++)
        names[k] = used->start.groups[k].name;
    name_groups(job, n, names);
    free(names);
}

void check_recall(struct job *job, const struct job *used, bool has_state)
{
    if (!job->start.given || !used->start.given)
        return;
    if (has_state || job_same_file(job->start.from, used->start.from))
        recall_start(job, used);
    if (!has_state)
        return;
    job->start.recalled = true;
    recall_groups(job, used);
    if (!job->domain.given) {
        job->domain.given = true;
        job->domain.min = used->domain.min;
        job->domain.max = used->domain.max;
    }
    if (job->time.step == 0.0) {
        job->time.step = used->time.step;
        round_times(job);
    }
}

/* Is the checkpoint that the job names by its checksum there as it was?  Lists what is not. */
static bool is_start_there(const struct job *job, struct mistakes *mistakes)
{
    char *path = chain_checkpoint(job);
    const bool there = path != NULL, same = there && checksum(path) == job->start.sum;
    const char *name = job->start.checkpoint != NULL ? job->start.checkpoint : "it";
    if (!same)
        mistakes_add(mistakes, job->path, 0, 0,
                     "start.from: %s: %s %s since the run, which has no checkpoint of its "
                     "own yet, began; the same file as then is expected, or --fresh, which "
                     "begins from what is there now",
                     job->start.from, name, there ? "has changed" : "has gone");
    free(path);
    return same;
}

/* Notes which checkpoint it was: started again before it has one of its own, the run begins
 * from the same.  (A file named by `from` needs no name in a folder.) */
static void pin_start(struct job *job, const struct chain *before)
{
    if (job->start.checkpoint == NULL && strcmp(before->path, job->start.from) != 0)
        job->start.checkpoint = array_string(strrchr(before->path, '/') + 1);
    if (job->start.sum == 0)
        job->start.sum = checksum(before->path);
    name_groups(job, before->n_names, before->names);
}

/* Opens what the job starts from, unless the run that is resumed needs it no more. */
static void open_start(struct job *job, struct chain *before, struct mistakes *mistakes)
{
    if (!job->start.given || job->start.recalled)
        return;
    if (job->start.sum != 0 && !is_start_there(job, mistakes))
        return;
    if (chain_open(before, job, mistakes))
        pin_start(job, before);
}

bool check_complete(struct job *job, int n_ranks, struct mistakes *mistakes)
{
    struct extent scene = extent_nothing();
    const int *grid = job->decomposition.fixed;
    int64_t n_spheres = 0;
    double largest = 0.0; /* radius [m] */
    struct limits_spheres all;
    struct packings packings = {0, NULL};
    struct bodies bodies = {.n = 0};
    struct chain before = {.path = NULL};
    limits_spheres_init(&all, job);
    read_surfaces(job, mistakes);
    if (mistakes->n == 0)
        solid_survey_check(job, mistakes);
    if (mistakes->n == 0) {
        bodies_build(&bodies, job);
        open_start(job, &before, mistakes);
        packings_open(&packings, job, &bodies, &before.packing, sphere_file_read, mistakes);
    }
    for (int g = -1; g < packings.n; g++) {
        const struct packing *packing = g < 0 ? &before.packing : &packings.groups[g];
        const struct group_summary summary = summarise(job, packing);
        if (packing->n == 0)
            continue;
        extent_add(&scene, summary.extent.low, 0.0);
        extent_add(&scene, summary.extent.high, 0.0);
        n_spheres += packing->n;
        all.speed = summary.speed > all.speed ? summary.speed : all.speed;
        all.mass += summary.mass;
        largest = summary.radius_most > largest ? summary.radius_most : largest;
        if (g >= 0 && job->spheres[g].file != NULL)
            job->spheres[g].sum = checksum(job->spheres[g].file);
    }
    if (n_spheres > INT64_C(2000000000))
        mistakes_add(mistakes, job->path, 0, 0, "%lld spheres; at most 2e9 are expected",
                     (long long)n_spheres);
    if (job->force.search == JOB_SEARCH_ALL_PAIRS && n_spheres > ALL_PAIRS_MOST)
        mistakes_add(mistakes, job->path, 0, 0,
                     "testing.search is all-pairs for %lld spheres; at most %d are expected",
                     (long long)n_spheres, ALL_PAIRS_MOST);
    if (grid[0] > 0 && grid[0] * grid[1] * grid[2] != n_ranks)
        mistakes_add(
            mistakes, job->path, 0, 0,
            "decomposition.grid is %d x %d x %d on %d ranks; a product equal to the ranks is "
            "expected",
            grid[0], grid[1], grid[2], n_ranks);
    add_period_mistakes(mistakes, job, largest);
    if (mistakes->n == 0) {
        survey_check(job, &bodies, mistakes);
        check_bodies(job, &bodies, mistakes);
        add_bodies(&bodies, &scene);
        inflow_check(job, &bodies, &scene.low, &scene.high, mistakes);
        choose_domain(job, &scene);
        start_check(job, &bodies, &packings, &before.packing, mistakes);
        add_inflows(job, &all);
        all.speed = foresee_speed(job, &bodies, all.speed);
        if (job->time.step == 0.0)
            choose_times(job, &bodies, &packings, &before.packing, &all);
        if (mistakes->n == 0)
            inflow_check_room(job, &bodies, mistakes);
    }
    packings_close(&packings);
    chain_close(&before);
    bodies_clear(&bodies);
    limits_spheres_clear(&all);
    return mistakes->n == 0;
}

/* ------------------------------------------------------------------------------- tremie
 * check */

static void print_extent(const char *label, const struct extent *e)
{
    report_say("%s x %.4g .. %.4g, y %.4g .. %.4g, z %.4g .. %.4g m", label, e->low.x,
               e->high.x, e->low.y, e->high.y, e->low.z, e->high.z);
}

/* Does every centre lie in the domain?  Along periodic directions all do. */
static bool is_inside(const struct extent *centres, const struct job *job)
{
    const struct vec3 *low = &job->domain.min, *high = &job->domain.max;
    const bool along[3] = {centres->low.x >= low->x && centres->high.x <= high->x,
                           centres->low.y >= low->y && centres->high.y <= high->y,
                           centres->low.z >= low->z && centres->high.z <= high->z};
    bool inside = true;
    for (int k = 0; k < 3; k++)
        inside = inside && (along[k] || (job->domain.periodic & 1 << k) != 0);
    return inside;
}

static void warn_of_limits(const struct job *job, const char *name, const struct limits *limits)
{
    const double step = job->time.step, contact = limits->shortest.duration / step;
    if (step > 0.4 * limits->rayleigh)
        report_warn(
            "time.step is %.3g of the Rayleigh step of '%s'; runs beyond 0.4 are likely "
            "to be unstable",
            step / limits->rayleigh, name);
    else if (step > job->watch.step * limits->springs)
        report_warn(
            "time.step is %.3g of what a full bed allows '%s' as it is struck; it would "
            "be stopped as unstable",
            step / limits->springs, name);
    else if (contact < 20.0)
        report_warn("impacts of '%s' at %.3g m/s last %.3g steps; below 20, restitution "
                    "scatters by over 0.013",
                    name, limits->speed, contact);
    if (limits->overlap > job->watch.overlap)
        report_warn("impacts of '%s' at %.3g m/s overlap by %.3g of a radius, more than "
                    "watch.overlap = %.3g: too soft for them",
                    name, limits->speed, limits->overlap, job->watch.overlap);
}

static void print_limits(const struct job *job, const struct limits *limits)
{
    const double step = job->time.step;
    report_say("          Rayleigh step %.4g s: the step is %.3g of it", limits->rayleigh,
               step / limits->rayleigh);
    if (limits->shortest.partner == NULL)
        return;
    report_say(
        "          at the bottom of a full bed, struck at %.3g m/s, %.3g of a radius deep: "
        "critical step %.4g s, the step is %.3g of it",
        limits->speed, limits->overlap, limits->springs, step / limits->springs);
    report_say("          such an impact lasts %.3g steps on %s, %.3g on %s: restitution "
               "scatters by about %.1g",
               limits->shortest.duration / step, limits->shortest.partner,
               limits->longest.duration / step, limits->longest.partner,
               limits_scatter(limits->shortest.duration / step));
}

static void print_group(const struct job *job, const char *name, const struct packing *packing,
                        const struct group_summary *s, const struct materials *materials,
                        struct limits_spheres *all)
{
    struct limits limits = limits_nothing(all);
    const double speed = all->speed;
    report_say("spheres   %s: %lld of %s, radius %.4g .. %.4g m, mass %.4g kg", name,
               (long long)s->n,
               s->material >= 0 ? job->materials[s->material].name : "several materials",
               s->radius_least, s->radius_most, s->mass);
    print_extent("         ", &s->extent);
    add_limits(&limits, job, materials, packing);
    print_limits(job, &limits);
    warn_of_limits(job, name, &limits);
    if (speed * job->time.step > job->watch.motion * s->radius_least)
        report_warn("at %.3g m/s spheres of '%s' or bodies move %.2g of the least radius in a "
                    "step, more than watch.motion = %.2g",
                    speed, name, speed * job->time.step / s->radius_least, job->watch.motion);
    if (!is_inside(&s->centres, job))
        report_warn("spheres of '%s' begin outside the domain", name);
}

/* All groups; returns how many spheres there are. */
static void print_insertion(const struct job *job, int k, const struct materials *materials,
                            struct limits_spheres *all)
{
    const struct job_insertion *insertion = &job->insertions[k];
    const struct inflow inflow = inflow_of(job, k);
    struct limits limits = limits_nothing(all);
    const double speed = all->speed;
    report_say(
        "insert    %s: %.0f spheres, %.4g kg, expected from %.6g s on; radius %.4g .. %.4g "
        "m, %.4g kg each in the mean",
        insertion->name, inflow.n, inflow.mass, insertion->start, inflow.radius_least,
        inflow.radius_most, inflow.mean_mass);
    report_say("          every %lld steps, %.3g s: %.4g spheres", (long long)insertion->every,
               (double)insertion->every * job->time.step,
               inflow.rate * (double)insertion->every * job->time.step);
    inflow_add_limits(&limits, job, materials, k);
    print_limits(job, &limits);
    warn_of_limits(job, insertion->name, &limits);
    if (speed * job->time.step > job->watch.motion * inflow.radius_least)
        report_warn("at %.3g m/s spheres of '%s' or bodies move %.2g of the least radius in a "
                    "step, more than watch.motion = %.2g",
                    speed, insertion->name, speed * job->time.step / inflow.radius_least,
                    job->watch.motion);
}

/* The spheres that another job has left, group by group. */
static void print_chain(const struct job *job, const struct chain *chain,
                        const struct materials *materials, struct limits_spheres *all)
{
    const int n_groups = job_n_groups(job);
    int64_t *counts = array_allocate((size_t)n_groups, sizeof *counts);
    struct packing group = {.rows =
                                array_allocate((size_t)chain->packing.n, sizeof *group.rows)};
    report_say("start     %s, step %lld (%.6g s)", chain->path, (long long)chain->step,
               chain->time);
    for (int64_t k = 0; k < chain->packing.n; k++)
        counts[chain->group_of[k]]++;
    for (int g = 0; g < n_groups; g++) {
        if (counts[g] == 0)
            continue;
        group.n = 0;
        for (int64_t k = 0; k < chain->packing.n; k++)
            if (chain->group_of[k] == g)
                group.rows[group.n++] = chain->packing.rows[k];
        const struct group_summary summary = summarise(job, &group);
        print_group(job, job_group_name(job, g), &group, &summary, materials, all);
    }
    free(group.rows);
    free(counts);
}

static int64_t print_groups(const struct job *job, const struct bodies *bodies,
                            const struct materials *materials, struct limits_spheres *all,
                            struct extent *scene, double *radius_most)
{
    struct group_summary *groups = array_allocate((size_t)job->n_spheres, sizeof *groups);
    struct packings packings;
    struct mistakes mistakes;
    struct chain before = {.path = NULL};
    int64_t n = 0;
    mistakes_init(&mistakes);
    CHECK(!job->start.given || chain_open(&before, job, &mistakes),
          "the start was there and has gone: %s", mistakes.list[0].text);
    CHECK(packings_open(&packings, job, bodies, &before.packing, sphere_file_read, &mistakes),
          "a packing was there and has gone: %s", mistakes.list[0].text);
    mistakes_clear(&mistakes);
    const struct group_summary already = summarise(job, &before.packing);
    if (already.n > 0) {
        all->speed = already.speed;
        all->mass = already.mass;
        extent_add(scene, already.extent.low, 0.0);
        extent_add(scene, already.extent.high, 0.0);
        n += already.n;
    }
    for (int g = 0; g < job->n_spheres; g++) {
        groups[g] = summarise(job, &packings.groups[g]);
        all->speed = groups[g].speed > all->speed ? groups[g].speed : all->speed;
        all->mass += groups[g].mass;
        *radius_most =
            groups[g].radius_most > *radius_most ? groups[g].radius_most : *radius_most;
        extent_add(scene, groups[g].extent.low, 0.0);
        extent_add(scene, groups[g].extent.high, 0.0);
        n += groups[g].n;
    }
    add_inflows(job, all);
    all->speed = foresee_speed(job, bodies, all->speed);
    if (already.n > 0)
        print_chain(job, &before, materials, all);
    for (int g = 0; g < job->n_spheres; g++)
        print_group(job, job->spheres[g].name, &packings.groups[g], &groups[g], materials, all);
    for (int k = 0; k < job->n_insertions; k++)
        print_insertion(job, k, materials, all);
    packings_close(&packings);
    chain_close(&before);
    free(groups);
    return n;
}

/* A sphere at a periodic boundary would meet the end of such a body, or not see it at all. */
static void warn_of_end(const struct job *job, const char *name, const struct extent *extent,
                        double radius)
{
    const double from[3] = {job->domain.min.x, job->domain.min.y, job->domain.min.z},
                 to[3] = {job->domain.max.x, job->domain.max.y, job->domain.max.z};
    const double low[3] = {extent->low.x, extent->low.y, extent->low.z},
                 high[3] = {extent->high.x, extent->high.y, extent->high.z};
    for (int k = 0; k < 3; k++) {
        const bool ends_low = low[k] < from[k] + radius && low[k] > from[k] - radius;
        const bool ends_high = high[k] > to[k] - radius && high[k] < to[k] + radius;
        if ((job->domain.periodic & 1 << k) && (ends_low || ends_high))
            report_warn(
                "body '%s' ends within a radius, %.3g m, of the periodic boundary along "
                "%c; let it reach past by a radius on both sides",
                name, radius, "xyz"[k]);
    }
}

/* Spheres that leave the domain are removed or stop the run, so none meets such a body. */
static void warn_of_distance(const struct job *job, const struct body *body,
                             const struct extent *extent, double radius)
{
    const struct vec3 from = job->domain.min, to = job->domain.max;
    const struct vec3 low = extent->low, high = extent->high;
    const bool outside = high.x < from.x - radius || low.x > to.x + radius ||
                         high.y < from.y - radius || low.y > to.y + radius ||
                         high.z < from.z - radius || low.z > to.z + radius;
    if (outside && !body->moves && job->domain.leavers != JOB_LEAVERS_IGNORE)
        report_warn("body '%s' lies outside the domain, where no sphere meets it; move it, or "
                    "enlarge domain.min and domain.max",
                    body->name);
}

static void warn_of_ends(const struct job *job, const struct bodies *bodies, double radius)
{
    for (int b = 0; b < bodies->n; b++) {
        struct extent extent = extent_nothing();
        const struct body *body = &bodies->list[b];
        for (int v = 0; v < body->mesh.n_vertices; v++)
            extent_add(&extent, body->mesh.reference[v], 0.0);
        warn_of_end(job, body->name, &extent, radius);
        warn_of_distance(job, body, &extent, radius);
    }
}

/* The inside of a body catches who is in it at a step; other regions also who passes through in
 * one. */
static void warn_of_thin_removals(const struct job *job, const struct bodies *bodies,
                                  double radius)
{
    const double way = job->watch.motion * radius;
    for (int k = 0; k < job->n_removals; k++) {
        struct region region;
        char *why = NULL;
        if (job->removals[k].region.kind != JOB_REGION_INSIDE ||
            !region_build(&region, &job->removals[k].region, bodies, &why)) {
            free(why);
            continue;
        }
        const struct vec3 size = vec3_sub(region.high, region.low);
        const double aside = size.x < size.y ? size.x : size.y;
        const double least = size.z < aside ? size.z : aside;
        if (least < way)
            report_warn(
                "the region of removal '%s' is %.3g m thin and spheres may go %.3g m in "
                "a step (watch.motion), so some could pass through the inside of a body "
                "unseen; a box, cylinder or sphere misses none",
                job->removals[k].name, least, way);
        region_clear(&region);
    }
}

/* The forces of the start, as the run would find them.  Collective. */
static void print_start(const struct job *job, const struct comm *comm)
{
    struct simulation sim;
    char what[160];
    if (simulation_create(&sim, comm, job, ISA_AUTO) != REPORT_FINISHED)
        return;
    step_forces(&sim);
    survey_warn(job, &sim.bodies, &sim.spheres, comm);
    const double deepest = watch_deepest(&sim, what, sizeof what);
    const double critical = watch_critical_step(&sim);
    double rounding = sim.watch.rounding;
    comm_max(comm, &rounding, 1);
    if (deepest > 0.0)
        report_say("start     contacts overlap by up to %.2g of a radius; their critical step "
                   "is %.4g s, the step is %.3g of it",
                   deepest, critical, job->time.step / critical);
    else
        report_say("start     nothing touches");
    const double much = job->start.given ? 0.5 : 0.1; /* who lies on others overlaps somewhat */
    if (deepest > much * job->watch.overlap)
        report_warn("at the start %s overlap by %.2g of a radius; beyond watch.overlap = %.2g "
                    "the run stops",
                    what, deepest, job->watch.overlap);
    if (rounding > 1.0)
        report_warn("the scene is so far from the origin that the rounding of places spoils "
                    "contacts, %.2g times what is borne; shift it towards the origin",
                    rounding);
    simulation_destroy(&sim);
}

static const double SECONDS_A_SPHERE = 60e-9; /* a step */

/* Time and memory, of so many spheres in the mean and at most. */
static void print_cost(const struct job *job, double n_mean, double n_most, int n_ranks)
{
    const struct solid_survey_cost solids = solid_survey_cost(job);
    const double n_steps = job->time.end / job->time.step;
    const double seconds = n_steps * (n_mean * SECONDS_A_SPHERE + solids.seconds) / n_ranks;
    const double bytes = n_most * SIMULATION_BYTES_A_SPHERE + n_ranks * solids.bytes;
    char elements[64] = "";
    if (solids.n_elements > 0.0)
        snprintf(elements, sizeof elements, " and %.3g element-steps",
                 solids.n_elements * n_steps);
    report_say(
        "cost      %.3g particle-steps%s: of the order of %.3g s on %d rank%s; memory of "
        "the order of %.3g MB",
        n_mean * n_steps, elements, seconds, n_ranks, n_ranks == 1 ? "" : "s", bytes * 1e-6);
    if (solids.n_elements > 0.0)
        report_say("          of that solids: %.3g MB on each rank, %.3g bytes an element",
                   solids.bytes * 1e-6, solids.bytes / solids.n_elements);
}

/* Also where spheres will come in. */
static struct advise_cloud cloud_of(const struct job *job, const struct bodies *bodies,
                                    const struct extent *spheres, double n_mean)
{
    struct extent extent = *spheres;
    for (int k = 0; k < job->n_insertions; k++) {
        struct region region;
        char *why = NULL;
        if (region_build(&region, &job->insertions[k].region, bodies, &why)) {
            extent_add(&extent, region.low, 0.0);
            extent_add(&extent, region.high, 0.0);
            region_clear(&region);
        }
        free(why);
    }
    return (struct advise_cloud){extent.low, extent.high, n_mean * SECONDS_A_SPHERE};
}

void check_print(const struct job *job, const struct comm *comm, bool advise)
{
    enum { START_MOST = 4000000 };
    struct extent scene = extent_nothing();
    struct bodies bodies;
    struct materials materials;
    struct limits_spheres all;
    const int n_ranks = comm->n_ranks;
    const double n_steps = job->time.end / job->time.step;
    report_say("job       %s: %s", job->path, job->title);
    report_say("time      %.6g s in %.0f steps of %.6g s", job->time.end, n_steps,
               job->time.step);
    bodies_build(&bodies, job);
    materials_build(&materials, job);
    limits_spheres_init(&all, job);
    double radius_most = 0.0;
    const int64_t n = print_groups(job, &bodies, &materials, &all, &scene, &radius_most);
    double n_mean = (double)n, n_most = (double)n;
    for (int k = 0; k < job->n_insertions; k++) {
        const struct inflow inflow = inflow_of(job, k);
        n_mean += inflow.n_mean;
        n_most += inflow.n;
    }
    survey_print(job, &bodies, &materials, &all);
    if (advise) {
        const struct advise_cloud cloud = cloud_of(job, &bodies, &scene, n_mean);
        advise_print(job, &bodies, &materials, &all, &cloud);
    }
    limits_spheres_clear(&all);
    materials_clear(&materials);
    warn_of_ends(job, &bodies, radius_most);
    warn_of_thin_removals(job, &bodies, radius_most);
    inflow_warn(job, &bodies);
    add_bodies(&bodies, &scene);
    bodies_clear(&bodies);
    print_extent("scene    ", &scene);
    const struct extent domain = {job->domain.min, job->domain.max};
    print_extent("domain   ", &domain);
    for (int s = 0; s < job->n_sections; s++)
        report_say("section   %s", job->sections[s].name);
    for (int k = 0; k < job->n_contents; k++)
        report_say("content   %s", job->contents[k].name);
    for (int k = 0; k < job->n_removals; k++)
        report_say("remove    %s", job->removals[k].name);
    if (n <= START_MOST * (int64_t)n_ranks)
        print_start(job, comm);
    print_cost(job, n_mean, n_most, n_ranks);
    if (job->watch.motion + job->watch.overlap >= 1.0)
        report_warn("watch.motion and watch.overlap add up to 1 or more: a sphere could pass "
                    "through a surface unnoticed");
    if (n_most < 500.0 * n_ranks && n_ranks > 1)
        report_warn("%.0f spheres on %d ranks: fewer ranks would be faster", n_most, n_ranks);
}
