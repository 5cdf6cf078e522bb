/*
 * What a body neglects that is rigid: how far it would yield to spheres, beside how far their
 * contacts with it do (THEORY.md 10.5).  Estimates, for people.
 */
#ifndef TREMIE_RUN_RIGIDITY_H
#define TREMIE_RUN_RIGIDITY_H

struct body;
struct job;
struct limits_spheres;
struct materials;
struct mesh_survey;

/* One line for a rigid body, none where there are no spheres that it meets.  Local. */
void rigidity_print(const struct job *job, const struct body *body,
                    const struct mesh_survey *survey, const struct materials *materials,
                    const struct limits_spheres *spheres);

#endif
