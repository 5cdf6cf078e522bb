/* Solids: mass, who computes what, supports and loads over time, pressure, surfaces, energies,
 * failures, state that suffices to go on. */
#include "solid/solid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "job/job.h"
#include "solid/solid_energy.h"
#include "solid/solid_limits.h"
#include "solid/solid_side.h"
#include "solid/solid_surface.h"
#include "solid_block.h"

static const struct solid_yield_point curve[2] = {{0.0, 1e6}, {0.01, 2e6}};
static const struct solid_material stuff = {1000.0, 1e9, 0.3, 1e-6, 0.1, 0.05, 2, curve, 1e7};
static const struct solid_material elastic = {1000.0, 1e9, 0.3, 0.0, 0.1, 0.0, 0, NULL, 0.0};
static const double DT = 4e-5;
static uint64_t seed = 5;

/* A distorted block of 3 x 2 x 4 cells. */
static void make(struct solid *solid, struct solid_block *block, bool tetrahedra,
                 const struct solid_material *material)
{
    solid_block_build(block, 3, 2, 4, (const double[3]){3.0, 2.0, 4.0}, tetrahedra);
    solid_block_distort(block, 0.2, &seed);
    solid_create(solid, &block->mesh, 1, material, ISA_AUTO);
}

static void remove_all(struct solid *solid, struct solid_block *block)
{
    solid_destroy(solid);
    solid_block_free(block);
}

static void steps(struct solid *solid, int from, int to)
{
    for (int step = from; step < to; step++) {
        EXPECT(solid_forces(solid, step, DT));
        solid_move(solid, step, DT);
    }
}

static void shake(struct solid *solid, double speed)
{
    for (int i = 0; i < solid->n_nodes; i++)
        for (int d = 0; d < 3; d++)
            solid_velocity(solid, i)[d] = speed * solid_block_random(&seed);
}

TEST(mass_is_that_of_the_volume)
{
    for (int shape = 0; shape < 2; shape++) {
        struct solid solid;
        struct solid_block block;
        double mass = 0.0;
        make(&solid, &block, shape == 1, &elastic);
        for (int i = 0; i < solid.n_nodes; i++)
            mass += solid.mass[i];
        EXPECT_NEAR(mass, 24000.0, 1e-10);
        remove_all(&solid, &block);
    }
}

/* Two ranks, each with a part of the nodes, that give each other places and velocities. */
TEST(parts_give_the_same_bits)
{
    for (int shape = 0; shape < 2; shape++) {
        struct solid solid[3];
        struct solid_block block;
        bool *mine = NULL;
        make(&solid[0], &block, shape == 1, &stuff);
        shake(&solid[0], 10.0);
        mine = calloc((size_t)solid[0].n_nodes, sizeof *mine);
        for (int s = 1; s < 3; s++) {
            solid_create(&solid[s], &block.mesh, 1, &stuff, ISA_AUTO);
            memcpy(solid[s].node, solid[0].node,
                   (size_t)solid[0].n_nodes * sizeof *solid[0].node);
            for (int i = 0; i < solid[0].n_nodes; i++)
                mine[i] = (solid[0].reference[i][0] > 1.4) == (s == 1);
            solid_assign(&solid[s], mine);
        }
        const int n_all = solid[0].n_listed, n_part = solid[1].n_listed;
        EXPECT(n_part < n_all && n_part > 0);
        for (int step = 0; step < 20; step++) {
            for (int s = 0; s < 3; s++) {
                EXPECT(solid_forces(&solid[s], step, DT));
                solid_move(&solid[s], step, DT);
            }
            for (int i = 0; i < solid[0].n_nodes; i++) {
                const int owner = solid[1].moves[i] ? 1 : 2;
                solid[3 - owner].node[i] = solid[owner].node[i];
                EXPECT(memcmp(&solid[0].node[i], &solid[owner].node[i],
                              sizeof solid[0].node[i]) == 0);
            }
        }
        /* Together they count what the whole one does. */
        struct solid_energies whole = {0}, parts = {0};
        for (int s = 0; s < 3; s++) {
            EXPECT(solid_forces(&solid[s], 20, DT));
            solid_energies_add(&solid[s], 20, DT, s == 0 ? &whole : &parts);
        }
        for (int k = 0; k < SOLID_N_ENERGIES; k++)
            EXPECT(solid_energy_value(&whole, (enum solid_energy)k) ==
                   solid_energy_value(&parts, (enum solid_energy)k));
        EXPECT(solid_energy_value(&whole, SOLID_ENERGY_PLASTIC) > 0.0);
        free(mine);
        for (int s = 2; s >= 0; s--)
            solid_destroy(&solid[s]);
        solid_block_free(&block);
    }
}

