/*
 * The time step.  Places are those at n, velocities those at n - 1/2 when a step begins:
 *
 *   1 gravity; bodies where they are by now                       model/body.h
 *     now and then: spheres leave the run and come in             removal.h, insertion.h
 *   2 if stale: redistribute (both levels), global search         redistribute.h
 *   3 local search and contact laws of spheres with facets        contact/facet_contact.h
 *   4 contact laws of pairs of spheres, with history              contact/pair_kernel.h
 *     the spheres' force on bodies that forces move               forced.h
 *   5 now and then: contacts against the step; energies, forces   watch.h, observe.h
 *     on bodies, sections
 *   6 gravity, integration of owned spheres and bodies to n + 1   physics/integrate.h
 *   7 passages through sections, into regions that take out       sections.h, removal.h
 *   8 refresh of the ghosts                                       domain/halo.h
 *   9 the one reduction: motion against the buffer, overlap, signals, clock   watch.h
 */
#include "run/step.h"

#include <stdlib.h>

#include "base/array.h"
#include "base/timer.h"
#include "contact/facet_step.h"
#include "job/job.h"
#include "model/gravity.h"
#include "physics/integrate.h"
#include "run/redistribute.h"
#include "run/simulation.h"

/* Marks the spheres that leave the run; returns how many there are on all ranks. */
static int64_t mark_removed(struct simulation *sim, unsigned char *removed)
{
    int64_t n = 0;
    if (sim->removals.n > 0) {
        n = removals_mark(&sim->removals, &sim->spheres, (double)sim->step * sim->dt, removed);
        comm_sum_int(sim->comm, &n, 1);
    }
    if (sim->job->domain.leavers != JOB_LEAVERS_IGNORE)
        n += watch_leavers(&sim->watch, sim, removed);
    for (int i = 0; n > 0 && i < sim->spheres.n_owned; i++)
        if (removed[i])
            observe_removed(sim, i);
    return n;
}

/* Spheres leave the run and come into it: at steps that the job fixes, for it is part of the
 * result. */
static void exchange_spheres(struct simulation *sim)
{
    const bool takes = sim->step % REMOVAL_EVERY == 0 &&
                       (sim->removals.n > 0 || sim->job->domain.leavers != JOB_LEAVERS_IGNORE);
    unsigned char *removed = takes ? array_allocate((size_t)sim->spheres.n_owned, 1) : NULL;
    const int64_t n_removed = takes ? mark_removed(sim, removed) : 0;
    const int n_new = insertions_try(sim, removed);
    if (n_removed > 0 || n_new > 0) {
        sim->n_spheres += n_new - n_removed;
        redistribute(sim, n_removed > 0 ? removed : NULL);
    }
    free(removed);
}

_Static_assert((int)CONTACT_AHEAD >= (int)PAIR_KERNEL_AHEAD,
               "lists hold what kernels look ahead");

static void pair_forces(struct simulation *sim)
{
    struct contact_list *list = &sim->contacts.now;
    struct pair_kernel_work work = {
        .n_padded = list->n_padded,
        .first = list->first,
        .second = list->second,
        .motion = sim->spheres.motion,
        .spin = sim->spheres.spin,
        .force = sim->spheres.force,
        .material = sim->spheres.material,
        .n_materials = sim->materials.n,
        .pairs = sim->materials.pairs,
        .n_owned = sim->spheres.n_owned,
        .wound = &sim->observe.totals[OBSERVE_WOUND],
        .dt = sim->dt,
    };
    for (int l = 0; l < CONTACT_LANES; l++)
        work.history[l] = list->history[l];
    sim->kernel.apply(&work);
    sim->overlap_max = work.overlap_max;
}

static void integrate(struct simulation *sim, double spent[2], bool *bad)
{
    struct spheres *spheres = &sim->spheres;
    const struct vec3 g = sim->gravity;
    struct integrate_work work = {
        .n = spheres->n_owned,
        .motion = spheres->motion,
        .spin = spheres->spin,
        .force = spheres->force,
        .dissipated_friction = spheres->dissipated_friction,
        .dissipated_damping = spheres->dissipated_damping,
        .inverse_allowance = spheres->inverse_allowance,
        .dt = sim->dt,
        .gravity = {g.x, g.y, g.z},
        .damping = sim->job->damping,
        .ledger = sim->job->energy_ledger,
        .periodic = spheres->periodic.any,
    };
    for (int k = 0; k < 3; k++)
        work.snap[k] = spheres->periodic.snap[k];
    sim->integrate.apply(&work);
    for (int i = spheres->n_owned; i < spheres->n_all; i++)
        spheres->force[i] =
            (struct sphere_row){{0.0}}; /* what ghosts feel is their owner's business */
    spent[0] = work.spent[0];
    spent[1] = work.spent[1];
    *bad = work.bad;
}

