/*
 * The fast path equals an all-pairs reference, bit for bit.  ranks: 1 2 3
 *
 * The reference is written anew here, plain and slow: every step it takes each two spheres in
 * canonical order through the contact law, with a square table as memory, and moves them by
 * leapfrog in the same order of operations.  It knows no search, no buffer, no lists, no ranks.
 * Contacts with bodies come from their own module, which lists every feature for every sphere.
 * Every rank computes the whole reference and compares what it owns.
 */
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/report.h"
#include "check.h"
#include "contact/facet_step.h"
#include "job/job.h"
#include "model/packing.h"
#include "physics/contact_law.h"
#include "random_cloud.h"
#include "run/simulation.h"
#include "run/step.h"

/* ------------------------------------------------------------------------ the reference */

struct reference {
    const struct job *job;
    struct materials materials;
    struct bodies bodies;
    struct facet_contacts facets;
    struct spheres spheres; /* by id; none ever moves in memory */
    bool *gone;
    int n_here;
    int *order;                       /* ids in canonical order */
    double (*history)[CONTACT_LANES]; /* at lower id * n + higher id, from lower to higher */
    struct exact_sum wound;           /* work that springs between spheres took up [J] */
    int64_t step;
};

static int compare_longs(const void *a, const void *b)
{
    const int64_t *p = a, *q = b;
    return p[0] != q[0] ? (p[0] < q[0] ? -1 : 1) : (p[1] > q[1]) - (p[1] < q[1]);
}

static int64_t cell_along(double x, double radius_max)
{
    return (int64_t)(x * (1.0 / (2.2 * radius_max)) + 1048576.0);
}

/* Everybody's cell, and the order that follows. */
static void reference_sort(struct reference *r)
{
    double radius_max = 0.0;
    const int n = r->spheres.n_all;
    int64_t(*keys)[2] = array_allocate((size_t)n, sizeof *keys);
    for (int i = 0; i < n; i++) {
        const double radius = sphere_radius(&r->spheres, i);
        radius_max = !r->gone[i] && radius > radius_max ? radius : radius_max;
    }
    r->n_here = 0;
    for (int i = 0; i < n; i++) {
        if (r->gone[i])
            continue;
        const double *x = sphere_position(&r->spheres, i);
        int64_t cell = 0;
        for (int k = 2; k >= 0; k--)
            cell = cell * 2097152 + cell_along(x[k], radius_max);
        r->spheres.order_cell[i] = cell;
        keys[r->n_here][0] = cell;
        keys[r->n_here++][1] = i;
    }
    qsort(keys, (size_t)r->n_here, sizeof *keys, compare_longs);
    for (int k = 0; k < r->n_here; k++)
        r->order[k] = (int)keys[k][1];
    free(keys);
}

static void reference_start(struct reference *r, const struct job *job)
{
    *r = (struct reference){.job = job};
    materials_build(&r->materials, job);
    bodies_build(&r->bodies, job);
    facet_contacts_init(&r->facets, r->bodies.n, ISA_AUTO);
    spheres_init(&r->spheres);
    periodic_init(&r->spheres.periodic, job);
    spheres_reserve(&r->spheres, job->n_spheres);
    const int n = r->spheres.n_owned = r->spheres.n_all = job->n_spheres;
    for (int i = 0; i < n; i++) {
        struct packing packing;
        char *why;
        EXPECT(packing_open(&packing, job, i, &why) && packing.n == 1);
        const struct packing_sphere s = packing_get(&packing, 0);
        packing_close(&packing);
        const struct vec3 x = periodic_settled(&r->spheres.periodic, s.position);
        r->spheres.motion[i] = (struct sphere_row){
            {x.x, x.y, x.z, s.radius, s.velocity.x, s.velocity.y, s.velocity.z, s.radius}};
        r->spheres.spin[i] =
            (struct sphere_row){{0.0, 0.0, 0.0, 0.0, s.angular_velocity.x, s.angular_velocity.y,
                                 s.angular_velocity.z, 0.0}};
        r->spheres.id[i] = i;
        r->spheres.material[i] = s.material;
        sphere_complete(&r->spheres, i, &r->materials);
    }
    r->gone = array_allocate((size_t)n, sizeof *r->gone);
    r->order = array_allocate((size_t)n, sizeof *r->order);
    r->history = array_allocate((size_t)(n * n), sizeof *r->history);
    reference_sort(r);
    bodies_place(&r->bodies, 0, job->time.step);
    double *none = array_allocate((size_t)r->bodies.n, sizeof *none);
    facet_contacts_search(&r->facets, &r->spheres, &r->bodies, none, true);
    free(none);
}

