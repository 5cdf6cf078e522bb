/* See scene.h. */
#include "scene.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "store/body_notes.h"
#include "store/file.h"
#include "store/snapshot.h"
#include "store/surface_file.h"

char *scene_newest(const char *run_folder)
{
    char *folder = array_format("%s/checkpoints", run_folder);
    int64_t *steps;
    const int n = file_steps(folder, &steps);
    char *path = n > 0 ? file_step_path(folder, steps[n - 1]) : NULL;
    free(steps);
    free(folder);
    return path;
}

/* A body whose file has gone is shown without its surface. */
static void read_surfaces(struct job *job)
{
    for (int b = 0; b < job->n_bodies; b++) {
        struct job_body *body = &job->bodies[b];
        const int64_t sum = body->sum;
        char *why = surface_file_has(body) ? surface_file_read(body) : NULL;
        if (why != NULL)
            report_warn("body '%s' is missing: %s", body->name, why);
        else if (body->sum != sum)
            report_warn("%s has changed since the run", body->file);
        free(why);
    }
}

static void read_job(struct scene *scene, const char *path)
{
    struct mistakes mistakes;
    mistakes_init(&mistakes);
    scene->has_job = job_read_text(&scene->job, path, scene->checkpoint.job_text, &mistakes);
    if (scene->has_job) {
        read_surfaces(&scene->job);
        bodies_build(&scene->bodies, &scene->job);
        (void)body_notes_take(&scene->checkpoint.notes, &scene->bodies);
        bodies_place(&scene->bodies, scene->checkpoint.step, scene->checkpoint.dt);
    } else {
        mistakes_print(&mistakes);
        report_warn(
            "the job text in %s cannot be read by this version; bodies and names are missing",
            path);
    }
    mistakes_clear(&mistakes);
}

/* ------------------------------------------------------------------------------- snapshots */

/* The numbers of a column of sphere i; they stay 0 where there is none. */
static void get(const struct table *table, int64_t i, int field, double *values)
{
    const int column = snapshot_column(table, snapshot_fields[field].name);
    for (int k = 0; k < snapshot_fields[field].width; k++)
        values[k] = 0.0;
    if (column >= 0)
        snapshot_get(table, i, column, values);
}

static void take_spheres(struct spheres *spheres, const struct table *table)
{
    spheres->n_owned = spheres->n_all = (int)table->n;
    spheres_reserve(spheres, (int)table->n);
    for (int i = 0; i < spheres->n_owned; i++) {
        double id = 0.0, material = 0.0, group = 0.0;
        get(table, i, SNAPSHOT_ID, &id);
        get(table, i, SNAPSHOT_POSITION, sphere_position(spheres, i));
        get(table, i, SNAPSHOT_RADIUS, &spheres->motion[i].lane[3]);
        get(table, i, SNAPSHOT_VELOCITY, sphere_velocity(spheres, i));
        get(table, i, SNAPSHOT_ANGULAR_VELOCITY, sphere_angular_velocity(spheres, i));
        get(table, i, SNAPSHOT_MATERIAL, &material);
        get(table, i, SNAPSHOT_GROUP, &group);
        spheres->id[i] = (int64_t)id;
        spheres->material[i] = (int32_t)material;
        spheres->group[i] = (int32_t)group;
    }
}

static void take_body(struct body *body, const struct snapshot_body *shown)
{
    const int n_points = (int)shown->n_points, n_triangles = (int)shown->n_triangles;
    struct vec3 *points = array_allocate((size_t)n_points, sizeof *points);
    int(*facets)[4] = array_allocate((size_t)n_triangles, sizeof *facets);
    for (int v = 0; v < n_points; v++)
        points[v] =
            (struct vec3){shown->points[v][0], shown->points[v][1], shown->points[v][2]};
    for (int f = 0; f < n_triangles; f++) {
        for (int k = 0; k < 3; k++)
            facets[f][k] = shown->triangles[f][k];
        facets[f][3] = -1;
    }
    *body = (struct body){.name = array_string(shown->name), .exists = true};
    mesh_build(&body->mesh, n_points, points, n_triangles, (const int(*)[4])facets);
    free(points);
    free(facets);
}

