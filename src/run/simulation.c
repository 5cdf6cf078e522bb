/* See simulation.h.  A new scene and a checkpoint differ only in where the spheres come from:
 * either way each rank begins with a slice of the ids, and the first redistribution sends them
 * to their owners. */
#include "run/simulation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/process.h"
#include "base/report.h"
#include "job/job.h"
#include "model/gravity.h"
#include "model/order.h"
#include "model/packings.h"
#include "run/chain.h"
#include "run/deform_state.h"
#include "run/redistribute.h"
#include "store/body_notes.h"
#include "store/checkpoint.h"
#include "store/run_folder.h"
#include "store/sphere_file.h"

int64_t simulation_steps(double time, double step)
{
    const double n = time / step, most = 1e15;
    return (int64_t)((n < most ? n : most) + 0.5);
}

/* Largest, and minus the least, material so far. */
static void add_material(int64_t extremes[2], int64_t material)
{
    extremes[0] = material > extremes[0] ? material : extremes[0];
    extremes[1] = -material > extremes[1] ? -material : extremes[1];
}

/* Of all spheres that are here or will come in. */
static bool one_material(const struct simulation *sim)
{
    int64_t extremes[2] = {-1, -1000000};
    for (int i = 0; i < sim->spheres.n_owned; i++)
        add_material(extremes, sim->spheres.material[i]);
    for (int k = 0; k < sim->job->n_insertions; k++) {
        const struct job_insertion *insertion = &sim->job->insertions[k];
        if (insertion->n_mix == 0)
            add_material(extremes, insertion->material);
        for (int m = 0; m < insertion->n_mix; m++)
            add_material(extremes, insertion->mix[m].material);
    }
    comm_max_int(sim->comm, extremes, 2);
    return extremes[0] == -extremes[1];
}

/* Half of the buffer zone's width: by default half of the mean radius is the width (the
 * paper's). */
static double choose_half_buffer(const struct simulation *sim)
{
    if (sim->job->decomposition.buffer > 0.0)
        return 0.5 * sim->job->decomposition.buffer;
    struct exact_sum sums[2] = {{{0}, 0, 0}};
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        exact_sum_add(&sums[0], sphere_radius(&sim->spheres, i));
        exact_sum_add(&sums[1], 1.0);
    }
    exact_sum_reduce(sim->comm, sums, 2);
    double radius = exact_sum_value(&sums[0]), n = exact_sum_value(&sums[1]);
    for (int k = 0; k < sim->insertions.n && sim->n_spheres == 0; k++) {
        const struct sizes *sizes = &sim->insertions.list[k].sizes;
        radius += 0.5 * (sizes->min + sizes->max);
        n += 1.0;
    }
    if (n > 0.0)
        return 0.25 * radius / n;
    return sim->touch.n_balls > 0 ? sim->touch.buffer : 1.0;
}

/* All that does not depend on where the spheres come from. */
static void begin(struct simulation *sim, const struct comm *comm, const struct job *job,
                  enum isa isa)
{
    *sim = (struct simulation){.comm = comm, .job = job};
    sim->dt = job->time.step;
    sim->n_steps = simulation_steps(job->time.end, sim->dt);
    sim->sample_every = simulation_steps(job->output.series_every, sim->dt);
    if (job->output.series_every > 0.0 && sim->sample_every == 0)
        sim->sample_every = 1;
    materials_build(&sim->materials, job);
    bodies_build(&sim->bodies, job);
    sim->gravity = gravity_at(job, 0.0);
    sim->gravity_varies = gravity_varies(job);
    forced_init(&sim->forced, sim);
    deform_init(&sim->deform, sim, isa);
    probes_init(&sim->probes, sim);
    touch_init(&sim->touch, sim, isa);
    local_damping_init(&sim->local_damping, sim);
    spheres_init(&sim->spheres);
    periodic_init(&sim->spheres.periodic, job);
    facet_contacts_init(&sim->facets, sim->bodies.n, isa);
    sim->facets.moved = 0.0;
    contact_set_init(&sim->contacts, sim->materials.full, job->energy_ledger);
    sim->body_allowance = array_allocate((size_t)sim->bodies.n, sizeof *sim->body_allowance);
    boxes_init(&sim->boxes, comm->n_ranks);
    halo_init(&sim->halo, comm);
    migrate_init(&sim->migrate, comm);
    sections_init(&sim->sections, job);
    contents_init(&sim->contents, job, &sim->bodies);
    insertions_init(&sim->insertions, job, &sim->bodies);
    removals_init(&sim->removals, job, &sim->bodies);
    observe_init(&sim->observe, sim);
    capture_init(&sim->capture, sim);
    watch_init(&sim->watch, job);
}

