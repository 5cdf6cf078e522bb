/*
 * See rigidity.h.  A closed surface is taken to be solid inside; of an open one nobody knows
 * how thick the wall is, so the thickness is told that would yield as much as the contact does.
 */
#include "run/rigidity.h"

#include "base/elementary.h"
#include "base/report.h"
#include "job/job.h"
#include "model/body.h"
#include "model/gravity.h"
#include "run/limits.h"

/* Of a square plate clamped at its edges under a load in its middle, w D / F a^2: Timoshenko
 * and Woinowsky-Krieger, Theory of Plates and Shells. */
static const double CLAMPED = 0.00560;

/* The body as a block of its length and volume, pressed along it [m].  (10.9) */
static double block_yields(const struct mesh_survey *survey, double young, double force)
{
    const struct vec3 size = vec3_sub(survey->high, survey->low);
    const double side = size.x > size.y ? size.x : size.y;
    const double length = size.z > side ? size.z : side;
    return force * length * length / (young * survey->volume);
}

static double area_of(const struct mesh *mesh, const int *vertices, int n)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    const struct vec3 from = mesh->reference[vertices[0]];
    for (int k = 2; k < n; k++)
        sum = vec3_add(sum, vec3_cross(vec3_sub(mesh->reference[vertices[k - 1]], from),
                                       vec3_sub(mesh->reference[vertices[k]], from)));
    return 0.5 * vec3_norm(sum);
}

static double largest_facet(const struct mesh *mesh)
{
    double largest = 0.0;
    for (int f = 0; f < mesh->n_faces; f++) {
        const double area = area_of(mesh, mesh->faces[f].vertices, mesh->faces[f].n);
        largest = area > largest ? area : largest;
    }
    return largest;
}

/* Thickness of a wall whose largest facet bends by so much [m].  (10.10) */
static double thickness_for(const struct job_material *material, double area, double force,
                            double deflection)
{
    const double cubed = 12.0 * (1.0 - material->poisson * material->poisson) * CLAMPED *
                         force * area / (material->young * deflection);
    return elementary_exp(elementary_log(cubed) / 3.0);
}

void rigidity_print(const struct job *job, const struct body *body,
                    const struct mesh_survey *survey, const struct materials *materials,
                    const struct limits_spheres *spheres)
{
    const struct job_material *material = &job->materials[body->material];
    const struct limits_strike strike =
        limits_hardest_strike(spheres, job, materials, body->material);
    const double weight = spheres->mass * gravity_most(job);
    const double force = weight > strike.force ? weight : strike.force;
    const double area = largest_facet(&body->mesh);
    if (!(strike.force > 0.0))
        return;
    const char *whose = force > strike.force ? "weight of all spheres" : "an impact";
    if (survey->closed && survey->n_turned == 0 && survey->volume > 0.0) {
        const double yields = block_yields(survey, material->young, force);
        report_say("          being rigid neglects about %.3g m, %.2g of the %.3g m by which "
                   "contacts yield: a block under %.3g N, %s",
                   yields, yields / strike.overlap, strike.overlap, force, whose);
    } else if (area > 0.0) {
        report_say("          being rigid neglects as much as contacts yield, %.3g m, where a "
                   "wall of the largest facet is about %.3g m thick: a plate under %.3g N, %s",
                   strike.overlap, thickness_for(material, area, force, strike.overlap), force,
                   whose);
    } else {
        report_say(
            "          contacts yield by %.3g m under %.3g N, an impact; what being rigid "
            "neglects is not known without a thickness",
            strike.overlap, strike.force);
    }
}
