/*
 * An elastic bar thrown at a wall.  Its end stops, a wave of compression runs to the other end
 * and back; so long, 2 L/c, the wall bears rho c v A, then the bar leaves at -v.  Poisson's
 * ratio is 0, which makes the bar one-dimensional; the wall is a spring as stiff as a cell.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../unit/solid_block.h"
#include "specimen.h"
#include "verify.h"

static const double LENGTH = 1.0, SIDE = 0.01, SPEED = 10.0;
static const struct solid_material steel = {7850.0, 2.1e11, 0.0, 0.0, 0.1, 0.0, 0, NULL, 0.0};

struct wall {
    int n;
    int *nodes;
    double stiffness; /* of each node [N/m] */
    double force;     /* now [N] */
};

static void push(struct specimen *specimen, void *what)
{
    struct wall *wall = what;
    wall->force = 0.0;
    for (int k = 0; k < wall->n; k++) {
        const int i = wall->nodes[k];
        const double depth = -solid_place(&specimen->solid, i)[0];
        if (depth > 0.0) {
            specimen->solid.contact[i][0] += wall->stiffness * depth;
            wall->force += wall->stiffness * depth;
        }
    }
}

static double mean_speed(const struct solid *solid)
{
    double momentum = 0.0, mass = 0.0;
    for (int i = 0; i < solid->n_nodes; i++) {
        momentum += solid->mass[i] * solid_velocity(solid, i)[0];
        mass += solid->mass[i];
    }
    return momentum / mass;
}

static void impact(int cells)
{
    const double c = sqrt(steel.young / steel.density), length = LENGTH / cells;
    const double expected = steel.density * c * SPEED * SIDE * SIDE, time = 2.0 * LENGTH / c;
    struct solid_block block;
    struct specimen specimen;
    struct wall wall;
    char text[128];
    solid_block_build(&block, cells, 1, 1, (const double[3]){LENGTH, SIDE, SIDE}, false);
    specimen_make(&specimen, &block.mesh, &steel, 0.7);
    wall.n = specimen_plane(&specimen, 0, 0.0, &wall.nodes);
    wall.stiffness = steel.young * SIDE * SIDE / length / wall.n;
    for (int i = 0; i < specimen.solid.n_nodes; i++)
        solid_velocity(&specimen.solid, i)[0] = -SPEED;
    double sum = 0.0, touched = 0.0;
    int n = 0;
    const struct solid_energies before = specimen_energies(&specimen);
    while ((double)specimen.step * specimen.dt < 1.5 * time) {
        specimen_pushed_steps(&specimen, 1, push, &wall);
        const double t = (double)specimen.step * specimen.dt;
        if (t > 0.1 * time && t < 0.9 * time) {
            sum += wall.force;
            n++;
        }
        touched = wall.force > 0.0 ? t : touched;
    }
    const struct solid_energies after = specimen_energies(&specimen);
    snprintf(text, sizeof text, "%d cells: mean force on the wall from .1 to .9 of 2 L/c",
             cells);
    verify_row(text, "N", expected, sum / n, 2.0 / cells, VERIFY_RELATIVE,
               "the wall and the front are some cells deep");
    snprintf(text, sizeof text, "%d cells: contact ends", cells);
    verify_row(text, "s", time, touched, 4.0 / cells, VERIFY_RELATIVE, "the same");
    snprintf(text, sizeof text, "%d cells: mean speed after", cells);
    verify_row(text, "m/s", SPEED, mean_speed(&specimen.solid), 2.0 / cells, VERIFY_RELATIVE,
               "what still swings in the bar, the front's ripples");
    snprintf(text, sizeof text, "%d cells: energy balance, over the energy", cells);
    verify_row(text, "", 0.0,
               (solid_energy_balance(&after) - solid_energy_balance(&before)) /
                   solid_energy_value(&before, SOLID_ENERGY_KINETIC),
               1e-12, VERIFY_ABSOLUTE, "rounding (12.14)");
    free(wall.nodes);
    specimen_free(&specimen);
    solid_block_free(&block);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Solids: a bar against a wall", "rho c v A for 2 L/c, then -v");
    impact(50);
    impact(200);
    return verify_end();
}