/* A file that spheres have come from and contacts between them are still to come from. */
struct origin {
    const char *path;
    const struct checkpoint *checkpoint;
    const struct chain *chain; /* where it is of another job, else NULL */
};

struct arrival {
    struct simulation *sim;
    const struct chain *chain;
    int n_strange; /* contacts of spheres that are far apart */
};

static void take_contacts(void *into, int n, struct contact_record *records)
{
    struct arrival *arrival = into;
    if (arrival->chain != NULL)
        n = chain_renew_contacts(arrival->chain, arrival->sim, n, records);
    arrival->n_strange += redistribute_restore(arrival->sim, n, records);
}

/* Now that lists are there, so that all records need not be. */
static int restore_contacts(struct simulation *sim, const struct origin *origin)
{
    struct arrival arrival = {.sim = sim, .chain = origin->chain};
    const int status = checkpoint_read_contacts(sim->comm, origin->path, origin->checkpoint,
                                                take_contacts, &arrival);
    if (status != REPORT_FINISHED || comm_agree(sim->comm, arrival.n_strange > 0) == 0)
        return status;
    report_error("cannot use the checkpoint %s: it has contacts of spheres that are far apart",
                 origin->path);
    return REPORT_STORAGE;
}

/* Spheres are here in some order: complete them, choose kernels, distribute and search.
 * `origin` is NULL where they come from no file.  Returns a REPORT_ status, the reason said. */
static int finish(struct simulation *sim, enum isa isa, const struct origin *origin)
{
    for (int i = 0; i < sim->spheres.n_owned; i++)
        sphere_complete(&sim->spheres, i, &sim->materials);
    sim->n_spheres = sim->spheres.n_owned;
    comm_sum_int(sim->comm, &sim->n_spheres, 1);
    sim->kernel = pair_kernel_choose(isa, one_material(sim), sim->materials.full,
                                     sim->job->energy_ledger);
    sim->integrate = integrate_choose(isa);
    sim->half_buffer = choose_half_buffer(sim);
    runtime_init(&sim->runtime, sim->step);
    bodies_place(&sim->bodies, sim->step, sim->dt);
    deform_place(sim);
    redistribute_first(sim);
    const int status = origin != NULL ? restore_contacts(sim, origin) : REPORT_FINISHED;
    migrate_forget(&sim->migrate);
    watch_bodies(&sim->watch, sim);
    watch_elements(&sim->watch, sim);
    runtime_begin(&sim->runtime);
    return status;
}

void simulation_set_sphere(struct simulation *sim, int i, int64_t id, int group,
                           const struct packing_sphere *new)
{
    struct spheres *spheres = &sim->spheres;
    const struct vec3 x = periodic_settled(&spheres->periodic, new->position);
    spheres->motion[i] = (struct sphere_row){{x.x, x.y, x.z, new->radius, new->velocity.x,
                                              new->velocity.y, new->velocity.z, new->radius}};
    spheres->spin[i] =
        (struct sphere_row){{0.0, 0.0, 0.0, 0.0, new->angular_velocity.x,
                             new->angular_velocity.y, new->angular_velocity.z, 0.0}};
    spheres->force[i] = (struct sphere_row){{0.0}};
    spheres->id[i] = id;
    spheres->material[i] = new->material;
    spheres->group[i] = group;
    spheres->dissipated_friction[i] = 0.0;
    spheres->dissipated_damping[i] = 0.0;
    spheres->caught[i] = 0;
    sections_begin(&sim->sections, spheres, i);
}

