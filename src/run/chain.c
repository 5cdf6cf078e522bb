/*
 * See chain.h.  Every rank reads the spheres once for itself, since random packings keep clear
 * of them; then all read the checkpoint together as for a restart.
 */
#include "run/chain.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "model/material.h"
#include "model/sphere.h"
#include "run/simulation.h"
#include "store/checkpoint.h"
#include "store/h5.h"
#include "store/run_folder.h"
#include "store/sphere_file.h"

char *chain_checkpoint(const struct job *job)
{
    struct stat status;
    struct run_folder folder = {.path = job->start.from};
    int64_t *steps = NULL;
    char *path = NULL;
    if (stat(folder.path, &status) != 0)
        return NULL;
    if (!S_ISDIR(status.st_mode))
        return array_string(folder.path);
    if (job->start.checkpoint != NULL)
        path = array_format("%s/checkpoints/%s", folder.path, job->start.checkpoint);
    else if (run_folder_checkpoints(&folder, &steps) > 0)
        path = run_folder_checkpoint_path(&folder, steps[0]);
    free(steps);
    if (path != NULL && stat(path, &status) != 0) {
        free(path);
        path = NULL;
    }
    return path;
}

/* ------------------------------------------------------------------------------- matching */

static int *match_materials(const struct job *from, const struct job *to)
{
    int *match = array_allocate((size_t)from->n_materials, sizeof *match);
    for (int m = 0; m < from->n_materials; m++) {
        match[m] = -1;
        for (int k = 0; k < to->n_materials; k++)
            if (strcmp(from->materials[m].name, to->materials[k].name) == 0)
                match[m] = k;
    }
    return match;
}

static bool is_at_rest(const struct job_body *body)
{
    return body->n_motions == 0 && !body->driven.given && !body->free.given &&
           !body->comes_and_goes;
}

/* A job's text with this body alone, which names materials by numbers that are the job's at
 * material[]. */
static char *text_with(const struct job *job, const struct job_body *body, const int *material)
{
    const int n = body->solid.n_shells;
    struct job_body only = *body;
    struct job one = *job;
    only.material = material[body->material];
    only.solid.shells = array_allocate((size_t)n, sizeof *only.solid.shells);
    for (int k = 0; k < n; k++) {
        only.solid.shells[k] = body->solid.shells[k];
        if (only.solid.shells[k].has_material)
            only.solid.shells[k].material = material[only.solid.shells[k].material];
    }
    one.n_bodies = 1;
    one.bodies = &only;
    char *text = job_write(&one);
    free(only.solid.shells);
    return text;
}

/* Has the job all that the body is made of? */
static bool is_known(const struct job_body *body, const int *material)
{
    bool known = material[body->material] >= 0;
    for (int k = 0; k < body->solid.n_shells; k++)
        known = known && (!body->solid.shells[k].has_material ||
                          material[body->solid.shells[k].material] >= 0);
    return known;
}

/* Is it the same body, as far as contacts with it remember? */
static bool is_same_body(const struct job *to, const struct job_body *was, const int *material,
                         const struct job_body *now)
{
    if (strcmp(was->name, now->name) != 0 || !is_known(was, material) ||
        material[was->material] != now->material || !is_at_rest(was) || !is_at_rest(now))
        return false;
    int *own = array_allocate((size_t)to->n_materials, sizeof *own);
    for (int m = 0; m < to->n_materials; m++)
        own[m] = m;
    char *before = text_with(to, was, material), *after = text_with(to, now, own);
    const bool same = strcmp(before, after) == 0;
    free(own);
    free(before);
    free(after);
    return same;
}

static int *match_bodies(const struct job *from, const struct job *to, const int *material)
{
    int *match = array_allocate((size_t)from->n_bodies, sizeof *match);
    for (int b = 0; b < from->n_bodies; b++) {
        match[b] = -1;
        for (int k = 0; k < to->n_bodies; k++)
            if (is_same_body(to, &from->bodies[b], material, &to->bodies[k]))
                match[b] = k;
    }
    return match;
}

