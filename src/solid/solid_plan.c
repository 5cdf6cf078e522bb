/* See solid_plan.h. */
#include "solid/solid_plan.h"

#include "base/report.h"
#include "job/job.h"
#include "model/solid_mesh.h"

enum solid_element_shape solid_plan_shape(const struct solid_mesh *mesh, int element)
{
    const int n = solid_mesh_n_corners(mesh->elements[element]);
    if (!solid_mesh_is_sheet(mesh->elements[element]))
        return n == 8 ? SOLID_ELEMENT_HEXAHEDRON : SOLID_ELEMENT_TETRAHEDRON;
    if (mesh->sheets[element].membrane)
        return n == 4 ? SOLID_ELEMENT_MEMBRANE_QUAD : SOLID_ELEMENT_MEMBRANE_TRIANGLE;
    return n == 4 ? SOLID_ELEMENT_SHELL_QUAD : SOLID_ELEMENT_SHELL_TRIANGLE;
}

struct solid_plan_hourglass solid_plan_hourglass(const struct job_body *body, bool is_sheet)
{
    const bool stiff = is_sheet || body->solid.hourglass.kind == JOB_HOURGLASS_STIFFNESS;
    const double held = body->solid.hourglass.coefficient;
    return (struct solid_plan_hourglass){stiff ? held : 0.0, stiff ? 0.0 : held};
}

struct solid_plan_mass solid_plan_mass(const struct job_body *body,
                                       const struct solid_mesh *mesh, int k)
{
    const struct job_mass *asked = &body->solid.masses[k];
    const struct solid_mesh_set *set = solid_mesh_find(mesh, asked->set);
    CHECK(set != NULL && set->n_nodes > 0, "there is no node in set '%s'", asked->set);
    return (struct solid_plan_mass){set, asked->mass / set->n_nodes,
                                    asked->inertia / set->n_nodes};
}
