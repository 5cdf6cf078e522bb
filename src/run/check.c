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
#include "model/packing.h"
#include "physics/critical_step.h"
#include "run/simulation.h"
#include "store/crc32.h"
#include "store/file.h"

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
    double rayleigh, speed;                 /* least step [s], largest speed [m/s] */
    struct packing_sphere stiffest;         /* the sphere with that step */
    bool one_material;
    struct extent extent, centres;
};

static double rayleigh_step(const struct job *job, const struct packing_sphere *s)
{
    const struct job_material *m = &job->materials[s->material];
    return critical_step_rayleigh(s->radius, m->density, m->young, m->poisson);
}

static struct group_summary summarise(const struct job *job, const struct packing *packing)
{
    struct group_summary summary = {.n = packing->n,
                                    .radius_least = 1e300,
                                    .rayleigh = 1e300,
                                    .one_material = true,
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
        const double speed = vec3_norm(s.velocity), rayleigh = rayleigh_step(job, &s);
        summary.speed = speed > summary.speed ? speed : summary.speed;
        summary.one_material =
            summary.one_material && (k == 0 || s.material == summary.stiffest.material);
        if (rayleigh < summary.rayleigh) {
            summary.rayleigh = rayleigh;
            summary.stiffest = s;
        }
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

static void choose_times(struct job *job)
{
    double critical;
    job->time.step = simulation_choose_step(job, &critical);
    const double n_steps = (double)simulation_steps(job->time.end, job->time.step);
    job->time.end = (n_steps > 1.0 ? n_steps : 1.0) * job->time.step;
    if (job->output.series_every > 0.0) {
        const double n = (double)simulation_steps(job->output.series_every, job->time.step);
        job->output.series_every = (n > 1.0 ? n : 1.0) * job->time.step;
    }
}

/* A packing says "file:line:column: what"; the place goes where places go. */
static void add_csv_mistake(struct mistakes *mistakes, const char *file, const char *why)
{
    int line = 0, column = 0, begin = 0;
    const char *rest = why + strlen(file);
    if (sscanf(rest, ":%d:%d: %n", &line, &column, &begin) < 2)
        begin = 2; /* "file: what" */
    mistakes_add(mistakes, file, line, column, "%s", rest + begin);
}

/* Checksum of a CSV file that has just been read; 0 when it has gone. */
static int64_t checksum(const char *path)
{
    enum { MOST = INT_MAX };
    struct crc32 crc;
    char *text = NULL, *why = file_read(path, MOST, &text);
    crc32_init(&crc);
    const int64_t sum = why == NULL ? (int64_t)crc32_of(&crc, text, strlen(text)) : 0;
    free(text);
    free(why);
    return sum;
}

bool check_complete(struct job *job, int n_ranks, struct mistakes *mistakes)
{
    struct extent scene = extent_nothing();
    const int *grid = job->decomposition.fixed;
    int64_t n_spheres = 0;
    for (int g = 0; g < job->n_spheres; g++) {
        struct packing packing;
        char *why = NULL;
        if (!packing_open(&packing, job, g, &why)) {
            add_csv_mistake(mistakes, job->spheres[g].file, why);
            free(why);
            continue;
        }
        const struct group_summary summary = summarise(job, &packing);
        extent_add(&scene, summary.extent.low, 0.0);
        extent_add(&scene, summary.extent.high, 0.0);
        n_spheres += packing.n;
        if (packing.rows != NULL)
            job->spheres[g].sum = checksum(job->spheres[g].file);
        packing_close(&packing);
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
    if (mistakes->n > 0)
        return false;
    struct bodies bodies;
    bodies_build(&bodies, job);
    add_bodies(&bodies, &scene);
    bodies_clear(&bodies);
    if (job->time.step == 0.0)
        choose_times(job);
    choose_domain(job, &scene);
    return true;
}

/* ------------------------------------------------------------------------------- tremie
 * check */

static void print_extent(const char *label, const struct extent *e)
{
    report_say("%s x %.4g .. %.4g, y %.4g .. %.4g, z %.4g .. %.4g m", label, e->low.x,
               e->high.x, e->low.y, e->high.y, e->low.z, e->high.z);
}

/* Steps that an impact of two such spheres at this speed lasts. */
static double steps_per_contact(const struct job *job, const struct packing_sphere *sphere,
                                double speed)
{
    const struct job_material *m = &job->materials[sphere->material];
    const double radius = sphere->radius;
    const double mass =
        m->density * 4.0 / 3.0 * 3.14159265358979323846 * radius * radius * radius;
    const double young = m->young / (2.0 * (1.0 - m->poisson * m->poisson));
    return critical_step_hertz_duration(0.5 * mass, 0.5 * radius, young, speed) /
           job->time.step;
}

/* Does every centre lie in the domain? */
static bool is_inside(const struct extent *centres, const struct job *job)
{
    const struct vec3 *low = &job->domain.min, *high = &job->domain.max;
    return centres->low.x >= low->x && centres->low.y >= low->y && centres->low.z >= low->z &&
           centres->high.x <= high->x && centres->high.y <= high->y &&
           centres->high.z <= high->z;
}

static void warn_of_group(const struct job *job, const char *name,
                          const struct group_summary *s, double speed, double contact)
{
    if (job->time.step > 0.4 * s->rayleigh)
        report_warn(
            "time.step is %.3g of the Rayleigh step of '%s'; runs beyond 0.4 are likely to be "
            "unstable",
            job->time.step / s->rayleigh, name);
    else if (contact < 20.0)
        report_warn(
            "impacts of '%s' at %.3g m/s last %.3g steps; below 20, restitution scatters by "
            "over 0.013",
            name, speed, contact);
    if (!is_inside(&s->centres, job))
        report_warn("spheres of '%s' begin outside the domain", name);
}

static void print_group(const struct job *job, int g, struct extent *scene, int64_t *n,
                        double fall)
{
    struct packing packing;
    char *why = NULL;
    CHECK(packing_open(&packing, job, g, &why), "%s", why);
    const struct job_spheres *group = &job->spheres[g];
    const struct group_summary s = summarise(job, &packing);
    packing_close(&packing);
    *n += s.n;
    extent_add(scene, s.extent.low, 0.0);
    extent_add(scene, s.extent.high, 0.0);
    report_say("spheres  %s: %lld of %s, radius %.4g .. %.4g m, mass %.4g kg", group->name,
               (long long)s.n,
               s.one_material ? job->materials[s.stiffest.material].name : "several materials",
               s.radius_least, s.radius_most, s.mass);
    print_extent("         ", &s.extent);
    const double speed = s.speed > fall ? s.speed : fall;
    const double contact = steps_per_contact(job, &s.stiffest, speed);
    report_say(
        "         Rayleigh step %.4g s: the step is %.3g of it; an impact at %.3g m/s lasts "
        "%.3g steps",
        s.rayleigh, job->time.step / s.rayleigh, speed, contact);
    warn_of_group(job, group->name, &s, speed, contact);
}

static void print_bodies(const struct job *job, struct extent *scene)
{
    struct bodies bodies;
    bodies_build(&bodies, job);
    for (int b = 0; b < bodies.n; b++) {
        struct extent extent = extent_nothing();
        const struct body *body = &bodies.list[b];
        for (int v = 0; v < body->mesh.n_vertices; v++)
            extent_add(&extent, body->mesh.reference[v], 0.0);
        report_say("body     %s: rigid, %s, %d facet%s%s", body->name,
                   job->materials[body->material].name, body->mesh.n_faces,
                   body->mesh.n_faces == 1 ? "" : "s",
                   body->moves ? ", moves as prescribed" : "");
        print_extent("         ", &extent);
    }
    add_bodies(&bodies, scene);
    bodies_clear(&bodies);
}

/* Speed after a fall through half the domain along gravity; 1 m/s without gravity. */
static double fall_speed(const struct job *job)
{
    const struct vec3 g = job->gravity, size = vec3_sub(job->domain.max, job->domain.min);
    const double along = fabs(g.x) * size.x + fabs(g.y) * size.y + fabs(g.z) * size.z;
    return along > 0.0 ? sqrt(along) : 1.0;
}

void check_print(const struct job *job, int n_ranks)
{
    enum { BYTES_A_SPHERE = 1100, NANOSECONDS_A_STEP = 60 };
    struct extent scene = extent_nothing();
    int64_t n = 0;
    const double n_steps = job->time.end / job->time.step;
    report_say("job      %s: %s", job->path, job->title);
    report_say("time     %.6g s in %.0f steps of %.6g s", job->time.end, n_steps,
               job->time.step);
    for (int k = 0; k < job->n_spheres; k++)
        print_group(job, k, &scene, &n, fall_speed(job));
    print_bodies(job, &scene);
    print_extent("scene    ", &scene);
    const struct extent domain = {job->domain.min, job->domain.max};
    print_extent("domain   ", &domain);
    for (int s = 0; s < job->n_sections; s++)
        report_say("section  %s", job->sections[s].name);
    const double particle_steps = (double)n * n_steps;
    report_say(
        "cost     %.3g particle-steps: of the order of %.3g s on %d rank%s; memory of the "
        "order of %.3g MB",
        particle_steps, particle_steps * NANOSECONDS_A_STEP * 1e-9 / n_ranks, n_ranks,
        n_ranks == 1 ? "" : "s", (double)n * BYTES_A_SPHERE * 1e-6);
    if (n < 500 * (int64_t)n_ranks && n_ranks > 1)
        report_warn("%lld spheres on %d ranks: fewer ranks would be faster", (long long)n,
                    n_ranks);
}