/* The same with every compiler and instruction set: FNV-1a of places, velocities and states. */
TEST(bits_are_known)
{
    static const uint64_t expected[2] = {0x57cb88205c24aadeu, 0x6e85bfd1aa02b592u};
    seed = 77;
    for (int shape = 0; shape < 2; shape++) {
        struct solid solid;
        struct solid_block block;
        uint64_t hash = 14695981039346656037u;
        make(&solid, &block, shape == 1, &stuff);
        shake(&solid, 10.0);
        steps(&solid, 0, 50);
        for (int i = 0; i < solid.n_nodes; i++)
            for (size_t k = 0; k < sizeof solid.node[i]; k++)
                hash = (hash ^ ((unsigned char *)&solid.node[i])[k]) * 1099511628211u;
        for (int e = 0; e < solid.n_elements; e++)
            for (size_t k = 0; k < sizeof solid.state[e]; k++)
                hash = (hash ^ ((unsigned char *)&solid.state[e])[k]) * 1099511628211u;
        if (hash != expected[shape])
            CHECK_FAIL("shape %d: %#llx", shape, (unsigned long long)hash);
        remove_all(&solid, &block);
    }
}

static void copy_field(struct field_view to, struct field_view from, const struct field *field,
                       int n)
{
    for (int i = 0; i < n; i++)
        memcpy(field_at(&to, i), field_at(&from, i), field_size(field));
}

/* What the field tables hold suffices to go on with the same bits. */
TEST(fields_are_all_the_state)
{
    struct solid first, second;
    struct solid_block block;
    make(&first, &block, false, &stuff);
    const int base[2] = {0, 1};
    const struct solid_table table = {2, (struct solid_table_point[]){{0.0, 0.0}, {1.0, 9.0}}};
    solid_create(&second, &block.mesh, 1, &stuff, ISA_AUTO);
    solid_supports_add(&first.supports, SOLID_SUPPORT_VELOCITY, 1, &table, 2, base);
    solid_supports_add(&second.supports, SOLID_SUPPORT_VELOCITY, 1, &table, 2, base);
    shake(&first, 10.0);
    solid_kill(&first, 7);
    solid_assign(&first, NULL);
    steps(&first, 0, 30);
    for (int f = 0; f < SOLID_NODE_N_PLAIN; f++)
        copy_field(solid_node_view(&second, (enum solid_node_field)f),
                   solid_node_view(&first, (enum solid_node_field)f), &solid_node_fields[f],
                   first.n_nodes);
    for (int f = 0; f < SOLID_ELEMENT_N_PLAIN; f++)
        copy_field(solid_element_view(&second, (enum solid_element_field)f),
                   solid_element_view(&first, (enum solid_element_field)f),
                   &solid_element_fields[f], first.n_elements);
    solid_assign(&second, NULL);
    steps(&first, 30, 60);
    steps(&second, 30, 60);
    EXPECT(memcmp(first.node, second.node, (size_t)first.n_nodes * sizeof *first.node) == 0);
    EXPECT(memcmp(first.work, second.work, (size_t)first.n_nodes * sizeof *first.work) == 0);
    for (int e = 0; e < first.n_elements; e++)
        if (first.alive[e])
            EXPECT(memcmp(&first.state[e], &second.state[e], sizeof first.state[e]) == 0);
    solid_destroy(&second);
    remove_all(&first, &block);
}

