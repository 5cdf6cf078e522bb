/* Shells and membranes: strains of rigid motion, forces against work, all instruction sets, who
 * computes what, state that suffices, plane plastic flow against closed forms, the bound on the
 * frequency against the frequency. */
#include "physics/shell_element.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "physics/shell_geometry.h"
#include "shell_sheet.h"
#include "solid/solid_energy.h"
#include "solid/solid_limits.h"
#include "solid/solid_surface.h"

enum { N_SHAPES = 4, STRAINS = SHELL_GEOMETRY_STRAINS };
static const enum solid_element_shape shapes[N_SHAPES] = {
    SOLID_ELEMENT_SHELL_QUAD, SOLID_ELEMENT_SHELL_TRIANGLE, SOLID_ELEMENT_MEMBRANE_QUAD,
    SOLID_ELEMENT_MEMBRANE_TRIANGLE};
static const struct solid_yield_point curve[2] = {{0.0, 1e6}, {0.01, 2e6}};
static const struct solid_material stuff = {1000.0, 1e9, 0.3, 1e-6, 0.5, 0.0, 2, curve, 1e7};
static const struct solid_material elastic = {1000.0, 1e9, 0.3, 0.0, 1.0, 0.0, 0, NULL, 0.0};
static const double DT = 2e-5;
static uint64_t seed = 5;

/* --------------------------------------------------------------- strains and forces */

static void random_vectors(int n, double v[][3], double size)
{
    for (int c = 0; c < n; c++)
        for (int d = 0; d < 3; d++)
            v[c][d] = size * solid_block_random(&seed);
}

/* A warped quadrilateral, or its first three corners. */
static void random_corners(double x[4][3])
{
    static const double xi[4] = {-1, 1, 1, -1}, eta[4] = {-1, -1, 1, 1};
    random_vectors(4, x, 0.3);
    for (int c = 0; c < 4; c++) {
        const double a = x[c][0] + xi[c], b = x[c][1] + 0.7 * eta[c], h = x[c][2];
        x[c][0] = 0.6 * a - 0.8 * h; /* anyhow in space */
        x[c][1] = b + 5.0;
        x[c][2] = 0.8 * a + 0.6 * h;
    }
}

static void strains_of(enum solid_element_shape shape, const struct shell_geometry *g,
                       double moved[4][3], double turned[4][3], double strain[STRAINS])
{
    memset(strain, 0, STRAINS * sizeof *strain);
    if (shape == SOLID_ELEMENT_SHELL_QUAD)
        shell_geometry_quad_strain(g, moved, turned, strain);
    else if (shape == SOLID_ELEMENT_SHELL_TRIANGLE)
        shell_geometry_triangle_strain(g, moved, turned, strain);
    else if (shape == SOLID_ELEMENT_MEMBRANE_QUAD)
        shell_geometry_quad_stretch(g, moved, strain);
    else
        shell_geometry_triangle_stretch(g, moved, strain);
}

static void forces_of(enum solid_element_shape shape, const struct shell_geometry *g,
                      const double f[STRAINS], double force[4][3], double moment[4][3])
{
    memset(force, 0, 4 * sizeof *force);
    memset(moment, 0, 4 * sizeof *moment);
    if (shape == SOLID_ELEMENT_SHELL_QUAD)
        shell_geometry_quad_resist(g, f, force, moment);
    else if (shape == SOLID_ELEMENT_SHELL_TRIANGLE)
        shell_geometry_triangle_resist(g, f, force, moment);
    else if (shape == SOLID_ELEMENT_MEMBRANE_QUAD)
        shell_geometry_quad_pull(g, f, force);
    else
        shell_geometry_triangle_pull(g, f, force);
}

static void geometry_of(enum solid_element_shape shape, double x[4][3],
                        struct shell_geometry *g)
{
    if (solid_element_corners(shape) == 3)
        shell_geometry_triangle(x, g);
    else
        shell_geometry_quad(x, g);
}

