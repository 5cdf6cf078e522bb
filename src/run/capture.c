/* See capture.h.  A snapshot that waits costs each rank its share of the rows, once more while
 * they are sorted. */
#include "run/capture.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "run/deform_capture.h"
#include "run/simulation.h"
#include "store/file.h"
#include "store/run_folder.h"

void capture_init(struct capture *capture, const struct simulation *sim)
{
    const double every = sim->job->output.snapshots.every;
    *capture = (struct capture){.every = simulation_steps(every, sim->dt)};
    if (every > 0.0 && capture->every == 0)
        capture->every = 1;
}

void capture_clear(struct capture *capture)
{
    if (capture->waits)
        snapshot_clear(&capture->snapshot);
    xdmf_clear(&capture->index);
    *capture = (struct capture){0};
}

int capture_open(struct simulation *sim, const struct run_folder *folder)
{
    struct capture *capture = &sim->capture;
    char *path = array_format("%s/snapshots", folder->path);
    char *why = capture->every > 0 ? file_make_folders(path) : NULL;
    int status = REPORT_FINISHED;
    int64_t *steps;
    const int n = file_steps(path, &steps), error = errno;
    if (why != NULL) {
        report_error("cannot make the folder %s: %s; name another one with --out", path, why);
        status = REPORT_STORAGE;
    } else if (n < 0) {
        report_error("cannot read %s: %s; mend that and give the same command again", path,
                     strerror(error));
        status = REPORT_STORAGE;
    }
    xdmf_open(&capture->index, path, sim->step);
    if (status == REPORT_FINISHED && n > 0)
        status = xdmf_write(&capture->index, folder, path);
    free(steps);
    free(why);
    free(path);
    return status;
}

/* ------------------------------------------------------------------------------------ rows */

static void put_sphere(const struct simulation *sim, struct table *table, int i)
{
    const struct spheres *spheres = &sim->spheres;
    double velocity[3], spin[3];
    observe_motion(sim, i, velocity, spin);
    const double *force = spheres->force[i].lane;
    const struct vec3 x = periodic_place(&spheres->periodic, sphere_position(spheres, i));
    const double position[3] = {x.x, x.y, x.z};
    const double radius = sphere_radius(spheres, i),
                 mass = 1.0 / sphere_inverse_mass(spheres, i);
    const void *const values[SNAPSHOT_N_FIELDS] = {
        [SNAPSHOT_ID] = &spheres->id[i],
        [SNAPSHOT_POSITION] = position,
        [SNAPSHOT_RADIUS] = &radius,
        [SNAPSHOT_VELOCITY] = velocity,
        [SNAPSHOT_ANGULAR_VELOCITY] = spin,
        [SNAPSHOT_FORCE] = force,
        [SNAPSHOT_TORQUE] = force + 4,
        [SNAPSHOT_MASS] = &mass,
        [SNAPSHOT_MATERIAL] = &spheres->material[i],
        [SNAPSHOT_GROUP] = &spheres->group[i],
        [SNAPSHOT_DISSIPATED_FRICTION] = &spheres->dissipated_friction[i],
        [SNAPSHOT_DISSIPATED_DAMPING] = &spheres->dissipated_damping[i],
    };
    const int fields = sim->job->output.snapshots.fields;
    for (int f = 0, column = 0; f < SNAPSHOT_N_FIELDS; f++)
        if (f < SNAPSHOT_FIRST_CHOICE || (fields >> (f - SNAPSHOT_FIRST_CHOICE) & 1) != 0)
            snapshot_put(table, i, column++, values[f]);
}

static void add_spheres(const struct simulation *sim, struct table *table)
{
    table->n = sim->spheres.n_owned;
    table->records = array_allocate((size_t)table->n, table->record_size);
    for (int i = 0; i < sim->spheres.n_owned; i++)
        put_sphere(sim, table, i);
}

/* What the sphere of the higher id feels: the normal spring, which does not pull together with
 * its dashpot, the tangential spring, both dashpots where they are remembered. */
static void put_contact(const struct simulation *sim, struct table *table, int64_t row, int k)
{
    const struct contact_list *list = &sim->contacts.now;
    const struct spheres *spheres = &sim->spheres;
    const bool turned = spheres->id[list->first[k]] > spheres->id[list->second[k]];
    const int i = turned ? list->second[k] : list->first[k];
    const int j = turned ? list->first[k] : list->second[k];
    const double *a = spheres->motion[i].lane, *b = spheres->motion[j].lane;
    const double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const double distance = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const double overlap = a[3] + b[3] - distance, sign = turned ? 1.0 : -1.0;
    const double width = list->history[CONTACT_RADIUS_LANE][k];
    const int pair = spheres->material[i] * sim->materials.n + spheres->material[j];
    const double push = sim->materials.pairs[pair].normal * width * overlap;
    const struct vec3 within = periodic_place(&spheres->periodic, a);
    double place[3] = {within.x, within.y, within.z}, force[3];
    for (int c = 0; c < 3; c++) {
        place[c] += d[c] / distance * (a[3] - 0.5 * overlap);
        force[c] = push * d[c] / distance + sign * list->history[c][k];
        if (list->history[CONTACT_DRAG_LANE] != NULL)
            force[c] += sign * list->history[CONTACT_DRAG_LANE + c][k];
    }
    const struct vec3 point = periodic_place(&spheres->periodic, place);
    snapshot_put(table, row, SNAPSHOT_FIRST_ID, &spheres->id[i]);
    snapshot_put(table, row, SNAPSHOT_SECOND_ID, &spheres->id[j]);
    snapshot_put(table, row, SNAPSHOT_CONTACT_POSITION, (double[3]){point.x, point.y, point.z});
    snapshot_put(table, row, SNAPSHOT_CONTACT_FORCE, force);
}