/* Is there room in memory for so many spheres of this rank?  Said before any is taken: more
 * than there is would be given, and the process be killed when it uses it.  Collective. */
static int check_memory(const struct simulation *sim, int64_t n_here)
{
    static const double LEAST = 0.15; /* of SIMULATION_BYTES_A_SPHERE: rows and nothing else */
    const double there = process_memory() / comm_ranks_here(sim->comm);
    double share = (double)n_here * SIMULATION_BYTES_A_SPHERE / there;
    comm_max(sim->comm, &share, 1);
    if (share * LEAST > 1.0) {
        report_error("the spheres need some %.2g times the memory that this machine has for %d "
                     "ranks; use more machines, or fewer spheres",
                     share, sim->comm->n_ranks);
        return REPORT_STORAGE;
    }
    if (share > 1.0)
        report_warn("the spheres may need some %.2g times the memory that this machine has",
                    share);
    return REPORT_FINISHED;
}

/* The groups' spheres, random ones clear of those there `before`: of each, this rank begins
 * with a slice. */
static int add_groups(struct simulation *sim, const struct packing *before)
{
    const int64_t rank = sim->comm->rank, n_ranks = sim->comm->n_ranks;
    struct packings packings;
    struct mistakes mistakes;
    mistakes_init(&mistakes);
    CHECK(packings_open(&packings, sim->job, &sim->bodies, before, sphere_file_read, &mistakes),
          "a packing was there and has gone: %s", mistakes.list[0].text);
    mistakes_clear(&mistakes);
    int64_t n_here = sim->spheres.n_owned;
    for (int g = 0; g < packings.n; g++)
        n_here +=
            packings.groups[g].n * (rank + 1) / n_ranks - packings.groups[g].n * rank / n_ranks;
    const int status = check_memory(sim, n_here);
    if (status == REPORT_FINISHED)
        spheres_reserve(&sim->spheres, (int)n_here);
    for (int g = 0; g < packings.n && status == REPORT_FINISHED; g++) {
        const int64_t n = packings.groups[g].n;
        for (int64_t k = n * rank / n_ranks; k < n * (rank + 1) / n_ranks; k++) {
            const struct packing_sphere sphere = packing_get(&packings.groups[g], k);
            const int i = sim->spheres.n_owned++;
            simulation_set_sphere(sim, i, sim->next_id + k, g, &sphere);
        }
        sim->next_id += n;
    }
    packings_close(&packings);
    return status;
}

/* Opens the state that the job starts from, if it does from one. */
static bool open_chain(struct chain *chain, const struct job *job)
{
    struct mistakes mistakes;
    mistakes_init(&mistakes);
    *chain = (struct chain){.path = NULL};
    const bool fine = !job->start.given || chain_open(chain, job, &mistakes);
    mistakes_print(&mistakes);
    mistakes_clear(&mistakes);
    return fine;
}

int simulation_create(struct simulation *sim, const struct comm *comm, const struct job *job,
                      enum isa isa)
{
    struct chain chain;
    int status = comm_agree(comm, open_chain(&chain, job) ? REPORT_FINISHED : REPORT_BAD_INPUT);
    if (status != REPORT_FINISHED) {
        chain_close(&chain);
        return status;
    }
    begin(sim, comm, job, isa);
    struct checkpoint checkpoint = {.spheres = &sim->spheres};
    const struct origin origin = {chain.path, &checkpoint, &chain};
    if (job->start.given)
        status = chain_begin(&chain, sim, &checkpoint);
    if (status == REPORT_FINISHED)
        status = add_groups(sim, &chain.packing);
    if (status == REPORT_FINISHED) {
        sim->spheres.n_all = sim->spheres.n_owned;
        order_renew(&sim->spheres, comm);
        status = finish(sim, isa, job->start.given ? &origin : NULL);
    }
    checkpoint_clear(&checkpoint);
    chain_close(&chain);
    if (status == REPORT_FINISHED)
        observe_taken_over(sim);
    else
        simulation_destroy(sim);
    return status;
}

