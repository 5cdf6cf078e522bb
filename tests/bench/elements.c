/*
 * What elements of solids, shells and membranes cost on one core: `make bench-elements`.
 *
 * A block of hexahedra or tetrahedra or a sheet shakes; timed are solid_forces(), of which almost all is
 * the element kernel, and solid_move(). Each figure is the best of several tries, as other work
 * on the machine only slows it down.
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "../unit/shell_sheet.h"
#include "../unit/solid_block.h"
#include "solid/solid_limits.h"

enum { TRIES = 5, UPDATES = 600000 /* a try */ };
static const struct solid_yield_point yield[3] = {{0.0, 1e6}, {0.01, 2e6}, {0.1, 3e6}};
static const struct solid_material elastic = {1000.0, 1e9, 0.3, 0.0, 0.1, 0.05, 0, NULL, 0.0};
static const struct solid_material plastic = {1000.0, 1e9, 0.3, 0.0, 0.1, 0.05, 3, yield, 1e7};

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

struct cost {
    double forces, move; /* of an element [ns] */
};

static void measure(struct solid *solid, double dt, struct cost *best)
{
    const int n_steps = 1 + UPDATES / solid->n_elements;
    int64_t step = 1;
    *best = (struct cost){1e9, 1e9};
    for (int try = 0; try < TRIES; try++) {
        struct cost cost = {0.0, 0.0};
        for (int k = 0; k < n_steps; k++) {
            const double began = now();
            if (!solid_forces(solid, step, dt)) {
                fputs("an element failed\n", stderr);
                exit(1);
            }
            const double between = now();
            solid_move(solid, step++, dt);
            cost.forces += between - began;
            cost.move += now() - between;
        }
        const double each = 1e9 / ((double)n_steps * solid->n_elements);
        best->forces = cost.forces * each < best->forces ? cost.forces * each : best->forces;
        best->move = cost.move * each < best->move ? cost.move * each : best->move;
    }
}

static void print(const char *name, const struct solid *solid, bool flows, enum isa isa,
                  const struct cost *cost)
{
    printf("| %d %s, %s | %s | %.1f | %.1f | %.1f |\n", solid->n_elements, name,
           flows ? "plastic" : "elastic", isa_name(isa), cost->forces, cost->move,
           1e3 / (cost->forces + cost->move));
    fflush(stdout);
}

/* From nodes at rest, shaken by a little. */
static void run(const char *name, struct solid *solid, double speed, bool flows, enum isa isa)
{
    struct cost cost;
    uint64_t seed = 1;
    for (int i = 0; i < solid->n_nodes; i++)
        for (int d = 0; d < 3; d++)
            solid_velocity(solid, i)[d] = speed * solid_block_random(&seed);
    measure(solid, 0.5 * solid_limits_find(solid, NULL, NULL).step, &cost);
    print(name, solid, flows, isa, &cost);
}

static void row(int cells, bool tetrahedra, const struct solid_material *material, enum isa isa)
{
    struct solid_block block;
    struct solid solid;
    uint64_t seed = 1;
    solid_block_build(&block, cells, cells, cells, (const double[3]){cells, cells, cells},
                      tetrahedra);
    solid_block_distort(&block, 0.08, &seed);
    solid_create(&solid, &block.mesh, 1, material, isa);
    run(tetrahedra ? "tetrahedra" : "hexahedra", &solid, 1.0, material->n_yield > 0, isa);
    solid_destroy(&solid);
    solid_block_free(&block);
}

/* Layers of a shell; 0: a membrane. */
static void sheet_row(int cells, bool triangles, int layers,
                      const struct solid_material *material, enum isa isa)
{
    static const enum solid_element_shape shapes[2][2] = {
        {SOLID_ELEMENT_MEMBRANE_QUAD, SOLID_ELEMENT_MEMBRANE_TRIANGLE},
        {SOLID_ELEMENT_SHELL_QUAD, SOLID_ELEMENT_SHELL_TRIANGLE}};
    struct shell_sheet sheet;
    struct solid solid;
    uint64_t seed = 1;
    char name[64];
    shell_sheet_build(&sheet, cells, cells, (const double[2]){cells, cells},
                      shapes[layers > 0][triangles], 0.1, layers > 0 ? layers : 1);
    shell_sheet_distort(&sheet, 0.08, &seed);
    solid_create(&solid, &sheet.mesh, 1, material, isa);
    snprintf(name, sizeof name, layers > 0 ? "shell %s, %d layers" : "membrane %s",
             triangles ? "triangles" : "quads", layers);
    run(name, &solid, 0.1, material->n_yield > 0, isa);
    solid_destroy(&solid);
    shell_sheet_free(&sheet);
}

int main(void)
{
    puts(
        "| elements | instruction set | forces [ns] | move [ns] | million element-updates/s |");
    puts("| --- | --- | --- | --- | --- |");
    for (int isa = ISA_V4; isa > ISA_AUTO; isa--)
        if (isa_runs((enum isa)isa)) {
            row(10, false, &elastic, (enum isa)isa);
            row(10, false, &plastic, (enum isa)isa);
            row(60, false, &elastic, (enum isa)isa);
            row(60, false, &plastic, (enum isa)isa);
            row(6, true, &elastic, (enum isa)isa);
            row(36, true, &elastic, (enum isa)isa);
            sheet_row(32, false, 2, &elastic, (enum isa)isa);
            sheet_row(32, false, 5, &elastic, (enum isa)isa);
            sheet_row(32, false, 5, &plastic, (enum isa)isa);
            sheet_row(450, false, 5, &elastic, (enum isa)isa);
            sheet_row(22, true, 2, &elastic, (enum isa)isa);
            sheet_row(32, false, 0, &elastic, (enum isa)isa);
            sheet_row(22, true, 0, &elastic, (enum isa)isa);
        }
    return 0;
}
