/* See solid_condition.h. */
#include "model/solid_condition.h"

#include "base/report.h"
#include "job/job.h"
#include "model/solid_mesh.h"

struct solid_condition solid_condition_of(const struct job_boundary *asked,
                                          const struct solid_mesh *mesh)
{
    const struct solid_mesh_set *set = solid_mesh_find(mesh, asked->set);
    const int along = 1 << asked->direction;
    CHECK(set != NULL, "there is no set '%s'", asked->set);
    if (asked->fixed != 0)
        return (struct solid_condition){SOLID_CONDITION_FIXED, set, asked->fixed, 0.0, 0, NULL};
    if (asked->n_displacements > 0)
        return (struct solid_condition){
            SOLID_CONDITION_DISPLACEMENT, set, along, 0.0, asked->n_displacements,
            asked->displacements};
    if (asked->has_velocity || asked->n_velocities > 0)
        return (struct solid_condition){
            SOLID_CONDITION_VELOCITY, set, along, asked->velocity, asked->n_velocities,
            asked->velocities};
    if (asked->has_force || asked->n_forces > 0)
        return (struct solid_condition){
            SOLID_CONDITION_FORCE, set, along, asked->force, asked->n_forces, asked->forces};
    return (struct solid_condition){
        SOLID_CONDITION_PRESSURE, set, 0, asked->pressure, asked->n_pressures,
        asked->pressures};
}