/* Those between spheres whose lower id is owned here. */
static void add_contacts(const struct simulation *sim, struct table *table)
{
    const struct contact_list *list = &sim->contacts.now;
    const int64_t *id = sim->spheres.id;
    table->records = array_allocate((size_t)list->n, table->record_size);
    for (int k = 0; k < list->n; k++) {
        const int i = list->first[k], j = list->second[k];
        const int lower = id[i] < id[j] ? i : j;
        if (lower < sim->spheres.n_owned && contact_touches(list, k))
            put_contact(sim, table, table->n++, k);
    }
}

/* ---------------------------------------------------------------------------------- bodies */

/* Adds a facet as triangles. */
static void add_facet(struct snapshot_body *shown, int n, const int *vertices)
{
    for (int k = 2; k < n; k++) {
        int32_t *triangle = shown->triangles[shown->n_triangles++];
        triangle[0] = vertices[0];
        triangle[1] = vertices[k - 1];
        triangle[2] = vertices[k];
    }
}

static void add_body(const struct simulation *sim, const struct body *body,
                     struct snapshot_body *shown)
{
    const struct mesh *mesh = &body->mesh;
    const size_t n_facets = (size_t)mesh->n_faces;
    *shown = (struct snapshot_body){
        .name = array_string(body->name),
        .material = array_string(sim->job->materials[body->material].name),
        .n_points = mesh->n_vertices,
    };
    shown->points = array_allocate((size_t)mesh->n_vertices, sizeof *shown->points);
    for (int v = 0; v < mesh->n_vertices; v++) {
        const struct vec3 x = mesh->place[v];
        memcpy(shown->points[v], (double[3]){x.x, x.y, x.z}, sizeof *shown->points);
    }
    shown->triangles = array_allocate(2 * n_facets, sizeof *shown->triangles);
    for (int f = 0; f < mesh->n_faces; f++)
        add_facet(shown, mesh->faces[f].n, mesh->faces[f].vertices);
}

static void add_bodies(const struct simulation *sim, struct snapshot *snapshot)
{
    if (sim->comm->rank != 0)
        return;
    snapshot->bodies = array_allocate((size_t)sim->bodies.n, sizeof *snapshot->bodies);
    for (int b = 0; b < sim->bodies.n; b++)
        if (sim->bodies.list[b].exists && sim->bodies.list[b].skin == NULL)
            add_body(sim, &sim->bodies.list[b], &snapshot->bodies[snapshot->n_bodies++]);
}

/* ----------------------------------------------------------------------------------- whole */

void capture_take(struct simulation *sim)
{
    struct capture *capture = &sim->capture;
    const struct job *job = sim->job;
    struct snapshot *snapshot = &capture->snapshot;
    if (capture->every == 0 || sim->step % capture->every != 0)
        return;
    CHECK(!capture->waits, "a snapshot was not written");
    snapshot_init(snapshot, job->output.snapshots.fields, job->output.snapshots.contacts,
                  job->output.snapshots.precision == JOB_PRECISION_SINGLE,
                  job->output.snapshots.compress == JOB_COMPRESS_LOSSLESS);
    snapshot->step = sim->step;
    snapshot->dt = sim->dt;
    snapshot->next_id = sim->next_id;
    snapshot->title = array_string(job->title);
    snapshot->materials = array_string("");
    snapshot->groups = array_string("");
    for (int m = 0; m < job->n_materials; m++)
        snapshot->materials = snapshot_add_name(snapshot->materials, job->materials[m].name);
    for (int g = 0; g < job_n_groups(job); g++)
        snapshot->groups = snapshot_add_name(snapshot->groups, job_group_name(job, g));
    add_spheres(sim, &snapshot->spheres);
    table_arrange(&snapshot->spheres, sim->comm, sim->next_id);
    if (snapshot->has_contacts) {
        add_contacts(sim, &snapshot->contacts);
        table_arrange(&snapshot->contacts, sim->comm, sim->next_id);
    }
    add_bodies(sim, snapshot);
    deform_capture(sim, snapshot);
    capture->waits = true;
}

int capture_write(struct simulation *sim, const struct run_folder *folder)
{
    struct capture *capture = &sim->capture;
    if (!capture->waits)
        return REPORT_FINISHED;
    char *path = array_format("%s/snapshots", folder->path);
    runtime_begin(&sim->runtime);
    capture->snapshot.folder = folder;
    int status = snapshot_write(sim->comm, path, &capture->snapshot);
    if (status == REPORT_FINISHED && sim->comm->rank == 0) {
        xdmf_add(&capture->index, &capture->snapshot);
        status = xdmf_write(&capture->index, folder, path);
    }
    status = comm_agree(sim->comm, status);
    runtime_end(&sim->runtime, RUNTIME_SAMPLE);
    snapshot_clear(&capture->snapshot);
    capture->waits = false;
    free(path);
    return status;
}
