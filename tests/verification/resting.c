/* See resting.h. */
#include "resting.h"

#include <math.h>
#include <stdlib.h>

#include "run/simulation.h"
#include "verify.h"

const double resting_radius = 0.01, resting_gravity = 9.81, resting_step = 5e-6;

const struct impact_solid resting_solid = {1e9, 0.25, 2500.0};

double resting_overlap(const struct resting *resting)
{
    const struct impact_solid *stone = &resting_solid;
    const double weight =
        impact_mass(stone, resting_radius) * resting_gravity * cos(resting->angle);
    if (resting->stiffness > 0.0)
        return weight / resting->stiffness;
    return pow(0.75 * weight / (impact_modulus(stone, stone) * sqrt(resting_radius)),
               2.0 / 3.0);
}

struct simulation *resting_scene(const struct resting *resting)
{
    const double down = resting_gravity * cos(resting->angle),
                 along = resting_gravity * sin(resting->angle);
    const double overlap = resting_overlap(resting);
    char *sphere = verify_sphere("ball", "stone", resting_radius,
                                 (struct vec3){0.0, 0.0, resting_radius - overlap},
                                 (struct vec3){resting->speed, 0.0, 0.0}, resting->spin);
    struct simulation *sim = verify_scene(
        resting_step,
        "gravity: [%.17g, 0, %.17g]\ndomain: {leavers: ignore}\n"
        "output: {series: {every: 1.0e+9}}\n"
        "materials:\n  stone: {density: %.17g, young: %.17g, poisson: %.17g}\n"
        "contact:\n  pairs:\n"
        "    - {between: [stone, stone], friction: %.17g, restitution: 0.5%s}\n"
        "spheres:\n%sbodies:\n  - {name: plane, material: stone, geometry: "
        "{kind: plane, point: [0, 0, 0], normal: [0, 0, 1], extent: 100}}\n",
        along, -down, resting_solid.density, resting_solid.young, resting_solid.poisson,
        resting->friction, resting->more != NULL ? resting->more : "", sphere);
    free(sphere);
    return sim;
}

void resting_slide(struct simulation *sim, int n)
{
    for (int k = 0; k < n; k++) {
        verify_steps(sim, 1);
        double *spin = sim->spheres.spin[verify_index(sim, 0)].lane;
        spin[0] = spin[1] = spin[2] = spin[4] = spin[5] = spin[6] = 0.0;
    }
}