TEST(rigid_motion_strains_nothing)
{
    for (int round = 0; round < 80; round++) {
        const enum solid_element_shape shape = shapes[round % N_SHAPES];
        struct shell_geometry g;
        double x[4][3], moved[4][3], turned[4][3], strain[STRAINS], rigid[2][3];
        random_corners(x);
        random_vectors(2, rigid, 1.0);
        for (int c = 0; c < 4; c++) {
            memcpy(turned[c], rigid[1], sizeof turned[c]);
            solid_gradient_cross(moved[c], rigid[1], x[c]);
            for (int d = 0; d < 3; d++)
                moved[c][d] += rigid[0][d];
        }
        geometry_of(shape, x, &g);
        strains_of(shape, &g, moved, turned, strain);
        for (int k = 0; k < STRAINS; k++)
            EXPECT_NEAR(strain[k], 0.0, 1e-13);
    }
}

/* Forces do with any motion what their strains do, and balance on the element. */
TEST(forces_do_the_work_of_strains)
{
    for (int round = 0; round < 80; round++) {
        const enum solid_element_shape shape = shapes[round % N_SHAPES];
        struct shell_geometry g;
        double x[4][3], moved[4][3], turned[4][3], strain[STRAINS], f[STRAINS];
        double force[4][3], moment[4][3], inside = 0.0, outside = 0.0;
        double sum[3] = {0.0}, about[3] = {0.0};
        random_corners(x);
        random_vectors(4, moved, 1.0);
        random_vectors(4, turned, 1.0);
        geometry_of(shape, x, &g);
        strains_of(shape, &g, moved, turned, strain);
        for (int k = 0; k < STRAINS; k++) {
            f[k] = solid_block_random(&seed);
            inside += f[k] * strain[k];
        }
        forces_of(shape, &g, f, force, moment);
        for (int c = 0; c < 4; c++) {
            double arm[3];
            solid_gradient_cross(arm, x[c], force[c]);
            for (int d = 0; d < 3; d++) {
                outside += force[c][d] * moved[c][d] + moment[c][d] * turned[c][d];
                sum[d] += force[c][d];
                about[d] += arm[d] + moment[c][d];
            }
        }
        EXPECT_NEAR(inside, outside, 1e-13);
        for (int d = 0; d < 3; d++) {
            EXPECT_NEAR(sum[d], 0.0, 1e-14);
            EXPECT_NEAR(about[d], 0.0, 1e-13);
        }
    }
}

/* ------------------------------------------------------------------- whole sheets */

/* A warped sheet of 5 x 4 cells that is shaken. */
static void make(struct solid *solid, struct shell_sheet *sheet, enum solid_element_shape shape,
                 const struct solid_material *material, enum isa isa)
{
    uint64_t own = 3;
    shell_sheet_build(sheet, 5, 4, (const double[2]){5.0, 4.0}, shape, 0.1, 3);
    shell_sheet_distort(sheet, 0.2, &own);
    for (int i = 0; i < sheet->mesh.n_nodes; i++)
        sheet->mesh.places[i][2] = 0.2 * solid_block_random(&own);
    solid_create(solid, &sheet->mesh, 1, material, isa);
    for (int i = 0; i < solid->n_nodes; i++)
        for (int d = 0; d < 3; d++) {
            solid_velocity(solid, i)[d] = 10.0 * solid_block_random(&own);
            if (shell_element_turns(shape))
                solid_turn_spin(&solid->turns, i)[d] = 10.0 * solid_block_random(&own);
        }
}

static void remove_all(struct solid *solid, struct shell_sheet *sheet)
{
    solid_destroy(solid);
    shell_sheet_free(sheet);
}

static void steps(struct solid *solid, int from, int to)
{
    for (int step = from; step < to; step++) {
        EXPECT(solid_forces(solid, step, DT));
        solid_move(solid, step, DT);
    }
}

