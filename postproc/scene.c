/* See scene.h. */
#include "scene.h"

#include <stdlib.h>
#include <sys/stat.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "store/body_notes.h"
#include "store/file.h"
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
        report_error("there is no %s; give a checkpoint or the folder of a run", path);
        return REPORT_BAD_INPUT;
    }
    if (!S_ISDIR(entry.st_mode))
        return read_file(scene, comm, path);
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
    if (scene->has_job) {
        bodies_clear(&scene->bodies);
        job_clear(&scene->job);
    }
    checkpoint_clear(&scene->checkpoint);
    spheres_clear(&scene->spheres);
    *scene = (struct scene){0};
}