TEST(tables_over_time)
{
    struct solid_table_point points[3] = {{1.0, 2.0}, {2.0, 6.0}, {4.0, 0.0}};
    const struct solid_table table = {3, points}, none = {0, NULL};
    EXPECT(solid_table_value(&table, 0.0) == 2.0 && solid_table_value(&table, 5.0) == 0.0);
    EXPECT_NEAR(solid_table_value(&table, 1.25), 3.0, 1e-15);
    EXPECT_NEAR(solid_table_value(&table, 3.0), 3.0, 1e-15);
    EXPECT(solid_table_value(&none, 3.0) == 1.0 && solid_table_integral(&none, 3.0) == 3.0);
    EXPECT_NEAR(solid_table_integral(&table, 1.0), 2.0, 1e-15);
    EXPECT_NEAR(solid_table_integral(&table, 1.5), 2.0 + 1.5, 1e-15);
    EXPECT_NEAR(solid_table_integral(&table, 4.0), 2.0 + 4.0 + 6.0, 1e-15);
    EXPECT_NEAR(solid_table_integral(&table, 9.0), 12.0, 1e-15);
    points[0].time = -1.0; /* 2 at -1, 6 at 2: 10/3 at 0 */
    EXPECT_NEAR(solid_table_integral(&table, 2.0), (10.0 / 3.0 + 6.0), 1e-14);
}

/* Places are functions of the step, whatever came before. */
TEST(supports_hold_and_move)
{
    struct solid solid;
    struct solid_block block;
    make(&solid, &block, false, &elastic);
    const int held[3] = {0, 1, 2}, turned = solid.n_nodes - 1;
    const struct solid_table shift = {
        3, (struct solid_table_point[]){{0.0, 0.5}, {20 * DT, 0.501}, {1.0, 0.501}}};
    const struct solid_table speed = {1, (struct solid_table_point[]){{0.0, 3.0}}};
    const struct job_motion motion = {.axis = {0.0, 0.0, 1.0}, .rate = 2.0, .stop = 1e9};
    solid_supports_add(&solid.supports, SOLID_SUPPORT_DISPLACEMENT, 0, &shift, 3, held);
    solid_supports_add(&solid.supports, SOLID_SUPPORT_VELOCITY, 1, &speed, 3, held);
    solid_supports_add(&solid.supports, SOLID_SUPPORT_FIXED, 2, NULL, 3, held);
    solid_supports_add_motion(&solid.supports, 1, &motion, 1, &turned);
    for (int n = 0; n <= 40; n++) {
        const double *x = solid_place(&solid, 1), *X = solid.reference[1];
        const double ramp = n < 20 ? 0.001 * n / 20.0 : 0.001;
        EXPECT_NEAR(x[0] - X[0], ramp, 1e-15);
        EXPECT_NEAR(x[1] - X[1], 3.0 * DT * n, 1e-15);
        EXPECT(x[2] == X[2]);
        const double *y = solid_place(&solid, turned), *Y = solid.reference[turned];
        const double angle = 2.0 * DT * n;
        EXPECT_NEAR(y[0], cos(angle) * Y[0] - sin(angle) * Y[1], 1e-14);
        EXPECT_NEAR(y[1], sin(angle) * Y[0] + cos(angle) * Y[1], 1e-14);
        EXPECT(y[2] == Y[2]);
        steps(&solid, n, n + 1);
        EXPECT_NEAR(solid_velocity(&solid, 1)[1], 3.0, 1e-10);
    }
    remove_all(&solid, &block);
}

