/* See watch.h. */
#include "run/watch.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "base/timer.h"
#include "job/job.h"
#include "run/control.h"
#include "run/simulation.h"

void watch_init(struct watch *watch, double checkpoint_every)
{
    *watch = (struct watch){.checkpoint_every = checkpoint_every,
                            .checkpoint_at = timer_now() + checkpoint_every};
}

/* The first failure stands. */
static void fail(struct watch *watch, enum watch_failure failure)
{
    if (watch->failure == WATCH_FINE)
        watch->failure = failure;
}

void watch_agree(struct watch *watch, struct simulation *sim, double spent[2], bool bad)
{
    enum { SPENT_SEARCH, SPENT_INNER, OVERLAP, BAD, STOP, CHECKPOINT, N_VALUES };
    const double pairs = sim->overlap_max, facets = sim->facets.overlap_max;
    const bool due = sim->comm->rank == 0 && watch->checkpoint_every > 0.0 &&
                     timer_now() > watch->checkpoint_at;
    double values[N_VALUES] = {spent[0],
                               spent[1],
                               pairs > facets ? pairs : facets,
                               bad ? 1.0 : 0.0,
                               watch->stop_asked || control_asked() != 0 ? 1.0 : 0.0,
                               due ? 1.0 : 0.0};
    comm_max(sim->comm, values, N_VALUES);
    spent[0] = values[SPENT_SEARCH];
    spent[1] = values[SPENT_INNER];
    watch->overlap = values[OVERLAP];
    watch->stop_agreed = watch->stop_agreed || values[STOP] > 0.0;
    watch->checkpoint_due = watch->checkpoint_due || values[CHECKPOINT] > 0.0;
    if (values[BAD] > 0.0 || !(spent[0] >= 0.0) || !(watch->overlap >= 0.0))
        fail(watch, WATCH_NOT_A_NUMBER);
    if (!(watch->overlap <= sim->job->watch.overlap))
        fail(watch, WATCH_OVERLAP);
}

void watch_motion(struct watch *watch, const struct simulation *sim)
{
    const struct spheres *spheres = &sim->spheres;
    double most = 0.0, radius_least = 1e300;
    int worst = -1;
    for (int i = 0; i < spheres->n_owned; i++) {
        const double *v = sphere_velocity(spheres, i), radius = sphere_radius(spheres, i);
        const double motion = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * sim->dt / radius;
        radius_least = radius < radius_least ? radius : radius_least;
        if (motion > most) {
            most = motion;
            worst = i;
        }
    }
    double body_most = 0.0;
    int body_worst = -1;
    for (int b = 0; b < sim->bodies.n; b++) {
        if (sim->bodies.list[b].speed_max * sim->dt > body_most) {
            body_most = sim->bodies.list[b].speed_max * sim->dt;
            body_worst = b;
        }
    }
    comm_min(sim->comm, &radius_least, 1);
    double largest[2] = {most, body_most / radius_least};
    comm_max(sim->comm, largest, 2);
    if (largest[0] <= sim->job->watch.motion && largest[1] <= sim->job->watch.motion)
        return;
    if (watch->failure != WATCH_FINE)
        return; /* `what` is about that */
    fail(watch, WATCH_MOTION);
    if (largest[1] > sim->job->watch.motion && body_worst >= 0)
        snprintf(watch->what, sizeof watch->what,
                 "body '%.60s' moves %.3g of the least radius in a step",
                 sim->bodies.list[body_worst].name, largest[1]);
    else if (worst >= 0 && most >= largest[0])
        snprintf(watch->what, sizeof watch->what,
                 "sphere %lld moves %.3g of its radius in a step",
                 (long long)spheres->id[worst], most);
}

void watch_energy(struct watch *watch, const struct simulation *sim)
{
    const double limit = sim->job->watch.energy;
    if (sim->job->energy_ledger && sim->observe.energy_error != sim->observe.energy_error)
        fail(watch, WATCH_SUMS);
    if (limit > 0.0 && !(sim->observe.energy_error <= limit))
        fail(watch, WATCH_ENERGY);
}

static bool is_outside(const struct job *job, const double *x)
{
    const struct vec3 low = job->domain.min, high = job->domain.max;
    return !(x[0] >= low.x && x[1] >= low.y && x[2] >= low.z && x[0] <= high.x &&
             x[1] <= high.y && x[2] <= high.z);
}

int watch_leavers(struct watch *watch, struct simulation *sim, unsigned char *removed)
{
    int64_t n = 0;
    int first = -1;
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        removed[i] = is_outside(sim->job, sphere_position(&sim->spheres, i));
        n += removed[i];
        first = removed[i] && first < 0 ? i : first;
    }
    if (first >= 0) {
        const double *x = sphere_position(&sim->spheres, first);
        snprintf(watch->what, sizeof watch->what, "sphere %lld is at (%.4g, %.4g, %.4g) m",
                 (long long)sim->spheres.id[first], x[0], x[1], x[2]);
    }
    comm_sum_int(sim->comm, &n, 1);
    if (n > 0 && sim->job->domain.leavers == JOB_LEAVERS_STOP) {
        fail(watch, WATCH_LEAVER);
        return 0;
    }
    watch->what[0] = '\0';
    return (int)n;
}

