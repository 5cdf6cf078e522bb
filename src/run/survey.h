/*
 * What bodies' surfaces are like, and what about them looks like a mistake.
 */
#ifndef TREMIE_RUN_SURVEY_H
#define TREMIE_RUN_SURVEY_H

struct bodies;
struct comm;
struct job;
struct limits_spheres;
struct materials;
struct mistakes;
struct spheres;

/* Lists bodies without a surface: all of their facets are points or lines.  Local. */
void survey_check(const struct job *job, const struct bodies *bodies,
                  struct mistakes *mistakes);
/* For each body a few lines: facets, extent, area, volume; what it allows of the step, or what
 * it neglects that it is rigid, with all these spheres.  Local. */
void survey_print(const struct job *job, const struct bodies *bodies,
                  const struct materials *materials, const struct limits_spheres *spheres);
/* Warns of facets that were left out, holes, walls that meet in a T, facets that look the other
 * way, and extents beside which these spheres are tiny or huge.  Collective. */
void survey_warn(const struct job *job, const struct bodies *bodies,
                 const struct spheres *spheres, const struct comm *comm);

#endif
