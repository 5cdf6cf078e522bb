/*
 * What can be known of deformable bodies before a run: mistakes in their meshes and in what is
 * prescribed on them, how good the meshes are, what they allow of the step (run/solid_step.h).
 */
#ifndef TREMIE_RUN_SOLID_SURVEY_H
#define TREMIE_RUN_SOLID_SURVEY_H

#include "physics/solid_element.h"

struct bodies;
struct job;
struct job_body;
struct limits_spheres;
struct materials;
struct mistakes;

/* Builds the meshes, to be kept with the job, and lists what is wrong with them, sets and
 * boundaries; files have been read.  Local. */
void solid_survey_check(struct job *job, struct mistakes *mistakes);
/* A few lines for body b, which is a solid.  Local. */
void solid_survey_print(const struct job *job, const struct bodies *bodies,
                        const struct materials *materials, const struct limits_spheres *spheres,
                        int b);
/* What bodies that deform cost. */
struct solid_survey_cost {
    double n_elements;
    double seconds; /* a step, on one rank, without contacts [s] */
    double bytes;   /* of each rank, which begins with all of them */
};
struct solid_survey_cost solid_survey_cost(const struct job *job); /* of all together */
struct solid_survey_cost solid_survey_cost_of(const struct job_body *body);
/* An element's part of `seconds`. */
double solid_survey_seconds(enum solid_element_shape shape);
/* Warns of what is allowed and probably not meant: of its elements, its material, the step.
 * Local. */
void solid_survey_warn(const struct job *job, const struct bodies *bodies, int b);

#endif