static void reference_end(struct reference *r)
{
    materials_clear(&r->materials);
    bodies_clear(&r->bodies);
    facet_contacts_clear(&r->facets);
    spheres_clear(&r->spheres);
    free(r->gone);
    free(r->order);
    free(r->history);
}

/* Does a lane change its sign with the side?  What no law fills stays +0. */
static bool turns(const struct reference *r, int lane)
{
    return contact_lane_turns(lane) &&
           contact_lane_used(lane, r->materials.full, r->job->energy_ledger);
}

static void load_history(const struct reference *r, int i, int j, double *history)
{
    const int n = r->spheres.n_all, lower = i < j ? i : j, higher = i < j ? j : i;
    const double *h = r->history[lower * n + higher];
    const bool turn = i > j && h[CONTACT_LAW_RADIUS] > 0.0;
    for (int l = 0; l < CONTACT_LANES; l++)
        history[l] = turn && turns(r, l) ? -h[l] : h[l];
}

static void save_history(struct reference *r, int i, int j, const double *history)
{
    const int n = r->spheres.n_all, lower = i < j ? i : j, higher = i < j ? j : i;
    double *h = r->history[lower * n + higher];
    const bool turn = i > j && history[CONTACT_LAW_RADIUS] > 0.0;
    for (int l = 0; l < CONTACT_LANES; l++)
        h[l] = turn && turns(r, l) ? -history[l] : history[l];
}

static void add_load(double *row, double sign, const double *force, double arm,
                     const double *turn, const struct contact_law_result *result, bool full,
                     bool ledger)
{
    for (int k = 0; k < 3; k++) {
        row[k] += sign * force[k];
        row[4 + k] += full ? arm * turn[k] + sign * result->torque[k] : arm * turn[k];
    }
    if (ledger) {
        row[3] += 0.5 * result->lost_friction;
        row[7] += 0.5 * result->lost_damping;
    }
}

/* To the nearest image of a place that is that far away within the domain. */
static double shortest_way(const struct periodic *periodic, int k, double way)
{
    const double period = periodic->period[k];
    if (way > 0.5 * period && period > 0.0)
        return way - period;
    return way < -0.5 * period ? way + period : way;
}

/* What i, the first in canonical order, and j do to each other. */
static void reference_pair(struct reference *r, int i, int j)
{
    const double *a = r->spheres.motion[i].lane, *b = r->spheres.motion[j].lane;
    const double *p = r->spheres.spin[i].lane, *q = r->spheres.spin[j].lane;
    double x[3];
    for (int k = 0; k < 3; k++)
        x[k] = shortest_way(&r->spheres.periodic, k, b[k] - a[k]);
    const double distance = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    const double depth = a[3] + b[3] - distance, overlap = depth > 0.0 ? depth : 0.0;
    const double inverse = 1.0 / distance;
    const double n[3] = {x[0] * inverse, x[1] * inverse, x[2] * inverse};
    double arm[3]; /* of both, times their angular velocities [m/s] */
    for (int k = 0; k < 3; k++)
        arm[k] = (a[3] * p[4 + k] + b[3] * q[4 + k]) - 0.5 * overlap * (p[4 + k] + q[4 + k]);
    const struct contact_law_meeting meeting = {
        .normal = {n[0], n[1], n[2]},
        .velocity = {b[4] - a[4] - (arm[1] * n[2] - arm[2] * n[1]),
                     b[5] - a[5] - (arm[2] * n[0] - arm[0] * n[2]),
                     b[6] - a[6] - (arm[0] * n[1] - arm[1] * n[0])},
        .overlap = overlap,
        .inverse_radius = 1.0 / a[3] + 1.0 / b[3],
        .width = 1.0,
        .inverse_mass = p[7] + q[7],
        .spin = {q[4] - p[4], q[5] - p[5], q[6] - p[6]},
    };
    const struct material_pair *pair =
        &r->materials.pairs[r->spheres.material[i] * r->materials.n + r->spheres.material[j]];
    const bool ledger = r->job->energy_ledger;
    struct contact_law_result result;
    double history[CONTACT_LANES];
    load_history(r, i, j, history);
    contact_law_scalar(&meeting, pair, r->job->time.step,
                       (struct contact_law_choice){.full = r->materials.full, .ledger = ledger},
                       history, &result);
    save_history(r, i, j, history);

    const double *f = result.tangential;
    const double force[3] = {f[0] + result.normal * n[0], f[1] + result.normal * n[1],
                             f[2] + result.normal * n[2]};
    const double turn[3] = {n[2] * f[1] - n[1] * f[2], n[0] * f[2] - n[2] * f[0],
                            n[1] * f[0] - n[0] * f[1]};
    const double sum = a[3] + b[3], difference = b[3] - a[3];
    add_load(r->spheres.force[i].lane, -1.0, force, 0.5 * (sum - difference) - 0.5 * overlap,
             turn, &result, r->materials.full, ledger);
    add_load(r->spheres.force[j].lane, 1.0, force, 0.5 * (sum + difference) - 0.5 * overlap,
             turn, &result, r->materials.full, ledger);
    if (ledger)
        exact_sum_add(&r->wound, result.wound);
}

