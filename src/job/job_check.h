/*
 * Checks that concern more than one key: names used twice, materials that can meet without a
 * pair, a lattice whose spheres overlap, an end that is no whole number of steps.
 */
#ifndef TREMIE_JOB_JOB_CHECK_H
#define TREMIE_JOB_JOB_CHECK_H

#include <stdbool.h>

struct job;
struct mistakes;
struct yaml_tree_node;

/*
 * Lists what does not fit together in a job that the schema has filled.  Parts that already
 * have mistakes are passed over: what is wrong there would only look wrong twice.  With
 * `read_files` also looks at the CSV files that the job names.  `used` (one a material, zeroed)
 * gets true for every material that something is made of.  Local.
 */
void job_check(const struct job *job, const struct yaml_tree_node *root, bool read_files,
               bool *used, struct mistakes *mistakes);

#endif