static bool are_same(const struct solid *a, const struct solid *b)
{
    const size_t n = (size_t)a->n_nodes, n_elements = (size_t)a->n_elements;
    return memcmp(a->node, b->node, n * sizeof *a->node) == 0 &&
           memcmp(a->work, b->work, n * sizeof *a->work) == 0 &&
           (a->turns.n_nodes == 0 ||
            memcmp(a->turns.spin, b->turns.spin, n * sizeof *a->turns.spin) == 0) &&
           memcmp(a->state, b->state, n_elements * sizeof *a->state) == 0 &&
           memcmp(a->shell, b->shell, n_elements * sizeof *a->shell) == 0;
}

TEST(all_instruction_sets_give_the_same_bits)
{
    for (int k = 0; k < N_SHAPES; k++)
        for (int isa = ISA_AUTO + 1; isa < ISA_N; isa++) {
            struct solid first, other;
            struct shell_sheet sheet, same;
            if (!isa_runs((enum isa)isa))
                continue;
            make(&first, &sheet, shapes[k], &stuff, ISA_AUTO);
            make(&other, &same, shapes[k], &stuff, (enum isa)isa);
            steps(&first, 0, 40);
            steps(&other, 0, 40);
            EXPECT(are_same(&first, &other));
            EXPECT(first.state[0].plastic_strain > 0.0);
            remove_all(&first, &sheet);
            remove_all(&other, &same);
        }
}

static uint64_t hash_of(uint64_t hash, const void *bytes, size_t n)
{
    for (size_t k = 0; k < n; k++)
        hash = (hash ^ ((const unsigned char *)bytes)[k]) * 1099511628211u;
    return hash;
}

/* The same with every compiler: FNV-1a of places, velocities and states. */
TEST(bits_are_known)
{
    static const uint64_t expected[N_SHAPES] = {0x338bd388a5064964u, 0xedd7d0b3ce4fecf5u,
                                                0xe9cdee1248b425adu, 0x602aa242b81f59f8u};
    for (int k = 0; k < N_SHAPES; k++) {
        struct solid solid;
        struct shell_sheet sheet;
        uint64_t hash = 14695981039346656037u;
        make(&solid, &sheet, shapes[k], &stuff, ISA_AUTO);
        steps(&solid, 0, 50);
        hash = hash_of(hash, solid.node, (size_t)solid.n_nodes * sizeof *solid.node);
        hash = hash_of(hash, solid.state, (size_t)solid.n_elements * sizeof *solid.state);
        hash = hash_of(hash, solid.shell, (size_t)solid.n_elements * sizeof *solid.shell);
        if (hash != expected[k])
            CHECK_FAIL("shape %d: %#llx", k, (unsigned long long)hash);
        remove_all(&solid, &sheet);
    }
}

/* Two ranks, each with a part of the nodes, that give each other places and velocities. */
TEST(parts_give_the_same_bits)
{
    struct solid solid[3];
    struct shell_sheet sheet[3];
    bool *mine = NULL;
    for (int s = 0; s < 3; s++)
        make(&solid[s], &sheet[s], SOLID_ELEMENT_SHELL_QUAD, &stuff, ISA_AUTO);
    const int n = solid[0].n_nodes;
    mine = calloc((size_t)n, sizeof *mine);
    for (int s = 1; s < 3; s++) {
        for (int i = 0; i < n; i++)
            mine[i] = (solid[0].reference[i][0] > 2.2) == (s == 1);
        solid_assign(&solid[s], mine);
    }
    for (int step = 0; step < 20; step++) {
        for (int s = 0; s < 3; s++)
            steps(&solid[s], step, step + 1);
        for (int i = 0; i < n; i++) {
            const int owner = solid[1].moves[i] ? 1 : 2;
            solid[3 - owner].node[i] = solid[owner].node[i];
            solid[3 - owner].turns.spin[i] = solid[owner].turns.spin[i];
            EXPECT(memcmp(&solid[0].node[i], &solid[owner].node[i], sizeof *solid[0].node) ==
                   0);
            EXPECT(memcmp(&solid[0].turns.spin[i], &solid[owner].turns.spin[i],
                          sizeof *solid[0].node) == 0);
        }
    }
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
        remove_all(&solid[s], &sheet[s]);
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
    struct shell_sheet sheet, same;
    make(&first, &sheet, SOLID_ELEMENT_SHELL_QUAD, &stuff, ISA_AUTO);
    make(&second, &same, SOLID_ELEMENT_SHELL_QUAD, &stuff, ISA_AUTO);
    solid_kill(&first, 7);
    solid_assign(&first, NULL);
    steps(&first, 0, 30);
    for (int f = 0; f < SOLID_NODE_N_FIELDS; f++)
        copy_field(solid_node_view(&second, (enum solid_node_field)f),
                   solid_node_view(&first, (enum solid_node_field)f), &solid_node_fields[f],
                   first.n_nodes);
    for (int f = 0; f < SOLID_ELEMENT_N_FIELDS; f++)
        copy_field(solid_element_view(&second, (enum solid_element_field)f),
                   solid_element_view(&first, (enum solid_element_field)f),
                   &solid_element_fields[f], first.n_elements);
    solid_assign(&second, NULL);
    steps(&first, 30, 60);
    steps(&second, 30, 60);
    first.state[7] = second.state[7]; /* dead: volume and the like are of no use */
    first.shell[7] = second.shell[7];
    EXPECT(are_same(&first, &second));
    remove_all(&second, &same);
    remove_all(&first, &sheet);
}