static void reference_move(struct reference *r, int i)
{
    const struct job *job = r->job;
    const double dt = job->time.step, half = 0.5 * job->damping * dt;
    const double push = 1.0 / (1.0 + half), keep = (1.0 - half) / (1.0 + half);
    const double g[3] = {job->gravity.x, job->gravity.y, job->gravity.z};
    double *x = r->spheres.motion[i].lane, *v = x + 4;
    double *w = r->spheres.spin[i].lane + 4, *load = r->spheres.force[i].lane;
    const double radius = x[3], inverse_mass = w[3], inverse_radius = 1.0 / radius;
    double speed2 = 0.0, spin2 = 0.0; /* at the step, for the ledger */
    for (int k = 0; k < 3; k++) {
        const double before = v[k], spun = w[k];
        v[k] = before * keep + load[k] * (push * dt * inverse_mass) + push * dt * g[k];
        w[k] = w[k] * keep +
               load[4 + k] * (push * dt * 2.5 * inverse_mass * inverse_radius * inverse_radius);
        const double snap = r->spheres.periodic.snap[k], moved = v[k] * dt;
        x[k] += snap > 0.0 ? (moved + snap) - snap : moved;
        speed2 += 0.5 * (before + v[k]) * (0.5 * (before + v[k]));
        spin2 += 0.5 * (spun + w[k]) * (0.5 * (spun + w[k]));
    }
    if (job->energy_ledger) {
        r->spheres.dissipated_friction[i] += load[3];
        r->spheres.dissipated_damping[i] += load[7];
        if (job->damping > 0.0)
            r->spheres.dissipated_damping[i] +=
                job->damping * dt / inverse_mass * (speed2 + 0.4 * radius * radius * spin2);
    }
    int turned[3];
    periodic_wrap(&r->spheres.periodic, x, turned);
    memset(load, 0, sizeof r->spheres.force[i]);
    sphere_complete(&r->spheres, i, &r->materials);
}

static void reference_remove_leavers(struct reference *r)
{
    const struct vec3 low = r->job->domain.min, high = r->job->domain.max;
    for (int i = 0; i < r->spheres.n_all; i++) {
        const double *x = sphere_position(&r->spheres, i);
        const bool inside = x[0] >= low.x && x[1] >= low.y && x[2] >= low.z && x[0] <= high.x &&
                            x[1] <= high.y && x[2] <= high.z;
        r->gone[i] = r->gone[i] || !inside;
    }
    int n = 0;
    for (int k = 0; k < r->n_here; k++) {
        if (!r->gone[r->order[k]])
            r->order[n++] = r->order[k];
    }
    r->n_here = n;
}

static void reference_step(struct reference *r)
{
    const struct job *job = r->job;
    bodies_place(&r->bodies, r->step, job->time.step);
    if (job->domain.leavers == JOB_LEAVERS_REMOVE && r->step % 64 == 0)
        reference_remove_leavers(r);
    if (r->step % job->order_every == 0)
        reference_sort(r);
    facet_step_apply(&r->facets, &r->spheres, &r->bodies, &r->materials, job->time.step,
                     job->energy_ledger);
    for (int a = 0; a < r->n_here; a++) {
        for (int b = a + 1; b < r->n_here; b++)
            reference_pair(r, r->order[a], r->order[b]);
    }
    for (int k = 0; k < r->n_here; k++)
        reference_move(r, r->order[k]);
    r->step++;
}

/* ------------------------------------------------------------------------------ comparison */

static bool same_bits(const double *a, const double *b, size_t n)
{
    return memcmp(a, b, n * sizeof *a) == 0;
}