/* Totals from the file: rank 0 holds them, the others hold nothing yet. */
static int restore_monitors(struct simulation *sim, const struct checkpoint *checkpoint)
{
    struct observe_monitor *monitors;
    const int n = observe_monitors(sim, &monitors);
    int status = REPORT_FINISHED;
    for (int m = 0; m < n; m++) {
        int found = -1;
        for (int c = 0; c < checkpoint->n_monitors; c++)
            found = strcmp(checkpoint->monitors[c].name, monitors[m].name) == 0 ? c : found;
        if (found >= 0)
            *monitors[m].sum = checkpoint->monitors[found].sum;
        else
            status = REPORT_STORAGE;
    }
    free(monitors);
    return status;
}

/* Features of a body that spheres touch. */
static int n_touched(const struct simulation *sim, int b)
{
    const struct body *body = &sim->bodies.list[b];
    return body->skin != NULL ? body->mesh.n_faces : mesh_n_features(&body->mesh);
}

/* A file may name materials and features that the job does not have. */
static bool fits_job(const struct simulation *sim, const struct checkpoint *checkpoint)
{
    bool fits = true;
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        const int material = sim->spheres.material[i];
        const int caught = sim->spheres.caught[i];
        fits = fits && material >= 0 && material < sim->materials.n &&
               sphere_radius(&sim->spheres, i) > 0.0 && caught >= 0 &&
               caught <= sim->removals.n;
    }
    for (int r = 0; r < checkpoint->n_facet_contacts; r++) {
        const struct facet_contact_record *record = &checkpoint->facet_contacts[r];
        fits = fits && record->body >= 0 && record->body < sim->bodies.n;
        if (fits)
            fits = record->feature >= 0 && record->feature < n_touched(sim, record->body);
    }
    return fits;
}

int simulation_restart(struct simulation *sim, const struct comm *comm, const struct job *job,
                       enum isa isa, const char *checkpoint_path)
{
    begin(sim, comm, job, isa);
    struct checkpoint checkpoint = {.spheres = &sim->spheres,
                                    .full = sim->materials.full,
                                    .ledger = sim->job->energy_ledger,
                                    .removals = job->n_removals > 0};
    checkpoint.n_more = deform_state_tables(sim, checkpoint.more);
    checkpoint.n_more += touch_table(sim, &checkpoint.more[checkpoint.n_more]);
    int status = checkpoint_read(comm, checkpoint_path, &checkpoint);
    const bool fits = status == REPORT_FINISHED && fits_job(sim, &checkpoint) &&
                      touch_fits(sim, &checkpoint.more[checkpoint.n_more - 1]) &&
                      restore_monitors(sim, &checkpoint) == REPORT_FINISHED &&
                      insertions_take_notes(&sim->insertions, &checkpoint.notes) &&
                      body_notes_take(&checkpoint.notes, &sim->bodies);
    if (status == REPORT_FINISHED && comm_agree(comm, fits ? 0 : 1) != 0) {
        report_error("%s has other materials, bodies or sections than the job; "
                     "use the job it belongs to",
                     checkpoint_path);
        status = REPORT_BAD_INPUT;
    }
    if (status != REPORT_FINISHED) {
        checkpoint_clear(&checkpoint);
        simulation_destroy(sim);
        return status;
    }
    sim->step = checkpoint.step;
    sim->next_id = checkpoint.next_id;
    deform_state_restore(sim, checkpoint.more);
    touch_restore(sim, &checkpoint.more[checkpoint.n_more - 1]);
    sim->spheres.n_all = sim->spheres.n_owned;
    sim->migrate.n_facets = sim->migrate.facet_capacity = checkpoint.n_facet_contacts;
    sim->migrate.facets = checkpoint.facet_contacts;
    checkpoint.facet_contacts = NULL;
    const struct origin origin = {checkpoint_path, &checkpoint, NULL};
    status = finish(sim, isa, &origin);
    checkpoint_clear(&checkpoint);
    if (status != REPORT_FINISHED)
        simulation_destroy(sim);
    return status;
}

