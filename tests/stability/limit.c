/* See limit.h. */
#include "limit.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "physics/critical_step.h"
#include "run/check.h"
#include "run/simulation.h"
#include "run/step.h"
#include "store/run_folder.h"

enum { TRIAL_STEPS = 6000, GROWN = 100000 };

/* What trials share. */
struct rest {
    const struct comm *comm;
    struct job job;
    char folder[64], *checkpoint;
    enum limit_push push;
    double speed; /* of the pushes [m/s] */
};

static void read_job(struct job *job, const char *yaml, double end, const char *step)
{
    struct mistakes mistakes;
    char *text = array_format("time: {end: %.17g, step: %s}\n%s", end, step, yaml);
    mistakes_init(&mistakes);
    if (!job_read_text(job, "stability.yaml", text, &mistakes) ||
        !check_complete(job, 1, &mistakes)) {
        mistakes_print(&mistakes);
        CHECK(false, "the job is not valid");
    }
    mistakes_clear(&mistakes);
    free(text);
}

static double automatic_step(const char *yaml)
{
    struct job job;
    read_job(&job, yaml, 1.0, "auto");
    const double step = job.time.step;
    job_clear(&job);
    return step;
}

static double kinetic_energy(const struct simulation *sim)
{
    double sum = 0.0;
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        const double *v = sphere_velocity(&sim->spheres, i),
                     r = sphere_radius(&sim->spheres, i);
        const double *w = sphere_angular_velocity(&sim->spheres, i);
        const double v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        const double w2 = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
        sum += 0.5 / sphere_inverse_mass(&sim->spheres, i) * (v2 + 0.4 * r * r * w2);
    }
    return sum;
}

/* Contacts a sphere, and their mean overlap over the radius. */
static void look_at_contacts(const struct simulation *sim, struct limit *limit)
{
    const struct contact_list *list = &sim->contacts.now;
    double n = 0.0, sum = 0.0, ends = 0.0;
    for (int k = 0; k < list->n; k++) {
        if (!contact_touches(list, k))
            continue;
        const int i = list->first[k], j = list->second[k];
        const double *a = sphere_position(&sim->spheres, i),
                     *b = sphere_position(&sim->spheres, j);
        const double x[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
        const double radii = sphere_radius(&sim->spheres, i) + sphere_radius(&sim->spheres, j);
        n += 1.0;
        ends += 2.0;
        sum += 2.0 * (1.0 - sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) / radii);
    }
    for (int k = 0; k < sim->facets.n; k++) {
        const struct facet_contact *contact = &sim->facets.list[k];
        n += contact->overlap > 0.0;
        ends += contact->overlap > 0.0;
        sum += contact->overlap * sphere_curvature(&sim->spheres, contact->sphere);
    }
    limit->partners = ends / sim->spheres.n_owned;
    limit->overlap_mean = sum / n;
}

static void run_steps(struct simulation *sim, int n_steps)
{
    for (int n = 0; n < n_steps; n++)
        step(sim);
}

/* Is what motion is left small beside the pushes? */
static bool is_at_rest(const struct simulation *sim, const struct rest *rest)
{
    double mass = 0.0;
    for (int i = 0; i < sim->spheres.n_owned; i++)
        mass += 1.0 / sphere_inverse_mass(&sim->spheres, i);
    return kinetic_energy(sim) < 1e-4 * 0.5 * mass * rest->speed * rest->speed;
}

/* Brings the scene to rest, saves it and notes what its contacts allow. */
static struct limit come_to_rest(struct rest *rest, int n_steps)
{
    struct simulation sim;
    struct limit limit = {.rayleigh = 1e300};
    const struct run_folder folder = {.path = rest->folder};
    simulation_create(&sim, rest->comm, &rest->job, ISA_AUTO);
    run_steps(&sim, n_steps);
    rest->job.damping *= 3.0; /* what has fallen comes to rest */
    do {
        run_steps(&sim, n_steps);
        look_at_contacts(&sim, &limit);
        limit.bound = watch_critical_step(&sim);
        rest->speed = 1e-4 * limit.overlap_mean * sphere_radius(&sim.spheres, 0) / limit.bound;
    } while (sim.step < 20 * (int64_t)n_steps && !is_at_rest(&sim, rest));
    CHECK(sim.watch.failure == WATCH_FINE, "the scene fails on its way to rest");
    for (int i = 0; i < sim.spheres.n_owned; i++) {
        const struct job_material *m = &rest->job.materials[sim.spheres.material[i]];
        const double rayleigh = critical_step_rayleigh(sphere_radius(&sim.spheres, i),
                                                       m->density, m->young, m->poisson);
        limit.rayleigh = rayleigh < limit.rayleigh ? rayleigh : limit.rayleigh;
    }
    char *path = array_format("%s/checkpoints", rest->folder);
    CHECK(mkdir(path, 0700) == 0, "cannot make %s", path);
    free(path);
    path = array_format("%s/series", rest->folder);
    CHECK(mkdir(path, 0700) == 0, "cannot make %s", path);
    free(path);
    CHECK(simulation_save(&sim, &folder, "") == REPORT_FINISHED, "cannot save the scene");
    rest->checkpoint = run_folder_checkpoint_path(&folder, sim.step);
    simulation_destroy(&sim);
    return limit;
}