/* What is different in a sphere; NULL when nothing is. */
static const char *sphere_difference(const struct spheres *s, int i, const struct spheres *r)
{
    const int64_t id = s->id[i];
    const struct vec3 place = sphere_place(s, i);
    if (!same_bits(s->motion[i].lane + 3, r->motion[id].lane + 3, 5))
        return "motion";
    if (!same_bits(&place.x, r->motion[id].lane, 3))
        return "place";
    if (!same_bits(s->spin[i].lane, r->spin[id].lane, 8))
        return "spin";
    if (s->order_cell[i] != r->order_cell[id])
        return "order_cell";
    if (!same_bits(&s->dissipated_friction[i], &r->dissipated_friction[id], 1))
        return "dissipated_friction";
    if (!same_bits(&s->dissipated_damping[i], &r->dissipated_damping[id], 1))
        return "dissipated_damping";
    return NULL;
}

static void compare_spheres(const struct simulation *sim, const struct reference *r)
{
    int64_t n = sim->spheres.n_owned;
    comm_sum_int(sim->comm, &n, 1);
    EXPECT(n == r->n_here && sim->n_spheres == n);
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        const char *what = sphere_difference(&sim->spheres, i, &r->spheres);
        EXPECT(!r->gone[sim->spheres.id[i]]);
        if (what != NULL)
            CHECK_FAIL("%s of sphere %d differs at step %d", what, (int)sim->spheres.id[i],
                       (int)sim->step);
    }
}

/* Every contact here has the reference's history, and none is missing; returns how many. */
static int compare_contacts(const struct simulation *sim, const struct reference *r)
{
    struct contact_record *records = NULL;
    int capacity = 0, n_reference = 0;
    const int n_all = r->spheres.n_all;
    unsigned char *everybody = array_allocate((size_t)sim->spheres.n_owned, 1);
    memset(everybody, 1, (size_t)sim->spheres.n_owned);
    int n = contact_set_records(&sim->contacts, &sim->spheres, everybody, &records, &capacity);
    for (int k = 0; k < n; k++) {
        const int at = (int)records[k].first_id * n_all + (int)records[k].second_id;
        if (!same_bits(records[k].history, r->history[at], CONTACT_LANES))
            CHECK_FAIL("history of spheres %d and %d differs at step %d",
                       (int)records[k].first_id, (int)records[k].second_id, (int)sim->step);
    }
    int64_t once = contact_set_records_of(&sim->contacts, &sim->spheres, 0, INT64_MAX, &records,
                                          &capacity);
    comm_sum_int(sim->comm, &once, 1);
    for (int a = 0; a < r->n_here; a++) {
        for (int b = 0; b < r->n_here; b++)
            n_reference += r->history[r->order[a] * n_all + r->order[b]][3] > 0.0;
    }
    EXPECT(once == n_reference);
    free(everybody);
    free(records);
    return n_reference;
}

/* A rank's share of a sum, and all of it. */
static void compare_sums(const struct simulation *sim, const struct exact_sum *share,
                         const struct exact_sum *whole)
{
    struct exact_sum sums[2] = {*share, *whole};
    exact_sum_reduce(sim->comm, sums, 1);
    exact_sum_normalise(&sums[1]);
    EXPECT(memcmp(sums[0].limb, sums[1].limb, sizeof sums[0].limb) == 0);
}

static int compare_facets(const struct simulation *sim, const struct reference *r)
{
    struct facet_contact_record *own = NULL, *reference = NULL;
    int64_t n = facet_contacts_records(&sim->facets, &sim->spheres, 0, INT64_MAX, &own);
    const int n_reference =
        facet_contacts_records(&r->facets, &r->spheres, 0, INT64_MAX, &reference);
    for (int k = 0; k < n; k++) {
        bool found = false;
        for (int m = 0; m < n_reference; m++)
            found =
                found || (reference[m].id == own[k].id && reference[m].body == own[k].body &&
                          reference[m].feature == own[k].feature &&
                          same_bits(reference[m].history, own[k].history, CONTACT_LANES));
        if (!found)
            CHECK_FAIL("history of sphere %d with feature %d differs at step %d",
                       (int)own[k].id, (int)own[k].feature, (int)sim->step);
    }
    free(own);
    free(reference);
    comm_sum_int(sim->comm, &n, 1);
    EXPECT(n == n_reference);
    for (int b = 0; b < r->bodies.n; b++) {
        compare_sums(sim, &sim->facets.loads[b].work, &r->facets.loads[b].work);
        compare_sums(sim, &sim->facets.loads[b].wound, &r->facets.loads[b].wound);
    }
    compare_sums(sim, &sim->observe.totals[OBSERVE_WOUND], &r->wound);
    return n_reference;
}

/* -------------------------------------------------------------------------- random scenes */

struct text {
    char *bytes;
    size_t n, capacity;
};

