/* A checkpoint or a snapshot on one process, with the job it came from and the bodies where
 * they were. */
#ifndef TREMIE_POSTPROC_SCENE_H
#define TREMIE_POSTPROC_SCENE_H

#include <stdbool.h>

#include "job/job.h"
#include "model/body.h"
#include "model/sphere.h"
#include "store/checkpoint.h"

struct comm;

struct scene {
    struct checkpoint checkpoint; /* its spheres are those below */
    struct spheres spheres;       /* fields only */
    bool has_job;                 /* else the one below is empty */
    struct job job;
    struct bodies bodies; /* of a snapshot: name, material and triangles */
};

/*
 * Reads a checkpoint, or the newest one of a run's folder, or a snapshot, verifying checksums.
 * Of a snapshot, what it does not hold is 0, and the job is that of the run's folder.  Returns
 * a REPORT_ status, the reason said; then there is nothing to clear.  A job text that this
 * version cannot read is a warning.  Collective, meant for one rank.
 */
int scene_read(struct scene *scene, const struct comm *comm, const char *path);
void scene_clear(struct scene *scene);

/* The name of a group, or of the insertion that is counted on from groups; NULL where the job
 * knows none. */
const char *scene_group(const struct scene *scene, int group);

/* The newest checkpoint of a run's folder; NULL when there is none.  The caller frees it. */
char *scene_newest(const char *run_folder);

#endif