/* The surface of a solid as a body's, with all of its nodes. */
static void take_solid(struct body *body, const struct snapshot_solid *solid)
{
    const struct snapshot_rows *triangles = &solid->parts[SNAPSHOT_TRIANGLES];
    struct snapshot_body shown = {.name = solid->name,
                                  .n_points = solid->n_nodes,
                                  .n_triangles = triangles->n,
                                  .triangles = triangles->rows};
    shown.points = array_allocate((size_t)solid->n_nodes, sizeof *shown.points);
    for (int64_t i = 0; i < solid->n_nodes; i++)
        snapshot_get(&solid->nodes, i, SNAPSHOT_NODE_POSITION, shown.points[i]);
    take_body(body, &shown);
    free(shown.points);
}

/* The job of the folder in whose snapshots/ the file lies, for names; without a word where
 * there is none. */
static void find_job(struct scene *scene, const char *path)
{
    enum { JOB_TEXT_MAX = 1 << 26 };
    const char *slash = strrchr(path, '/');
    char *job = slash != NULL ? array_format("%.*s/../job.yaml", (int)(slash - path), path)
                              : array_string("../job.yaml");
    char *text = NULL, *why = file_read(job, JOB_TEXT_MAX, &text);
    struct mistakes mistakes;
    mistakes_init(&mistakes);
    scene->has_job = why == NULL && job_read_text(&scene->job, job, text, &mistakes);
    mistakes_clear(&mistakes);
    free(why);
    free(text);
    free(job);
}

static int read_snapshot(struct scene *scene, const char *path)
{
    struct snapshot snapshot;
    char *why = snapshot_read(path, &snapshot);
    if (why != NULL) {
        report_error("cannot read the snapshot %s: %s; use another one", path, why);
        free(why);
        return REPORT_STORAGE;
    }
    *scene = (struct scene){0};
    spheres_init(&scene->spheres);
    take_spheres(&scene->spheres, &snapshot.spheres);
    scene->checkpoint = (struct checkpoint){.step = snapshot.step,
                                            .dt = snapshot.dt,
                                            .next_id = snapshot.next_id,
                                            .title = array_string(snapshot.title),
                                            .spheres = &scene->spheres};
    scene->bodies.n = snapshot.n_bodies + snapshot.n_solids;
    scene->bodies.list = array_allocate((size_t)scene->bodies.n, sizeof *scene->bodies.list);
    for (int b = 0; b < snapshot.n_bodies; b++)
        take_body(&scene->bodies.list[b], &snapshot.bodies[b]);
    for (int s = 0; s < snapshot.n_solids; s++)
        take_solid(&scene->bodies.list[snapshot.n_bodies + s], &snapshot.solids[s]);
    find_job(scene, path);
    snapshot_clear(&snapshot);
    return REPORT_FINISHED;
}

/* -------------------------------------------------------------------------------- either */

static int read_file(struct scene *scene, const struct comm *comm, const char *path)
{
    *scene = (struct scene){0};
    spheres_init(&scene->spheres);
    scene->checkpoint.spheres = &scene->spheres;
    const int status = checkpoint_read(comm, path, &scene->checkpoint);
    if (status != REPORT_FINISHED) {
        spheres_clear(&scene->spheres);
        return status;
    }
    read_job(scene, path);
    return REPORT_FINISHED;
}

int scene_read(struct scene *scene, const struct comm *comm, const char *path)
{
    struct stat entry;
    if (stat(path, &entry) != 0) {
        report_error("there is no %s; give a checkpoint, a snapshot or the folder of a run",
                     path);
        return REPORT_BAD_INPUT;
    }
    if (!S_ISDIR(entry.st_mode))
        return snapshot_is(path) ? read_snapshot(scene, path) : read_file(scene, comm, path);
    char *newest = scene_newest(path);
    int status = REPORT_BAD_INPUT;
    if (newest != NULL)
        status = read_file(scene, comm, newest);
    else
        report_error("%s has no checkpoint; give a checkpoint or the folder of a run", path);
    free(newest);
    return status;
}

void scene_clear(struct scene *scene)
{
    bodies_clear(&scene->bodies);
    if (scene->has_job)
        job_clear(&scene->job);
    checkpoint_clear(&scene->checkpoint);
    spheres_clear(&scene->spheres);
    *scene = (struct scene){0};
}

const char *scene_group(const struct scene *scene, int group)
{
    return scene->has_job ? job_group_name(&scene->job, group) : NULL;
}