/* A little motion in the directions asked for, different for each sphere. */
static void push_spheres(struct simulation *sim, const struct rest *rest)
{
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        double *v = sphere_velocity(&sim->spheres, i);
        double *w = sphere_angular_velocity(&sim->spheres, i);
        double *spin = sim->spheres.spin[i].lane; /* w, and R w */
        const double radius = sphere_radius(&sim->spheres, i);
        for (int k = 0; k < 3; k++)
            v[k] = w[k] = spin[k] = 0.0;
        for (int k = 0; k < 3; k++) {
            const double noise = rest->speed * sin(1.0 + 7.3 * i + 2.1 * k);
            const bool along = rest->push == LIMIT_PUSH_ALL ||
                               (k == 0 && rest->push != LIMIT_PUSH_Z) ||
                               (k == 2 && rest->push == LIMIT_PUSH_Z);
            const bool about =
                rest->push == LIMIT_PUSH_ALL || (k == 1 && rest->push == LIMIT_PUSH_SPIN);
            v[k] = along ? noise : 0.0;
            spin[k] = about ? -1.7 * noise : 0.0;
            w[k] = spin[k] / radius;
        }
    }
}

static bool is_stable(struct rest *rest, double dt)
{
    struct simulation sim;
    rest->job.time.step = dt;
    CHECK(simulation_restart(&sim, rest->comm, &rest->job, ISA_AUTO, rest->checkpoint) ==
              REPORT_FINISHED,
          "cannot restart");
    push_spheres(&sim, rest);
    const double start = kinetic_energy(&sim);
    bool stable = true;
    for (int n = 0; n < TRIAL_STEPS && stable; n++) {
        step(&sim);
        stable = sim.watch.failure == WATCH_FINE &&
                 (n % 16 != 0 || kinetic_energy(&sim) < GROWN * start);
    }
    simulation_destroy(&sim);
    return stable;
}

/* Removes a folder of files, `below` another. */
static void remove_folder(const char *above, const char *below)
{
    char *folder = array_format("%s%s", above, below);
    DIR *entries = opendir(folder);
    CHECK(entries != NULL, "cannot open %s", folder);
    for (const struct dirent *entry; (entry = readdir(entries)) != NULL;) {
        char *path = array_format("%s/%s", folder, entry->d_name);
        unlink(path); /* but for . and .. */
        free(path);
    }
    closedir(entries);
    CHECK(rmdir(folder) == 0, "cannot remove %s", folder);
    free(folder);
}

struct limit limit_find(const char *yaml, double dt, int n_steps, enum limit_push push)
{
    const struct comm comm = comm_world();
    const char *scratch = getenv("SCRATCH");
    struct rest rest = {.comm = &comm, .push = push};
    char first[32];
    snprintf(first, sizeof first, "%.17g", dt);
    read_job(&rest.job, yaml, 1e12 * dt, first);
    snprintf(rest.folder, sizeof rest.folder, "%.40s/limit-XXXXXX",
             scratch != NULL ? scratch : "/tmp");
    CHECK(mkdtemp(rest.folder) != NULL, "cannot make %s", rest.folder);
    struct limit limit = come_to_rest(&rest, n_steps);
    limit.automatic = automatic_step(yaml);
    rest.job.damping = 0.0;
    double low = 0.2 * limit.bound, high = 5.0 * limit.bound;
    CHECK(is_stable(&rest, low), "the scene moves by itself, or fails far below the bound");
    CHECK(!is_stable(&rest, high), "the scene bears five times the bound");
    while (high > 1.002 * low) {
        const double middle = sqrt(low * high);
        if (is_stable(&rest, middle))
            low = middle;
        else
            high = middle;
    }
    limit.step = sqrt(low * high);
    free(rest.checkpoint);
    remove_folder(rest.folder, "/checkpoints");
    remove_folder(rest.folder, "/series");
    remove_folder(rest.folder, "");
    job_clear(&rest.job);
    return limit;
}