/* Pressure all around a distorted solid, against the stress that balances it. */
TEST(pressure_balances_uniform_stress)
{
    for (int shape = 0; shape < 2; shape++) {
        struct solid solid;
        struct solid_block block;
        struct solid_surface surface = {0};
        make(&solid, &block, shape == 1, &elastic);
        /* Sides warped too. */
        for (int i = 0; i < solid.n_nodes; i++)
            for (int d = 0; d < 3; d++)
                solid_place(&solid, i)[d] += 0.1 * solid_block_random(&seed);
        solid_surface_build(&surface, &solid);
        struct solid_side *sides = calloc((size_t)surface.n, sizeof *sides);
        for (int k = 0; k < surface.n; k++)
            sides[k] = (struct solid_side){surface.faces[k].element, surface.faces[k].side};
        const struct solid_table table = {2,
                                          (struct solid_table_point[]){{0.0, 2.0}, {1.0, 4.0}}};
        solid_loads_add_pressure(&solid.loads, 100.0, &table, surface.n, sides);
        for (int e = 0; e < solid.n_elements; e++)
            for (int k = 0; k < 3; k++)
                solid.state[e].stress[k] = -300.0;
        EXPECT(solid_forces(&solid, 0, DT));
        double unbalanced = 0.0, largest = 0.0;
        memset(solid.external, 0, (size_t)solid.n_nodes * sizeof *solid.external);
        solid_loads_apply(&solid, 0.5, solid.external); /* factor 3 */
        for (int i = 0; i < solid.n_nodes; i++)
            for (int d = 0; d < 3; d++) {
                const double rest = fabs(solid.internal[i][d] + solid.external[i][d]);
                unbalanced = rest > unbalanced ? rest : unbalanced;
                largest =
                    fabs(solid.external[i][d]) > largest ? fabs(solid.external[i][d]) : largest;
            }
        EXPECT(largest > 50.0);
        EXPECT(unbalanced < 1e-11);
        free(sides);
        solid_surface_clear(&surface);
        remove_all(&solid, &block);
    }
}

/* Area of the surface along its normals, and volume by x . n / 3. */
static void expect_closed(const struct solid *solid, const struct solid_surface *surface,
                          double volume)
{
    double sum[3] = {0.0, 0.0, 0.0}, enclosed = 0.0;
    for (int k = 0; k < surface->n; k++) {
        const struct solid_surface_face *face = &surface->faces[k];
        double x[SOLID_SIDE_NODES][3], area[SOLID_SIDE_NODES][3];
        for (int c = 0; c < face->n; c++)
            memcpy(x[c], solid_place(solid, face->nodes[c]), sizeof x[c]);
        solid_side_areas(face->n, x, area);
        for (int c = 0; c < face->n; c++)
            for (int d = 0; d < 3; d++) {
                sum[d] += area[c][d];
                enclosed += area[c][d] * x[c][d] / 3.0;
            }
        if (k > 0) {
            const struct solid_surface_face *before = face - 1;
            EXPECT(before->element < face->element ||
                   (before->element == face->element && before->side < face->side));
        }
    }
    for (int d = 0; d < 3; d++)
        EXPECT_NEAR(sum[d], 0.0, 1e-12);
    EXPECT_NEAR(enclosed, volume, 1e-11);
}

TEST(surfaces_of_blocks)
{
    for (int shape = 0; shape < 2; shape++) {
        struct solid solid;
        struct solid_block block;
        struct solid_surface surface = {0};
        make(&solid, &block, shape == 1, &elastic);
        solid_surface_build(&surface, &solid);
        EXPECT(surface.n == 2 * (3 * 2 + 2 * 4 + 4 * 3) * (shape == 1 ? 2 : 1));
        expect_closed(&solid, &surface, 24.0);
        solid_surface_clear(&surface);
        remove_all(&solid, &block);
    }
}