/* A cube of one hexahedron with a shell on its top, another that sticks out, and a membrane on
 * its foot: mass, turning, surface. */
TEST(solids_and_shells_share_nodes)
{
    double places[10][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1},
                            {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {2, 0, 1}, {2, 1, 1}};
    int corners[4][8] = {{0, 1, 2, 3, 4, 5, 6, 7}, {4, 5, 6, 7}, {5, 8, 9, 6}, {0, 1, 2, 3}};
    const enum solid_element_shape kinds[4] = {
        SOLID_ELEMENT_HEXAHEDRON, SOLID_ELEMENT_SHELL_QUAD, SOLID_ELEMENT_SHELL_QUAD,
        SOLID_ELEMENT_MEMBRANE_QUAD};
    const double thickness[4] = {0.0, 0.1, 0.1, 0.2};
    const struct solid_parts mesh = {.n_nodes = 10,
                                     .places = places,
                                     .n_elements = 4,
                                     .shapes = kinds,
                                     .corners = corners,
                                     .thickness = thickness,
                                     .layers = 2};
    struct solid solid;
    struct solid_surface surface = {0};
    double mass = 0.0;
    solid_create(&solid, &mesh, 1, &elastic, ISA_AUTO);
    for (int i = 0; i < 10; i++)
        mass += solid.mass[i];
    EXPECT_NEAR(mass, 1000.0 * 1.4, 1e-10);
    EXPECT(solid.turns.inertia[0] == 0.0 && solid.turns.inertia[4] > 0.0);
    EXPECT_NEAR(solid.turns.inertia[9], 25.0 / 8.0, 1e-12); /* an eighth of its area */
    solid_surface_build(&surface, &solid);
    EXPECT(surface.n == 9); /* the cube's six and three thin ones */
    solid_add_mass(&solid, 9, 7.0, 2.0);
    solid_add_mass(&solid, 0, 7.0, 2.0);
    EXPECT_NEAR(solid.mass[9], 32.0, 1e-12);
    EXPECT_NEAR(solid.turns.inertia[9], 25.0 / 8.0 + 2.0, 1e-12);
    EXPECT(solid.turns.inertia[0] == 0.0);
    solid_velocity(&solid, 9)[2] = 1.0;
    steps(&solid, 0, 20);
    EXPECT(solid_velocity(&solid, 4)[2] != 0.0 && solid_turn_spin(&solid.turns, 5)[1] != 0.0);
    EXPECT(solid_turn_spin(&solid.turns, 0)[1] == 0.0);
    solid_surface_clear(&surface);
    solid_destroy(&solid);
}

/* --------------------------------------------------------------------- supports, loads */