static void say(struct text *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static void say(struct text *text, const char *format, ...)
{
    va_list arguments;
    ARRAY_GROW(text->bytes, text->n + 1024, text->capacity);
    va_start(arguments, format);
    text->n += (size_t)vsnprintf(text->bytes + text->n, 1024, format, arguments);
    va_end(arguments);
}

static const char *const material_names[] = {"ore", "rubber", "steel"};

/* Scenes of three materials have all that contacts can do. */
static void say_materials(struct text *text, double friction, bool full)
{
    static const char *const extras[] = {
        "", "rolling_friction: 0.1", "law: linear, stiffness: 3e4, twisting_friction: 0.05",
        "rolling_friction: 0.3, rolling: constant", "static_friction: 1.5"};

    say(text, "materials:\n"
              "  ore: {density: 2500, young: 2e7, poisson: 0.2}\n"
              "  rubber: {density: 1200, young: 5e6, poisson: 0.45}\n"
              "  steel: {density: 7800, young: 6e7, poisson: 0.3}\n"
              "contact:\n  pairs:\n");
    for (int a = 0; a < 3; a++) {
        for (int b = a; b < 3; b++)
            say(text, "    - {between: [%s, %s], friction: %g, restitution: %g%s%s}\n",
                material_names[a], material_names[b], friction + 0.1 * (a + b),
                0.9 - 0.15 * (a + b), full && a + b > 0 ? ", " : "", full ? extras[a + b] : "");
    }
}

/* What a scene is made of; lengths in m, times in s. */
struct scene {
    uint64_t seed;
    int n, n_materials;
    double half_width; /* spheres begin within it */
    double radius_min, radius_max;
    double speed, fast, spin; /* largest; every ninth sphere has `fast` */
    double inward;            /* speed towards the middle over distance [1/s] */
    double friction;
    const char *rest; /* of the job file */
    int n_steps;
};

static void say_sphere(struct text *text, const struct scene *scene,
                       struct cloud_random *random, const double *x, int i)
{
    const double speed = i % 9 == 4 ? scene->fast : scene->speed;
    double v[3], w[3], corner[3];
    for (int k = 0; k < 3; k++) {
        v[k] = cloud_between(random, -speed, speed) - scene->inward * x[k];
        w[k] = cloud_between(random, -scene->spin, scene->spin);
        corner[k] = x[k] - x[3];
    }
    say(text,
        "  - {name: s%d, material: %s, radius: %.17g, velocity: [%.17g, %.17g, %.17g], "
        "spin: [%.17g, %.17g, %.17g], packing: {kind: lattice, count: 1, spacing: %.17g, "
        "corner: [%.17g, %.17g, %.17g], size: [%.17g, %.17g]}}\n",
        i, material_names[i % scene->n_materials], x[3], v[0], v[1], v[2], w[0], w[1], w[2],
        2.0 * x[3], corner[0], corner[1], corner[2], 2.0 * x[3], 2.0 * x[3]);
}

/* The job of a scene, as text. */
static char *scene_text(const struct scene *scene)
{
    struct text text = {0};
    struct cloud_random random = {scene->seed};
    double(*placed)[4] = array_allocate((size_t)scene->n, sizeof *placed);
    say(&text, "time: {end: 1, step: 1e-5}\n");
    say_materials(&text, scene->friction, scene->n_materials == 3);
    say(&text, "%s\nspheres:\n", scene->rest);
    for (int i = 0; i < scene->n; i++) {
        cloud_place(&random, placed, i, scene->half_width,
                    i % 4 == 0 ? scene->radius_max : scene->radius_min, scene->radius_max);
        say_sphere(&text, scene, &random, placed[i], i);
    }
    free(placed);
    return text.bytes;
}

struct seen {
    int contacts, facets; /* most at a time */
    int64_t left;
};

static void read_job(struct job *job, const char *text)
{
    struct mistakes mistakes;
    mistakes_init(&mistakes);
    const bool is_read = job_read_text(job, "reference.yaml", text, &mistakes);
    if (!is_read)
        CHECK_FAIL("%d:%d: %s", mistakes.list[0].line, mistakes.list[0].column,
                   mistakes.list[0].text);
    mistakes_clear(&mistakes);
}

static struct seen compare_runs(const struct job *job, int n_steps)
{
    const struct comm comm = comm_world();
    struct simulation sim;
    struct reference reference;
    struct seen seen = {0};
    reference_start(&reference, job);
    simulation_create(&sim, &comm, job, ISA_AUTO);
    for (int n = 0; n < n_steps; n++) {
        step(&sim);
        reference_step(&reference);
        if (n % 50 != 0 && n + 1 < n_steps)
            continue;
        compare_spheres(&sim, &reference);
        const int contacts = compare_contacts(&sim, &reference);
        const int facets = compare_facets(&sim, &reference);
        seen.contacts = contacts > seen.contacts ? contacts : seen.contacts;
        seen.facets = facets > seen.facets ? facets : seen.facets;
    }
    seen.left = job->n_spheres - sim.n_spheres;
    EXPECT(sim.watch.failure == WATCH_FINE);
    simulation_destroy(&sim);
    reference_end(&reference);
    return seen;
}

static struct seen compare_scene(const struct scene *scene)
{
    char *text = scene_text(scene);
    struct job job;
    struct seen seen = {0};
    read_job(&job, text);
    free(text);
    if (check_failure[0] == '\0')
        seen = compare_runs(&job, scene->n_steps);
    job_clear(&job);
    return seen;
}

#define CALM "watch: {overlap: 1, motion: 1, energy: 0}\noutput: {series: {every: 0.001}}\n"
#define STAY "domain: {leavers: ignore}\n"
#define BOX                                                                                    \
    "  - {name: walls, material: steel, geometry: {kind: box, min: [-0.015, -0.015, -0.015], " \
    "max: [0.015, 0.015, 0.015]}}\n"

TEST(spheres_alone_that_meet_in_the_middle)
{
    const struct scene scene = {.seed = 1,
                                .n = 90,
                                .n_materials = 1,
                                .half_width = 0.01,
                                .radius_min = 1e-3,
                                .radius_max = 1e-3,
                                .speed = 0.5,
                                .fast = 2.0,
                                .spin = 500.0,
                                .inward = 200.0,
                                .friction = 0.5,
                                .rest = CALM STAY "gravity: [0, 0, 0]\norder_every: 110",
                                .n_steps = 350};
    const struct seen seen = compare_scene(&scene);
    EXPECT(seen.contacts > 10);
}

TEST(mixed_sizes_and_materials_between_walls)
{
    const struct scene scene = {
        .seed = 2,
        .n = 200,
        .n_materials = 3,
        .half_width = 0.0145,
        .radius_min = 0.6e-3,
        .radius_max = 3e-3,
        .speed = 1.0,
        .fast = 12.0,
        .spin = 1000.0,
        .friction = 0.3,
        .rest =
            CALM STAY "gravity: [200, -300, -900]\norder_every: 64\ndamping: 3\nbodies:\n" BOX,
        .n_steps = 300};
    const struct seen seen = compare_scene(&scene);
    EXPECT(seen.contacts > 50 && seen.facets > 10);
}

TEST(forced_redistribution_and_moving_bodies)
{
    const struct scene scene = {
        .seed = 3,
        .n = 80,
        .n_materials = 2,
        .half_width = 0.0145,
        .radius_min = 0.8e-3,
        .radius_max = 2.5e-3,
        .speed = 1.0,
        .fast = 6.0,
        .spin = 300.0,
        .friction = 10.0,
        .rest = CALM STAY
        "gravity: [0, 400, -900]\norder_every: 97\n"
        "testing: {redistribute_every: 13, repartition_every: 29, search_every: 7}\n"
        "bodies:\n" BOX "  - name: paddle\n    material: steel\n"
        "    geometry: {kind: plane, point: [0, 0, 0], normal: [1, 0, 0], extent: 0.02}\n"
        "    motion: {rotation: {point: [0, 0, 0], axis: [0, 0, 1], rate: 100}}\n"
        "  - name: press\n    material: rubber\n"
        "    geometry: {kind: plane, point: [0, 0, 0.0149], normal: [0, 0, -1], extent: 0.03}\n"
        "    motion: {velocity: [0, 0, -2], start: 0.0003, stop: 0.0025}",
        .n_steps = 350};
    const struct seen seen = compare_scene(&scene);
    EXPECT(seen.contacts > 10 && seen.facets > 10);
}

TEST(spheres_that_leave_while_they_touch)
{
    const struct scene scene = {
        .seed = 4,
        .n = 90,
        .n_materials = 3,
        .half_width = 0.01,
        .radius_min = 0.8e-3,
        .radius_max = 2e-3,
        .speed = 0.5,
        .fast = 4.0,
        .spin = 500.0,
        .inward = 300.0,
        .friction = 0.5,
        .rest = CALM "gravity: [900, 200, -100]\norder_every: 128\n"
                     "domain: {min: [-0.02, -0.02, -0.02], max: [0.0095, 0.02, 0.02], "
                     "leavers: remove}\n"
                     "testing: {repartition_every: 40}",
        .n_steps = 390};
    const struct seen seen = compare_scene(&scene);
    EXPECT(seen.contacts > 20 && seen.left > 20);
}

/* Slabs thinner than the large spheres, cut where the job says, without the ledger. */
TEST(thin_fixed_slabs_without_the_ledger)
{
    const struct comm comm = comm_world();
    char rest[512];
    (void)snprintf(rest, sizeof rest,
                   CALM "gravity: [0, 0, -900]\norder_every: 50\n"
                        "domain: {min: [-0.001, -0.05, -0.05], max: [0.0035, 0.05, 0.05], "
                        "leavers: ignore}\n"
                        "decomposition: {grid: [%d, 1, 1], buffer: 0.0004}\n"
                        "testing: {search_every: 11}\nbodies:\n" BOX,
                   comm.n_ranks);
    struct scene scene = {.seed = 5,
                          .n = 80,
                          .n_materials = 2,
                          .half_width = 0.0145,
                          .radius_min = 0.4e-3,
                          .radius_max = 5e-3,
                          .speed = 1.0,
                          .fast = 5.0,
                          .spin = 500.0,
                          .friction = 0.5,
                          .rest = rest,
                          .n_steps = 300};
    char *text = scene_text(&scene);
    struct job job;
    read_job(&job, text);
    free(text);
    job.energy_ledger = false;
    const struct seen seen = compare_runs(&job, scene.n_steps);
    EXPECT(seen.contacts > 20 && seen.facets > 10);
    job_clear(&job);
}

/* Nearly twice the largest diameter is the smallest period, walls stand across it, and some
 * spheres run round it several times. */
TEST(periodic_in_one_direction)
{
    const struct scene scene = {
        .seed = 6,
        .n = 70,
        .n_materials = 3,
        .half_width = 0.0095,
        .radius_min = 0.6e-3,
        .radius_max = 3.5e-3,
        .speed = 2.0,
        .fast = 30.0,
        .spin = 1000.0,
        .friction = 0.3,
        .rest = CALM "gravity: [300, -300, -900]\norder_every: 64\n"
                     "domain: {min: [-0.01, -1, -1], max: [0.01, 1, 1], periodic: x}\n"
                     "testing: {repartition_every: 40}\nbodies:\n"
                     "  - {name: tube, material: steel, geometry: {kind: box, open: [x_min, "
                     "x_max], min: [-0.02, -0.01, -0.01], max: [0.02, 0.01, 0.01]}}\n"
                     "  - {name: flap, material: rubber, geometry: {kind: plane, point: "
                     "[0.0097, 0, -0.009], normal: [0.3, 0, 1], extent: 0.012}}\n",
        .n_steps = 300};
    const struct seen seen = compare_scene(&scene);
    EXPECT(seen.contacts > 20 && seen.facets > 10);
}

TEST(periodic_in_all_directions)
{
    const struct scene scene = {
        .seed = 7,
        .n = 90,
        .n_materials = 3,
        .half_width = 0.0098,
        .radius_min = 1.2e-3,
        .radius_max = 3.9e-3,
        .speed = 2.0,
        .fast = 15.0,
        .spin = 1000.0,
        .friction = 0.9,
        .rest = CALM "gravity: [300, -30, -900]\norder_every: 97\ndamping: 2\n"
                     "domain: {min: [-0.0099, -0.01, -0.0099], max: [0.01, 0.01, 0.0099], "
                     "periodic: [x, y, z]}\n"
                     "testing: {redistribute_every: 13}\n",
        .n_steps = 300};
    const struct seen seen = compare_scene(&scene);
    EXPECT(seen.contacts > 30);
}

/* ------------------------------------------------------------------------ periodic gas */

enum { GAS = 60 };

/* Where everybody is within the domain, and how fast, on all ranks. */
struct gas {
    double place[GAS][3], velocity[GAS][3];
    struct vec3 momentum; /* [kg m/s] */
    double size;          /* sum of its terms' sizes [kg m/s] */
};

static void see_gas(const struct simulation *sim, struct gas *gas)
{
    struct exact_sum sums[4] = {{{0}, 0, 0}};
    for (int i = 0; i < GAS; i++)
        for (int k = 0; k < 3; k++)
            gas->place[i][k] = gas->velocity[i][k] = -1e300;
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        const int64_t id = sim->spheres.id[i];
        const struct vec3 x = sphere_place(&sim->spheres, i);
        const double *v = sphere_velocity(&sim->spheres, i);
        const double mass = 1.0 / sphere_inverse_mass(&sim->spheres, i);
        memcpy(gas->place[id], &x.x, sizeof gas->place[id]);
        memcpy(gas->velocity[id], v, sizeof gas->velocity[id]);
        for (int k = 0; k < 3; k++) {
            exact_sum_add(&sums[k], mass * v[k]);
            exact_sum_add(&sums[3], mass * fabs(v[k]));
        }
    }
    comm_max(sim->comm, &gas->place[0][0], 3 * GAS);
    comm_max(sim->comm, &gas->velocity[0][0], 3 * GAS);
    exact_sum_reduce(sim->comm, sums, 4);
    gas->momentum = (struct vec3){exact_sum_value(&sums[0]), exact_sum_value(&sums[1]),
                                  exact_sum_value(&sums[2])};
    gas->size = exact_sum_value(&sums[3]);
}