TEST(surfaces_grow_where_elements_die)
{
    struct solid solid;
    struct solid_block block;
    struct solid_surface surface = {0};
    solid_block_build(&block, 3, 3, 3, (const double[3]){3.0, 3.0, 3.0}, false);
    solid_create(&solid, &block.mesh, 1, &elastic, ISA_AUTO);
    solid_surface_build(&surface, &solid);
    EXPECT(surface.n == 54);
    solid_kill(&solid, 13); /* the middle one: six walls of a void */
    solid_assign(&solid, NULL);
    solid_surface_build(&surface, &solid);
    EXPECT(surface.n == 60);
    expect_closed(&solid, &surface, 26.0);
    solid_kill(&solid, 0); /* a corner: three away, three new */
    solid_surface_build(&surface, &solid);
    EXPECT(surface.n == 60);
    expect_closed(&solid, &surface, 25.0);
    steps(&solid, 0, 3);
    solid_surface_clear(&surface);
    remove_all(&solid, &block);
}

/* An alternating motion of one corner turns its element inside out. */
TEST(failures_have_a_place)
{
    struct solid solid;
    struct solid_block block;
    solid_block_build(&block, 3, 3, 3, (const double[3]){3.0, 3.0, 3.0}, false);
    solid_create(&solid, &block.mesh, 1, &elastic, ISA_AUTO);
    EXPECT(solid_forces(&solid, 0, DT));
    EXPECT(solid_limits_fault(&solid, DT).failure == SOLID_LIMITS_FINE);
    solid_place(&solid, solid.n_nodes - 1)[2] -= 9.0;
    EXPECT(!solid_forces(&solid, 1, DT));
    struct solid_limits_fault fault = solid_limits_fault(&solid, DT);
    EXPECT(fault.failure == SOLID_LIMITS_INVERTED && fault.element == 26 && fault.value < 0.0);
    EXPECT_NEAR(fault.place.x, 2.5, 1e-15);
    solid_place(&solid, solid.n_nodes - 1)[2] += 9.0;
    solid_velocity(&solid, 0)[2] = -9.0 / DT; /* half a step back it was far inside */
    EXPECT(!solid_forces(&solid, 1, DT));
    fault = solid_limits_fault(&solid, DT);
    EXPECT(fault.failure == SOLID_LIMITS_INVERTED && fault.element == 0);
    solid_velocity(&solid, 0)[2] = (double)NAN;
    EXPECT(!solid_forces(&solid, 1, DT));
    fault = solid_limits_fault(&solid, DT);
    EXPECT(fault.failure == SOLID_LIMITS_NOT_A_NUMBER && fault.element == 0);
    solid.state[5].hourglass_work = 2.0;
    EXPECT(solid_limits_hourglass(&solid, 2.0, 30.0, 0.1).failure == SOLID_LIMITS_FINE);
    fault = solid_limits_hourglass(&solid, 4.0, 30.0, 0.1);
    EXPECT(fault.failure == SOLID_LIMITS_HOURGLASS && fault.element == 5);
    remove_all(&solid, &block);
}

TEST(the_smallest_element_limits_the_step)
{
    struct solid solid;
    struct solid_block block;
    solid_block_build(&block, 4, 1, 1, (const double[3]){4.0, 1.0, 1.0}, false);
    for (int i = 0; i < block.mesh.n_nodes; i++)
        if (block.mesh.places[i][0] == 3.0)
            block.mesh.places[i][0] = 2.5;
    solid_create(&solid, &block.mesh, 1, &elastic, ISA_AUTO);
    struct solid_limits limits = solid_limits_find(&solid, NULL, NULL);
    EXPECT(limits.element == 2 && limits.node == -1);
    double *stiffness = calloc((size_t)solid.n_nodes, sizeof *stiffness);
    const int node = solid_block_node(&block, 4, 1, 0);
    stiffness[node] = 1e12;
    const struct solid_limits soft = limits;
    limits = solid_limits_find(&solid, stiffness, NULL);
    EXPECT(limits.element == 3 && limits.node == node && limits.step < 0.5 * soft.step);
    /* A spring so stiff that it alone counts. */
    EXPECT_NEAR(limits.step / (2.0 * sqrt(solid.mass[node] / 1e12)), 1.0, 0.01);
    free(stiffness);
    remove_all(&solid, &block);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
