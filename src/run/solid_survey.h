/*
 * What can be known of deformable bodies before a run: mistakes in their meshes and in what is
 * prescribed on them, how good the meshes are, what they allow of the step.
 */
#ifndef TREMIE_RUN_SOLID_SURVEY_H
#define TREMIE_RUN_SOLID_SURVEY_H

struct job;
struct mistakes;

/* Builds the meshes, to be kept with the job, and lists what is wrong with them, sets and
 * boundaries; files have been read.  Local. */
void solid_survey_check(struct job *job, struct mistakes *mistakes);
/* About the largest step that the elements of all solids bear, without contacts; infinite
 * without any [s].  Local. */
double solid_survey_step(const struct job *job);
/* A few lines for body b, which is a solid.  Local. */
void solid_survey_print(const struct job *job, int b);
/* Warns of what is allowed and probably not meant: of its elements, its material, the step.
 * Local. */
void solid_survey_warn(const struct job *job, int b);

#endif