void simulation_destroy(struct simulation *sim)
{
    materials_clear(&sim->materials);
    bodies_clear(&sim->bodies);
    spheres_clear(&sim->spheres);
    candidates_clear(&sim->candidates);
    contact_set_clear(&sim->contacts);
    facet_contacts_clear(&sim->facets);
    free(sim->body_allowance);
    boxes_clear(&sim->boxes);
    halo_clear(&sim->halo);
    migrate_clear(&sim->migrate);
    forced_clear(&sim->forced);
    probes_clear(&sim->probes);
    deform_clear(&sim->deform, sim->comm);
    touch_clear(&sim->touch);
    local_damping_clear(&sim->local_damping);
    sections_clear(&sim->sections);
    contents_clear(&sim->contents);
    insertions_clear(&sim->insertions);
    removals_clear(&sim->removals);
    observe_clear(&sim->observe);
    watch_clear(&sim->watch);
    capture_clear(&sim->capture);
    runtime_clear(&sim->runtime);
}

/* ---------------------------------------------------------------------------------------
 * saving */

static int write_series(struct simulation *sim, const struct run_folder *folder)
{
    if (sim->comm->rank != 0)
        return REPORT_FINISHED;
    char *path = run_folder_series_path(folder, sim->step);
    const struct series *const tables[] = {&sim->observe.table, &sim->runtime.table,
                                           &sim->runtime.subdomains};
    runtime_subdomains(&sim->runtime, &sim->boxes, sim->step);
    const int status = series_write_segment(folder, path, sim->job->title, 3, tables);
    if (status == REPORT_FINISHED) {
        series_clear_rows(&sim->observe.table);
        series_clear_rows(&sim->runtime.table);
        series_clear_rows(&sim->runtime.subdomains);
    }
    free(path);
    return status;
}

struct runtime_sizes simulation_sizes(const struct simulation *sim)
{
    const struct deform_sizes solids = deform_sizes(&sim->deform);
    return (struct runtime_sizes){
        .n_owned = sim->spheres.n_owned,
        .n_ghosts = sim->spheres.n_all - sim->spheres.n_owned,
        .n_internal = sim->halo.n_internal,
        .n_interfacial = sim->halo.n_interfacial,
        .n_candidates = sim->candidates.n,
        .n_contacts = sim->contacts.now.n,
        .n_spheres = sim->n_spheres,
        .n_nodes = solids.n_nodes,
        .n_copies = solids.n_copies,
        .n_elements = solids.n_elements,
        .weight = redistribute_weight(sim),
        .imbalance = sim->balance.imbalance > 0.0 ? sim->balance.imbalance : 1.0,
    };
}

/* Files hold places within the domain; memory may not, before the next search.  Returns what
 * unwrap_places() takes back. */
static double (*wrap_places(struct simulation *sim))[3]
{
    struct spheres *spheres = &sim->spheres;
    double(*held)[3] = array_allocate((size_t)spheres->n_owned, sizeof *held);
    int turns[3];
    for (int i = 0; i < spheres->n_owned; i++) {
        memcpy(held[i], sphere_position(spheres, i), sizeof held[i]);
        periodic_wrap(&spheres->periodic, sphere_position(spheres, i), turns);
    }
    return held;
}