/* A node that an angle, a rate or nothing turns, and a moment. */
TEST(turning_is_held_and_driven)
{
    struct solid solid;
    struct shell_sheet sheet;
    shell_sheet_build(&sheet, 2, 1, (const double[2]){2.0, 1.0}, SOLID_ELEMENT_SHELL_QUAD, 0.1,
                      2);
    solid_create(&solid, &sheet.mesh, 1, &elastic, ISA_AUTO);
    const int held = 0, free_one = 5;
    const struct solid_table angle = {
        2, (struct solid_table_point[]){{0.0, 0.0}, {10.0 * DT, 1e-3}}};
    const struct solid_table rate = {1, (struct solid_table_point[]){{0.0, 0.25}}};
    solid_supports_add_turn(&solid.supports, SOLID_SUPPORT_FIXED, 0, NULL, 1, &held);
    solid_supports_add_turn(&solid.supports, SOLID_SUPPORT_DISPLACEMENT, 1, &angle, 1, &held);
    solid_supports_add_turn(&solid.supports, SOLID_SUPPORT_VELOCITY, 2, &rate, 1, &held);
    solid_loads_add_moment(&solid.loads, (struct vec3){0.0, 3.0, 0.0}, NULL, 1, &free_one);
    steps(&solid, 0, 1);
    EXPECT_NEAR(solid_turn_spin(&solid.turns, free_one)[1],
                3.0 * DT / solid.turns.inertia[free_one], 1e-15);
    steps(&solid, 1, 15);
    const double *w = solid_turn_spin(&solid.turns, held);
    EXPECT(w[0] == 0.0);
    EXPECT_NEAR(w[1], 0.0, 1e-12);
    EXPECT_NEAR(w[2], 0.25, 1e-12);
    struct solid_energies energies = {0};
    EXPECT(solid_forces(&solid, 15, DT));
    solid_energies_add(&solid, 15, DT, &energies);
    EXPECT(solid_energy_value(&energies, SOLID_ENERGY_LOADS) > 0.0);
    EXPECT_NEAR(solid_energy_balance(&energies) /
                    solid_energy_value(&energies, SOLID_ENERGY_LOADS),
                0.0, 1e-6);
    remove_all(&solid, &sheet);
}

/* ------------------------------------------------------------------- plastic flow */

/* Stretches a square membrane at rates along x and y and shears it, its corners driven. */
static void strain_square(struct solid *solid, double rate[2][2], int n_steps)
{
    solid_forces(solid, 0, DT);
    for (int step = 1; step <= n_steps; step++) {
        for (int i = 0; i < 4; i++)
            for (int d = 0; d < 2; d++) {
                const double *x = solid->reference[i];
                double *now = solid_place(solid, i), *v = solid_velocity(solid, i);
                v[d] = rate[d][0] * (x[0] - 0.5) + rate[d][1] * (x[1] - 0.5);
                now[d] = x[d] + 0.5 * DT * v[d]; /* strain is that of the square */
            }
        EXPECT(solid_forces(solid, step, DT));
    }
}

static void make_square(struct solid *solid, struct shell_sheet *sheet,
                        const struct solid_material *material)
{
    shell_sheet_build(sheet, 1, 1, (const double[2]){1.0, 1.0}, SOLID_ELEMENT_MEMBRANE_QUAD,
                      0.1, 1);
    solid_create(solid, &sheet->mesh, 1, material, ISA_AUTO);
}

/* Straining at any ratio, in steps small and huge: the ellipse is met to rounding, and with
 * stress in proportion to strain's deviator where the two have the same direction. */
TEST(flow_in_a_plane)
{
    struct solid_material material = stuff;
    material.damping = 0.0;
    for (int n = 1; n <= 64; n *= 8)
        for (int k = 0; k < 8; k++) {
            struct solid solid;
            struct shell_sheet sheet;
            double rate[2][2] = {{cos(k), 0.3 * sin(3 * k)}, {0.3 * sin(3 * k), sin(k)}};
            const double strain = 0.004; /* of a yield strain of 1e-3 */
            for (int i = 0; i < 4; i++)
                rate[i / 2][i % 2] *= strain / (n * DT);
            make_square(&solid, &sheet, &material);
            strain_square(&solid, rate, n);
            const double *s = solid.shell[0].layer[0], p = s[3];
            const double q = sqrt(s[0] * s[0] + s[1] * s[1] - s[0] * s[1] + 3.0 * s[2] * s[2]);
            EXPECT(p > 0.0);
            EXPECT_NEAR(q / solid_element_yield_stress(&solid.materials[0], p), 1.0, 1e-13);
            remove_all(&solid, &sheet);
        }
}