static bool is_sampled(const struct simulation *sim)
{
    return sim->sample_every > 0 && sim->step % sim->sample_every == 0;
}

static bool is_balanced(const struct simulation *sim)
{
    return sim->step == 0 || sim->step % WATCH_ENERGY_EVERY == 0;
}

/* Contacts against the step; energies, forces on bodies and sections. */
static void observe(struct simulation *sim)
{
    struct runtime *runtime = &sim->runtime;
    watch_contacts(&sim->watch, sim);
    runtime_end(runtime, RUNTIME_WATCH);
    if (is_sampled(sim)) {
        const struct runtime_sizes sizes = simulation_sizes(sim);
        observe_sample(sim);
        watch_energy(&sim->watch, sim);
        runtime_end(runtime, RUNTIME_SAMPLE);
        runtime_row(runtime, sim->comm, sim->step, (double)sim->step * sim->dt, &sizes);
        runtime_begin(runtime);
    } else if (is_balanced(sim)) {
        observe_energy(sim);
        watch_energy(&sim->watch, sim);
        runtime_end(runtime, RUNTIME_SAMPLE);
    }
    capture_take(sim);
    runtime_end(runtime, RUNTIME_SAMPLE);
}

/* What changes with time alone, or was found in the step before. */
static void begin(struct simulation *sim)
{
    bodies_place(&sim->bodies, sim->step, sim->dt);
    forced_begin(sim);
    sim->deform.failed = false;
    touch_begin(sim);
    observe_gone(sim);
    if (!sim->gravity_varies)
        return;
    const double before = (double)(sim->step > 0 ? sim->step - 1 : 0) * sim->dt;
    sim->gravity = gravity_at(sim->job, (double)sim->step * sim->dt);
    sim->gravity_change = vec3_sub(sim->gravity, gravity_at(sim->job, before));
    observe_gravity(sim);
}

void step_forces(struct simulation *sim)
{
    struct runtime *runtime = &sim->runtime;
    runtime_begin(runtime);
    begin(sim);
    runtime_end(runtime, RUNTIME_BODIES);
    exchange_spheres(sim);
    if (redistribute_is_due(sim))
        redistribute(sim, NULL);
    else if (redistribute_inner_is_due(sim))
        redistribute_inner(sim);
    if (is_sampled(sim) || is_balanced(sim))
        observe_before(sim);
    runtime_begin(runtime);
    const double began = timer_now();
    facet_step_apply(&sim->facets, &sim->spheres, &sim->bodies, &sim->materials, sim->dt,
                     sim->job->energy_ledger);
    touch_apply(sim);
    runtime_end(runtime, RUNTIME_FACETS);
    pair_forces(sim);
    runtime_end(runtime, RUNTIME_PAIRS);
    local_damping_apply(sim);
    sim->balance.busy += timer_now() - began;
    forced_plan(sim);
    runtime_end(runtime, RUNTIME_BODIES);
    deform_plan(sim);
    runtime_end(runtime, RUNTIME_SOLIDS);
    observe(sim);
}

void step(struct simulation *sim)
{
    struct runtime *runtime = &sim->runtime;
    double spent[2];
    bool bad;
    step_forces(sim);
    integrate(sim, spent, &bad);
    forced_move(sim);
    runtime_end(runtime, RUNTIME_INTEGRATE);
    touch_end(sim);
    deform_move(sim);
    runtime_end(runtime, RUNTIME_SOLIDS);
    sim->step++;
    sections_pass(&sim->sections, &sim->spheres);
    removals_catch(&sim->removals, &sim->spheres, (double)sim->step * sim->dt, sim->dt);
    runtime_end(runtime, RUNTIME_INTEGRATE);
    halo_refresh(&sim->halo, sim->comm, &sim->spheres);
    runtime_end(runtime, RUNTIME_HALO);
    watch_agree(&sim->watch, sim, spent, bad);
    watch_forced(&sim->watch, sim);
    observe_overlap(sim, sim->watch.overlap);
    redistribute_spend(sim, spent);
    sim->facets.moved += spent[0];
    runtime->particle_steps += sim->n_spheres;
    runtime_end(runtime, RUNTIME_WATCH);
}