/* The job's number of the group of this name: one of its own, or one that comes with the
 * spheres, which is added to the names where it is new. */
static int find_group(struct chain *chain, const struct job *to, const char *name)
{
    const int n_own = to->n_spheres + to->n_insertions;
    for (int g = 0; g < n_own; g++)
        if (strcmp(job_group_name(to, g), name) == 0)
            return g;
    for (int k = 0; k < chain->n_names; k++)
        if (strcmp(chain->names[k], name) == 0)
            return n_own + k;
    chain->names[chain->n_names++] = name;
    return n_own + chain->n_names - 1;
}

static void match_groups(struct chain *chain, const struct job *to)
{
    chain->n_groups = job_n_groups(&chain->job);
    chain->group = array_allocate((size_t)chain->n_groups, sizeof *chain->group);
    chain->names = array_allocate((size_t)chain->n_groups, sizeof *chain->names);
    for (int g = 0; g < chain->n_groups; g++)
        chain->group[g] = find_group(chain, to, job_group_name(&chain->job, g));
}

static bool same_corner(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* A contact across a boundary that does not repeat any more would join what is far apart. */
static bool is_same_space(const struct job *from, const struct job *to)
{
    return from->domain.periodic == to->domain.periodic &&
           (to->domain.periodic == 0 || (same_corner(from->domain.min, to->domain.min) &&
                                         same_corner(from->domain.max, to->domain.max)));
}

/* ------------------------------------------------------------------------------- checking */

static bool has_pair(const struct job *job, int a, int b)
{
    for (int k = 0; k < job->n_pairs; k++)
        if ((job->pairs[k].a == a && job->pairs[k].b == b) ||
            (job->pairs[k].a == b && job->pairs[k].b == a))
            return true;
    return false;
}

/* Lists pairs that the spheres of the start need and the job does not give. */
static void check_pairs(const struct job *job, const bool *coming, struct mistakes *mistakes)
{
    bool *there = array_allocate((size_t)job->n_materials, sizeof *there);
    for (int g = 0; g < job->n_spheres; g++)
        there[job->spheres[g].material] = true;
    for (int b = 0; b < job->n_bodies; b++)
        there[job->bodies[b].material] = true;
    for (int m = 0; m < job->n_materials; m++)
        there[m] = there[m] || coming[m];
    for (int a = 0; a < job->n_materials; a++)
        for (int b = 0; b < job->n_materials; b++)
            if (coming[a] && there[b] && (b >= a || !coming[b]) && !has_pair(job, a, b))
                mistakes_add(mistakes, job->path, 0, 0,
                             "contact.pairs say nothing about %s, of the spheres of start, and "
                             "%s; {between: [%s, %s], friction: ..., restitution: ...} is "
                             "expected",
                             job->materials[a].name, job->materials[b].name,
                             job->materials[a].name, job->materials[b].name);
    free(there);
}

/* Reads which group each sphere is in. */
static void read_groups(struct chain *chain, struct h5 *h5)
{
    const int64_t n = chain->packing.n;
    chain->group_of = array_allocate((size_t)n, sizeof *chain->group_of);
    int32_t *group = array_allocate((size_t)n, sizeof *group);
    h5_read_rows(h5, "/spheres/group", &sphere_fields[SPHERE_GROUP], 0, n, group);
    for (int64_t i = 0; h5->why == NULL && i < n; i++) {
        if (group[i] >= 0 && group[i] < chain->n_groups)
            chain->group_of[i] = chain->group[group[i]];
        else
            h5_fail(h5, "/spheres/group names one that its job does not have");
    }
    free(group);
}

/* Reads which material each sphere has and gives it the job's. */
static char *read_materials(struct chain *chain, const struct job *job,
                            struct mistakes *mistakes)
{
    const size_t n = (size_t)chain->packing.n;
    const int n_materials = chain->job.n_materials;
    const struct field *field = &sphere_fields[SPHERE_MATERIAL];
    int32_t *material = array_allocate(n, sizeof *material);
    bool *missing = array_allocate((size_t)n_materials, sizeof *missing);
    bool *coming = array_allocate((size_t)job->n_materials, sizeof *coming);
    struct h5 h5;
    h5_open(&h5, chain->path);
    h5_read_rows(&h5, "/spheres/material", field, 0, chain->packing.n, material);
    for (size_t i = 0; h5.why == NULL && i < n; i++) {
        if (material[i] < 0 || material[i] >= n_materials) {
            h5_fail(&h5, "/spheres/material names one that its job does not have");
            break;
        }
        const int own = chain->material[material[i]];
        chain->packing.rows[i].material = own;
        missing[material[i]] = own < 0;
        if (own >= 0)
            coming[own] = true;
    }
    read_groups(chain, &h5);
    h5_close(&h5);
    for (int m = 0; m < n_materials; m++)
        if (missing[m])
            mistakes_add(mistakes, job->path, 0, 0,
                         "start: %s holds spheres of the material '%s', which the job does not "
                         "have; a material of that name is expected",
                         chain->path, chain->job.materials[m].name);
    check_pairs(job, coming, mistakes);
    free(material);
    free(missing);
    free(coming);
    return h5.why;
}

static char *read_state(struct chain *chain, const struct job *job, struct mistakes *mistakes)
{
    struct checkpoint header;
    struct mistakes theirs;
    char *why = NULL;
    chain->path = chain_checkpoint(job);
    if (chain->path == NULL)
        return array_string("there is no such file, or no checkpoint in that folder");
    if (!checkpoint_read_header(chain->path, &header, &why))
        return why;
    mistakes_init(&theirs);
    chain->step = header.step;
    chain->time = (double)header.step * header.dt;
    if (!job_read_text(&chain->job, chain->path, header.job_text, &theirs))
        why =
            array_format("its job cannot be read: %s", theirs.n > 0 ? theirs.list[0].text : "");
    mistakes_clear(&theirs);
    checkpoint_clear(&header);
    if (why != NULL)
        return why;
    chain->material = match_materials(&chain->job, job);
    chain->body = match_bodies(&chain->job, job, chain->material);
    match_groups(chain, job);
    chain->same_space = is_same_space(&chain->job, job);
    const struct packing_sphere standard = {.radius = 0.0};
    why = sphere_file_read(chain->path, &standard, &chain->packing.n, &chain->packing.rows);
    const struct vec3 none = {0.0, 0.0, 0.0};
    for (int64_t k = 0; job->start.velocities == JOB_VELOCITIES_ZERO && k < chain->packing.n;
         k++)
        chain->packing.rows[k].velocity = chain->packing.rows[k].angular_velocity = none;
    return why != NULL ? why : read_materials(chain, job, mistakes);
}

bool chain_open(struct chain *chain, const struct job *job, struct mistakes *mistakes)
{
    const int n_before = mistakes->n;
    *chain = (struct chain){.path = NULL};
    char *why = read_state(chain, job, mistakes);
    if (why != NULL)
        mistakes_add(mistakes, job->path, 0, 0,
                     "start.from: %s: %s; the folder of a run or one of its checkpoints is "
                     "expected",
                     job->start.from, why);
    free(why);
    if (mistakes->n == n_before)
        return true;
    chain_close(chain);
    return false;
}

void chain_close(struct chain *chain)
{
    packing_close(&chain->packing);
    job_clear(&chain->job);
    free(chain->path);
    free(chain->material);
    free(chain->body);
    free(chain->group);
    free(chain->group_of);
    free(chain->names);
    *chain = (struct chain){.path = NULL};
}

/* ------------------------------------------------------------------------------- beginning */

/* Sphere i as a new one of the job, with its id. */
static void renew_sphere(const struct chain *chain, struct simulation *sim, int i)
{
    const struct vec3 none = {0.0, 0.0, 0.0};
    const double *x = sphere_position(&sim->spheres, i), *v = sphere_velocity(&sim->spheres, i);
    const double *w = sphere_angular_velocity(&sim->spheres, i);
    const bool moves = sim->job->start.velocities == JOB_VELOCITIES_KEEP;
    const struct packing_sphere sphere = {
        .position = {x[0], x[1], x[2]},
        .velocity = moves ? (struct vec3){v[0], v[1], v[2]} : none,
        .angular_velocity = moves ? (struct vec3){w[0], w[1], w[2]} : none,
        .radius = sphere_radius(&sim->spheres, i),
        .material = chain->material[sim->spheres.material[i]]};
    simulation_set_sphere(sim, i, sim->spheres.id[i], chain->group[sim->spheres.group[i]],
                          &sphere);
}

/* Lanes that this job needs; what remembers velocities is forgotten with them. */
static void renew_history(const struct simulation *sim, double history[CONTACT_LANES])
{
    const bool stopped = sim->job->start.velocities == JOB_VELOCITIES_ZERO;
    for (int lane = 0; lane < CONTACT_LANES; lane++) {
        const bool drags = lane >= CONTACT_DRAG_LANE && lane < CONTACT_ROLLING_LANE;
        const bool fades = lane == CONTACT_RADIUS_LANE + 1 || drags;
        if (!contact_lane_used(lane, sim->materials.full, sim->job->energy_ledger) ||
            (stopped && fades))
            history[lane] = 0.0;
    }
}

int chain_renew_contacts(const struct chain *chain, const struct simulation *sim, int n,
                         struct contact_record *records)
{
    for (int r = 0; r < n; r++)
        renew_history(sim, records[r].history);
    return chain->same_space ? n : 0;
}

static void give_facet_contacts(const struct chain *chain, struct simulation *sim,
                                struct checkpoint *checkpoint)
{
    int n = 0;
    for (int r = 0; r < checkpoint->n_facet_contacts; r++) {
        struct facet_contact_record record = checkpoint->facet_contacts[r];
        record.body = chain->body[record.body];
        renew_history(sim, record.history);
        if (record.body >= 0)
            checkpoint->facet_contacts[n++] = record;
    }
    sim->migrate.n_facets = n;
    sim->migrate.facet_capacity = checkpoint->n_facet_contacts;
    sim->migrate.facets = checkpoint->facet_contacts;
    checkpoint->facet_contacts = NULL;
}

/* Are materials, groups and bodies of this rank's rows among those of the file's own job? */
static bool is_sound(const struct chain *chain, const struct simulation *sim,
                     const struct checkpoint *checkpoint)
{
    bool sound = true;
    for (int i = 0; i < sim->spheres.n_owned; i++)
        sound = sound && sim->spheres.material[i] < chain->job.n_materials &&
                chain->material[sim->spheres.material[i]] >= 0 &&
                sim->spheres.group[i] < chain->n_groups;
    for (int r = 0; r < checkpoint->n_facet_contacts; r++)
        sound = sound && checkpoint->facet_contacts[r].body < chain->job.n_bodies;
    return sound;
}

int chain_begin(const struct chain *chain, struct simulation *sim,
                struct checkpoint *checkpoint)
{
    struct materials materials;
    materials_build(&materials, &chain->job);
    *checkpoint = (struct checkpoint){
        .spheres = &sim->spheres, .full = materials.full, .ledger = chain->job.energy_ledger};
    materials_clear(&materials);
    int status = checkpoint_read(sim->comm, chain->path, checkpoint);
    if (status == REPORT_FINISHED &&
        comm_agree(sim->comm, is_sound(chain, sim, checkpoint) ? 0 : 1) != 0) {
        report_error("%s does not fit the job in it; start from another checkpoint",
                     chain->path);
        status = REPORT_STORAGE;
    }
    if (status == REPORT_FINISHED) {
        for (int i = 0; i < sim->spheres.n_owned; i++)
            renew_sphere(chain, sim, i);
        sim->next_id = checkpoint->next_id;
        give_facet_contacts(chain, sim, checkpoint);
        report_say("starts from %s, step %lld (%.6g s): %lld spheres", chain->path,
                   (long long)chain->step, chain->time, (long long)chain->packing.n);
    }
    return status;
}