/* The direction of flow after the rounds: elastic and plastic strain add up to the strain. */
TEST(rounds_of_the_return_suffice)
{
    struct solid_material material = stuff;
    material.damping = 0.0;
    for (int k = 0; k < 16; k++) {
        struct solid solid;
        struct shell_sheet sheet;
        const double size = k < 8 ? 0.002 : 0.02; /* twice, twenty times the yield strain */
        const double e[2] = {size * cos(k), size * sin(k)};
        double rate[2][2] = {{e[0] / DT, 0.0}, {0.0, e[1] / DT}};
        make_square(&solid, &sheet, &material);
        strain_square(&solid, rate, 1);
        const double *s = solid.shell[0].layer[0];
        const double q = sqrt(s[0] * s[0] + s[1] * s[1] - s[0] * s[1]), flow = s[3] / q;
        const double off = (s[0] - 0.3 * s[1]) / 1e9 + flow * (s[0] - 0.5 * s[1]) - e[0];
        EXPECT_NEAR(off / size, 0.0, k < 8 ? 1e-12 : 1e-6);
        remove_all(&solid, &sheet);
    }
}

/* Pulled along x with free sides: strain across and through are equal, and the volume changes
 * as the elastic law says. */
TEST(thickness_follows)
{
    struct solid_material material = stuff;
    struct solid solid;
    struct shell_sheet sheet;
    material.damping = 0.0;
    make_square(&solid, &sheet, &material);
    /* 1e6 + 1e8 p with p = e - s/E, in one step: in proportion all the way */
    const double e = 0.0025;
    const double stress = (1e6 + 1e8 * e) / (1.0 + 1e8 / 1e9), p = e - stress / 1e9;
    const double across = -0.3 * stress / 1e9 - 0.5 * p;
    double once[2][2] = {{e / DT, 0.0}, {0.0, across / DT}};
    strain_square(&solid, once, 1);
    EXPECT_NEAR(solid.shell[0].layer[0][0] / stress, 1.0, 1e-12);
    EXPECT_NEAR(solid.shell[0].layer[0][1] / stress, 0.0, 1e-12);
    EXPECT_NEAR(solid.shell[0].layer[0][3] / p, 1.0, 1e-11);
    EXPECT_NEAR(solid.shell[0].thickness / 0.1, (1.0 + 0.5 * across) / (1.0 - 0.5 * across),
                1e-13);
    remove_all(&solid, &sheet);
}

/* ------------------------------------------------------------------------------- limits */

/* Power iteration with one element as its own stiffness matrix. */
static double frequency(struct solid *solid, bool turns)
{
    const int n = solid_element_corners(solid->shape[0]), *nodes = solid->corners[0];
    const double tiny = 1e-7, share = solid->mass[nodes[0]];
    const double lever = turns ? solid->turns.inertia[nodes[0]] / share : 1.0;
    const struct shell_element_state before = solid->shell[0];
    double v[4][2][3], size = 1.0;
    random_vectors(8, v[0], 1.0);
    for (int round = 0; round < 600; round++) {
        memset(solid->state, 0, sizeof *solid->state);
        solid->shell[0] = before;
        for (int c = 0; c < n; c++)
            for (int d = 0; d < 3; d++) {
                solid_velocity(solid, nodes[c])[d] = tiny * v[c][0][d] / DT;
                if (turns)
                    solid_turn_spin(&solid->turns, nodes[c])[d] = tiny * v[c][1][d] / DT;
            }
        solid_forces(solid, 1, DT);
        size = 0.0;
        for (int c = 0; c < n; c++)
            for (int d = 0; d < 3; d++) {
                const double moment = turns ? -solid->turns.internal[nodes[c]][d] : 0.0;
                v[c][0][d] = -solid->internal[nodes[c]][d] / (tiny * share);
                v[c][1][d] = moment / (tiny * share * lever);
                size += v[c][0][d] * v[c][0][d] + lever * v[c][1][d] * v[c][1][d];
            }
        size = sqrt(size);
        for (int c = 0; c < n; c++)
            for (int d = 0; d < 6; d++)
                v[c][d / 3][d % 3] /= size;
    }
    return size; /* omega^2 */
}

