/* See solid_condition.h. */
#include "model/solid_condition.h"

#include "base/report.h"
#include "job/job.h"
#include "model/solid_mesh.h"

struct solid_condition solid_condition_of(const struct job_boundary *asked,
                                          const struct solid_mesh *mesh)
{
    const int along = 1 << asked->direction;
    struct solid_condition condition = {.set = solid_mesh_find(mesh, asked->set),
                                        .directions = along};
    CHECK(condition.set != NULL, "there is no set '%s'", asked->set);
    if (asked->fixed != 0 || asked->fixed_turns != 0) {
        condition.kind = SOLID_CONDITION_FIXED;
        condition.directions = asked->fixed;
        condition.turns = asked->fixed_turns;
    } else if (asked->n_motions > 0) {
        condition.kind = SOLID_CONDITION_MOTION;
        condition.directions = 0;
        condition.n_motions = asked->n_motions;
        condition.motions = asked->motions;
    } else if (asked->n_displacements > 0) {
        condition.kind = SOLID_CONDITION_DISPLACEMENT;
        condition.n = asked->n_displacements;
        condition.rows = asked->displacements;
    } else if (asked->has_velocity || asked->n_velocities > 0) {
        condition.kind = SOLID_CONDITION_VELOCITY;
        condition.constant = asked->velocity;
        condition.n = asked->n_velocities;
        condition.rows = asked->velocities;
    } else if (asked->has_force || asked->n_forces > 0) {
        condition.kind = SOLID_CONDITION_FORCE;
        condition.constant = asked->force;
        condition.n = asked->n_forces;
        condition.rows = asked->forces;
    } else {
        condition.kind = SOLID_CONDITION_PRESSURE;
        condition.directions = 0;
        condition.constant = asked->pressure;
        condition.n = asked->n_pressures;
        condition.rows = asked->pressures;
    }
    return condition;
}