/* Spheres at places that are multiples of 2^-20, so that shifting them by such numbers is
 * exact. */
static void run_gas(struct vec3 shift, struct gas *start, struct gas *end)
{
    const struct comm comm = comm_world();
    struct cloud_random random = {8};
    struct text text = {0};
    struct simulation sim;
    struct job job;
    double placed[GAS][4];
    say(&text, "time: {end: 1, step: 1e-5}\n");
    say_materials(&text, 0.5, false);
    say(&text, "gravity: [0, 0, 0]\norder_every: 64\n" CALM
               "domain: {min: [-0.015625, -0.015625, -0.015625], max: [0.015625, 0.015625, "
               "0.015625], periodic: [x, y, z]}\nspheres:\n");
    for (int i = 0; i < GAS; i++) {
        const double by[3] = {shift.x, shift.y, shift.z};
        double corner[3], v[3], *s = placed[i];
        cloud_place(&random, placed, i, 0.0155, 1e-3, 2e-3);
        s[3] = floor(s[3] * 0x1p20) * 0x1p-20;
        for (int k = 0; k < 3; k++) {
            s[k] = floor(s[k] * 0x1p20) * 0x1p-20;
            corner[k] = s[k] - s[3] + by[k];
            v[k] = cloud_between(&random, -20.0, 20.0);
        }
        say(&text,
            "  - {name: s%d, material: ore, radius: %.17g, velocity: [%.17g, %.17g, %.17g], "
            "packing: {kind: lattice, count: 1, spacing: %.17g, corner: [%.17g, %.17g, %.17g], "
            "size: [%.17g, %.17g]}}\n",
            i, s[3], v[0], v[1], v[2], 2.0 * s[3], corner[0], corner[1], corner[2], 2.0 * s[3],
            2.0 * s[3]);
    }
    read_job(&job, text.bytes);
    free(text.bytes);
    simulation_create(&sim, &comm, &job, ISA_AUTO);
    see_gas(&sim, start);
    for (int n = 0; n < 600; n++)
        step(&sim);
    see_gas(&sim, end);
    EXPECT(sim.watch.failure == WATCH_FINE);
    simulation_destroy(&sim);
    job_clear(&job);
}