TEST(bounds_on_frequencies_hold_and_are_near)
{
    for (int round = 0; round < 64; round++) {
        const enum solid_element_shape shape = shapes[round % N_SHAPES];
        struct solid_material material = elastic;
        struct shell_sheet sheet;
        struct solid solid;
        const double long_side = (double)(1 + round / 16);
        material.hourglass_stiffness = round % 3 == 0 ? 1.0 : 0.1;
        shell_sheet_build(&sheet, 1, 1, (const double[2]){long_side, 1.0}, shape,
                          round % 8 < 4 ? 0.01 : 0.5, 3);
        sheet.mesh.n_elements = 1;
        for (int i = 0; round >= 8 && i < 4; i++)
            for (int d = 0; d < 3; d++)
                sheet.mesh.places[i][d] += 0.15 * solid_block_random(&seed);
        solid_create(&solid, &sheet.mesh, 1, &material, ISA_AUTO);
        const double step = solid_limits_find(&solid, NULL, NULL).step;
        const double exact = 2.0 / sqrt(frequency(&solid, shell_element_turns(shape)));
        EXPECT(step <= exact * (1.0 + 1e-5)); /* power iteration comes from below */
        EXPECT(step >= exact * 0.9995);
        remove_all(&solid, &sheet);
    }
}

/* Turning does not limit the step where elements are thin: it is that of a membrane. */
TEST(turning_does_not_limit_the_step)
{
    for (int k = 0; k < 2; k++)
        for (int aspect = 1; aspect < 6; aspect++) {
            struct shell_sheet sheet, membrane;
            struct solid solid, other;
            shell_sheet_build(&sheet, 1, 1, (const double[2]){aspect, 1.0}, shapes[k], 0.01, 3);
            shell_sheet_build(&membrane, 1, 1, (const double[2]){aspect, 1.0}, shapes[k + 2],
                              0.01, 1);
            solid_create(&solid, &sheet.mesh, 1, &elastic, ISA_AUTO);
            solid_create(&other, &membrane.mesh, 1, &elastic, ISA_AUTO);
            EXPECT_NEAR(solid_limits_find(&solid, NULL, NULL).step /
                            solid_limits_find(&other, NULL, NULL).step,
                        1.0, 1e-3);
            remove_all(&solid, &sheet);
            remove_all(&other, &membrane);
        }
}

TEST(failures_have_a_place)
{
    struct solid solid;
    struct shell_sheet sheet;
    make(&solid, &sheet, SOLID_ELEMENT_SHELL_QUAD, &elastic, ISA_AUTO);
    EXPECT(solid_forces(&solid, 0, DT));
    EXPECT(solid_limits_fault(&solid, DT).failure == SOLID_LIMITS_FINE);
    solid.shell[4].thickness = -1.0;
    EXPECT(!solid_forces(&solid, 1, DT));
    EXPECT(solid_limits_fault(&solid, DT).element == 4);
    solid.shell[4].thickness = 0.1;
    solid_turn_spin(&solid.turns, 0)[2] = (double)NAN;
    EXPECT(!solid_forces(&solid, 1, DT));
    const struct solid_limits_fault fault = solid_limits_fault(&solid, DT);
    EXPECT(fault.failure == SOLID_LIMITS_NOT_A_NUMBER && fault.element == 0);
    remove_all(&solid, &sheet);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