/* --------------------------------------------------------------------------------------
 * diagnosis */

static void find_bad(const struct simulation *sim, char *what, size_t size)
{
    for (int i = 0; i < sim->spheres.n_owned && what[0] == '\0'; i++) {
        const double *motion = sim->spheres.motion[i].lane, *spin = sim->spheres.spin[i].lane;
        double sum = 0.0;
        for (int k = 0; k < 8; k++)
            sum += motion[k] + spin[k];
        if (!(sum - sum == 0.0))
            snprintf(what, size, "sphere %lld", (long long)sim->spheres.id[i]);
    }
}

/* The deepest contact here, when it is the one that all ranks found. */
static void find_overlap(const struct simulation *sim, double overlap, char *what, size_t size)
{
    const struct contact_list *list = &sim->contacts.now;
    double deepest = 0.0;
    for (int k = 0; k < list->n; k++) {
        const double *a = sim->spheres.motion[list->first[k]].lane,
                     *b = sim->spheres.motion[list->second[k]].lane;
        const double dx = b[0] - a[0], dy = b[1] - a[1], dz = b[2] - a[2];
        const double depth =
            (a[3] + b[3] - sqrt(dx * dx + dy * dy + dz * dz)) * 0.5 * (1.0 / a[3] + 1.0 / b[3]);
        if (depth > deepest && depth > 0.5 * overlap) {
            deepest = depth;
            snprintf(what, size, "spheres %lld and %lld near (%.4g, %.4g, %.4g) m",
                     (long long)sim->spheres.id[list->first[k]],
                     (long long)sim->spheres.id[list->second[k]], a[0], a[1], a[2]);
        }
    }
    if (deepest == 0.0 && sim->facets.overlap_max >= overlap)
        snprintf(what, size, "a sphere and a body");
}

/* The first rank's words that has any, on all ranks. */
static void tell_all(const struct comm *comm, char *what, size_t size)
{
    char *all = array_allocate((size_t)comm->n_ranks, size);
    comm_gather_all(comm, what, all, size);
    for (int q = comm->n_ranks - 1; q >= 0; q--) {
        if (all[(size_t)q * size] != '\0')
            memcpy(what, all + (size_t)q * size, size);
    }
    free(all);
}

void watch_explain(const struct watch *watch, const struct simulation *sim)
{
    struct watch own = *watch;
    if (watch->failure == WATCH_NOT_A_NUMBER)
        find_bad(sim, own.what, sizeof own.what);
    if (watch->failure == WATCH_OVERLAP)
        find_overlap(sim, watch->overlap, own.what, sizeof own.what);
    tell_all(sim->comm, own.what, sizeof own.what);
    const double time = (double)sim->step * sim->dt;
    const long long step = (long long)sim->step;
    switch (watch->failure) {
    case WATCH_NOT_A_NUMBER:
        report_error(
            "not a number at step %lld (%.6g s): %s has no place or velocity any more; use a "
            "smaller "
            "time.step, or look for overlapping spheres at the start",
            step, time, own.what);
        break;
    case WATCH_OVERLAP:
        report_error(
            "overlap at step %lld (%.6g s): %s overlap by %.3g of a radius, more than "
            "watch.overlap = "
            "%.3g; use a larger young, a smaller time.step or lower speeds, or separate what "
            "overlaps at "
            "the start",
            step, time, own.what, watch->overlap, sim->job->watch.overlap);
        break;
    case WATCH_MOTION:
        report_error(
            "motion too fast at step %lld (%.6g s): %s, more than watch.motion = %.3g, so "
            "contacts could "
            "be missed; use a smaller time.step or lower speeds",
            step, time, own.what, sim->job->watch.motion);
        break;
    case WATCH_LEAVER:
        report_error(
            "sphere left the domain at step %lld (%.6g s): %s; close the bodies, enlarge "
            "domain.min and "
            "domain.max, or set domain.leavers to remove or ignore",
            step, time, own.what);
        break;
    case WATCH_ENERGY:
        report_error(
            "energy balance at step %lld (%.6g s): off by %.3g of the energy turned over, "
            "more than "
            "watch.energy = %.3g; use a smaller time.step",
            step, time, sim->observe.energy_error, sim->job->watch.energy);
        break;
    case WATCH_SUMS:
        report_error(
            "a force or energy at step %lld (%.6g s) is beyond 1e18; check the units of the "
            "job",
            step, time);
        break;
    case WATCH_FINE:
    default:
        break;
    }
}