/* A gas that crosses the boundary everywhere keeps its momentum; moved as a whole, it does the
 * same elsewhere, to the last bit (few enough touch at a time that sums have two terms). */
TEST(a_periodic_gas_keeps_its_momentum_wherever_it_is)
{
    struct gas start, end, there_start, there_end;
    const struct vec3 none = {0.0, 0.0, 0.0}, shift = {0x1p-8, -0x1p-7, 3.0 * 0x1p-10};
    const double by[3] = {shift.x, shift.y, shift.z}, period = 0x1p-5;
    run_gas(none, &start, &end);
    run_gas(shift, &there_start, &there_end);
    const struct vec3 change = vec3_sub(end.momentum, start.momentum);
    EXPECT(vec3_norm(change) < 1e-13 * start.size);
    int n_turned = 0, n_apart = 0;
    for (int i = 0; i < GAS; i++) {
        n_turned += memcmp(start.velocity[i], end.velocity[i], sizeof start.velocity[i]) != 0;
        n_apart += memcmp(end.velocity[i], there_end.velocity[i], sizeof end.velocity[i]) != 0;
        for (int k = 0; k < 3; k++) {
            const double way = there_end.place[i][k] - by[k] - end.place[i][k];
            n_apart += way != 0.0 && way != period && way != -period;
        }
    }
    EXPECT(n_turned > GAS / 2 && n_apart == 0);
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    const int status = check_run(argc, argv);
    MPI_Finalize();
    return status;
}