static void unwrap_places(struct simulation *sim, double (*held)[3])
{
    for (int i = 0; i < sim->spheres.n_owned; i++)
        memcpy(sphere_position(&sim->spheres, i), held[i], sizeof held[i]);
    free(held);
}

static int pairs_held(const void *from, int64_t begin, int64_t end,
                      struct contact_record **records)
{
    const struct simulation *sim = from;
    int capacity = 0;
    return contact_set_records_of(&sim->contacts, &sim->spheres, begin, end, records,
                                  &capacity);
}

static int facets_held(const void *from, int64_t begin, int64_t end,
                       struct facet_contact_record **records)
{
    const struct simulation *sim = from;
    return facet_contacts_records(&sim->facets, &sim->spheres, begin, end, records);
}

static int write_checkpoint(struct simulation *sim, const struct run_folder *folder,
                            const char *job_text)
{
    struct observe_monitor *totals;
    struct checkpoint checkpoint = {.folder = folder,
                                    .step = sim->step,
                                    .dt = sim->dt,
                                    .next_id = sim->next_id,
                                    .spheres = &sim->spheres,
                                    .full = sim->materials.full,
                                    .ledger = sim->job->energy_ledger,
                                    .removals = sim->removals.n > 0,
                                    .held = {sim, pairs_held, facets_held}};
    checkpoint.n_more = deform_state_tables(sim, checkpoint.more);
    checkpoint.n_more += touch_table(sim, &checkpoint.more[checkpoint.n_more]);
    checkpoint.title = array_string(sim->job->title);
    checkpoint.job_text = array_string(job_text);
    checkpoint.n_contacts = contact_set_count(&sim->contacts, &sim->spheres);
    checkpoint.n_facet_contacts = facet_contacts_count(&sim->facets);
    struct exact_sum crossed[3];
    memcpy(crossed, &sim->observe.totals[OBSERVE_CROSSED_X], sizeof crossed);
    observe_crossings(sim);
    double(*held)[3] = wrap_places(sim);
    checkpoint.n_monitors = observe_monitors(sim, &totals);
    checkpoint.monitors =
        array_allocate((size_t)checkpoint.n_monitors, sizeof *checkpoint.monitors);
    for (int m = 0; m < checkpoint.n_monitors; m++) {
        memcpy(checkpoint.monitors[m].name, totals[m].name, sizeof totals[m].name);
        checkpoint.monitors[m].sum = *totals[m].sum;
    }
    free(totals);
    insertions_put_notes(&sim->insertions, &checkpoint.notes);
    body_notes_add(&checkpoint.notes, &sim->bodies);
    char *path = run_folder_checkpoint_path(folder, sim->step);
    const int status = checkpoint_write(sim->comm, path, &checkpoint);
    unwrap_places(sim, held);
    memcpy(&sim->observe.totals[OBSERVE_CROSSED_X], crossed, sizeof crossed);
    free(path);
    checkpoint_clear(&checkpoint);
    return status;
}

int simulation_save_series(struct simulation *sim, const struct run_folder *folder)
{
    const struct runtime_sizes sizes = simulation_sizes(sim);
    runtime_row(&sim->runtime, sim->comm, sim->step, (double)sim->step * sim->dt, &sizes);
    return comm_agree(sim->comm, write_series(sim, folder));
}

int simulation_save(struct simulation *sim, const struct run_folder *folder,
                    const char *job_text)
{
    runtime_begin(&sim->runtime);
    /* Series first: a checkpoint without its rows would leave a gap, rows without a checkpoint
     * are set aside at the next start. */
    int status = simulation_save_series(sim, folder);
    if (status == REPORT_FINISHED)
        status = write_checkpoint(sim, folder, job_text);
    if (status == REPORT_FINISHED && sim->comm->rank == 0 && !run_folder_is_lost(folder))
        run_folder_prune(folder, sim->job->checkpoint.keep);
    runtime_end(&sim->runtime, RUNTIME_CHECKPOINT);
    return status;
}
