/* One-point elements: volume and gradient against quadrature, the kernel against the theory's
 * formulas one by one, all instruction sets, turning, plastic flow against closed forms, the
 * bound on the frequency against the frequency. */
#include "physics/solid_element.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "physics/solid_gradient.h"
#include "solid_block.h"

enum { N = 24 };
static const double XI[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
static uint64_t seed = 7;

static void random_cell(double x[8][3], double distortion)
{
    for (int c = 0; c < 8; c++)
        for (int d = 0; d < 3; d++)
            x[c][d] = 0.5 * (1.0 + 0.3 * d) * XI[c][d] + distortion * solid_block_random(&seed);
}

static double determinant(double m[3][3])
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) +
           m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/* Of the trilinear cell: its Jacobian is of second degree in each direction, so that two points
 * each are exact. */
static double quadrature_volume(double x[8][3])
{
    const double g = 1.0 / sqrt(3.0);
    double volume = 0.0;
    for (int p = 0; p < 8; p++) {
        double jacobian[3][3] = {{0.0}};
        for (int c = 0; c < 8; c++)
            for (int d = 0; d < 3; d++) {
                double by = 0.125 * XI[c][d];
                for (int o = 0; o < 3; o++)
                    by *= o == d ? 1.0 : 1.0 + XI[c][o] * XI[p][o] * g;
                for (int i = 0; i < 3; i++)
                    jacobian[i][d] += by * x[c][i];
            }
        volume += determinant(jacobian);
    }
    return volume;
}

TEST(volume_of_hexahedra_is_exact)
{
    for (int round = 0; round < 50; round++) {
        double x[8][3], b[8][3];
        random_cell(x, 0.15);
        EXPECT_NEAR(solid_gradient_hexahedron(x, b), quadrature_volume(x), 1e-14);
    }
}

/* Volume is of the first degree in the place of each corner: differences are exact. */
TEST(gradients_are_those_of_the_volume)
{
    for (int round = 0; round < 20; round++) {
        double x[8][3], b[8][3], other[8][3];
        random_cell(x, 0.15);
        for (int shape = 0; shape < 2; shape++) {
            const int n = shape == 0 ? 8 : 4;
            const enum solid_element_shape which =
                shape == 0 ? SOLID_ELEMENT_HEXAHEDRON : SOLID_ELEMENT_TETRAHEDRON;
            if (shape == 0)
                solid_gradient_hexahedron(x, b);
            else
                solid_gradient_tetrahedron(x, b);
            for (int c = 0; c < n; c++)
                for (int d = 0; d < 3; d++) {
                    memcpy(other, x, sizeof other);
                    x[c][d] += 0.5;
                    other[c][d] -= 0.5;
                    EXPECT_NEAR(b[c][d],
                                solid_element_volume(which, x) -
                                    solid_element_volume(which, other),
                                1e-14);
                    x[c][d] -= 0.5;
                }
        }
    }
}

/* --------------------------------------------------- the kernel, formula by formula */

/* Elements that share no nodes, moved at random. */
struct scene {
    struct solid_element_node node[8 * N + 8];
    int corners[N + 1][8];
    double mass[N + 1];
    struct solid_element_state state[N + 1];
    struct solid_element_force force[N + 1];
    int elements[N];
    struct solid_element_yield yield[3];
    struct solid_element_material material;
};

static void scene_fill(struct scene *scene, bool plastic, double motion)
{
    memset(scene, 0, sizeof *scene);
    for (int e = 0; e < N; e++) {
        double x[8][3];
        random_cell(x, 0.1);
        if (e % 2 == 1) /* corner 3 above the others: a tetrahedron too */
            memcpy(x[3], x[7], sizeof x[3]), x[7][2] += 1.0;
        scene->elements[e] = (5 * e) % N;
        scene->mass[e] = 8.0 + solid_block_random(&seed);
        for (int c = 0; c < 8; c++) {
            scene->corners[e][c] = 8 * e + c;
            for (int d = 0; d < 3; d++) {
                scene->node[8 * e + c].lane[d] = x[c][d];
                scene->node[8 * e + c].lane[4 + d] = motion * solid_block_random(&seed);
            }
        }
        for (int k = 0; k < 6; k++)
            scene->state[e].stress[k] = 30.0 * solid_block_random(&seed);
        for (int k = 0; k < 12; k++)
            scene->state[e].hourglass[k / 3][k % 3] = solid_block_random(&seed);
        scene->state[e].plastic_strain = plastic ? 0.05 : 0.0;
    }
    scene->material = (struct solid_element_material){.density = 8.0,
                                                      .damping = 0.01,
                                                      .hourglass_stiffness = 0.1,
                                                      .hourglass_viscosity = 0.05,
                                                      .n_yield = plastic ? 3 : 0,
                                                      .yield = scene->yield};
    solid_element_elastic(&scene->material, 1000.0, 0.3);
    const double strain[3] = {0.0, 0.05, 0.06}, stress[3] = {20.0, 30.0, 31.0},
                 slope[3] = {200.0, 100.0, 20.0};
    for (int k = 0; k < 3; k++)
        scene->yield[k] = (struct solid_element_yield){
            strain[k], stress[k], slope[k], 1.0 / (3.0 * scene->material.mu + slope[k])};
}

static bool scene_apply(struct scene *scene, const struct solid_element_kernel *kernel,
                        enum solid_element_shape shape)
{
    struct solid_element_work work = {.n = N,
                                      .elements = scene->elements,
                                      .nodes = scene->node,
                                      .corners = scene->corners,
                                      .mass = scene->mass,
                                      .state = scene->state,
                                      .force = scene->force,
                                      .material = &scene->material,
                                      .dt = 0.01,
                                      .since = 0.01};
    kernel->apply[shape](&work);
    return work.failed;
}

/* One element by the formulas as THEORY.md has them, with matrices and sums throughout. */
struct plain {
    double b[8][3], volume; /* at the middle, then at the step */
    double strain[3][3], turn[3][3], moved[8][3], x[8][3];
    double stress[3][3], mode[4][3], acting[4][3], force[8][3];
};

static void plain_gamma(struct plain *p, double x[8][3], double gamma[4][8])
{
    for (int a = 0; a < 4; a++)
        for (int c = 0; c < 8; c++) {
            double h[8];
            for (int o = 0; o < 8; o++)
                h[o] = a == 3 ? XI[o][0] * XI[o][1] * XI[o][2]
                              : XI[o][(a + 1) % 3] * XI[o][(a + 2) % 3];
            gamma[a][c] = h[c];
            for (int j = 0; j < 3; j++)
                for (int o = 0; o < 8; o++)
                    gamma[a][c] -= p->b[c][j] * x[o][j] * h[o] / p->volume;
        }
}

/* (1 - W/2)^-1 (1 + W/2) by Cramer's rule, W the spin of the motion. */
static void plain_turn(struct plain *p, double gradient[3][3])
{
    double left[3][3], right[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double w = 0.25 * (gradient[i][j] - gradient[j][i]);
            left[i][j] = (i == j ? 1.0 : 0.0) - w;
            right[i][j] = (i == j ? 1.0 : 0.0) + w;
        }
    const double all = determinant(left);
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) {
            double m[3][3];
            memcpy(m, left, sizeof m);
            for (int k = 0; k < 3; k++)
                m[k][i] = right[k][j];
            p->turn[i][j] = determinant(m) / all;
        }
}

static void plain_motion(struct plain *p, const struct scene *scene, int e, bool hexahedron)
{
    double middle[8][3], gradient[3][3] = {{0.0}};
    for (int c = 0; c < 8; c++)
        for (int d = 0; d < 3; d++) {
            p->x[c][d] = scene->node[8 * e + c].lane[d];
            p->moved[c][d] = 0.01 * scene->node[8 * e + c].lane[4 + d];
            middle[c][d] = p->x[c][d] - 0.5 * p->moved[c][d];
        }
    memset(p->b, 0, sizeof p->b);
    p->volume = hexahedron ? solid_gradient_hexahedron(middle, p->b)
                           : solid_gradient_tetrahedron(middle, p->b);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int c = 0; c < 8; c++)
                gradient[i][j] += p->moved[c][i] * p->b[c][j] / p->volume;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            p->strain[i][j] = 0.5 * (gradient[i][j] + gradient[j][i]);
    plain_turn(p, gradient);
}

static void plain_stress(struct plain *p, const struct scene *scene, int e)
{
    const struct solid_element_material *m = &scene->material;
    const double *s = scene->state[e].stress;
    const double old[3][3] = {{s[0], s[3], s[5]}, {s[3], s[1], s[4]}, {s[5], s[4], s[2]}};
    const double trace = p->strain[0][0] + p->strain[1][1] + p->strain[2][2];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            p->stress[i][j] = 2.0 * m->mu * p->strain[i][j] + (i == j) * m->lambda * trace;
            for (int k = 0; k < 3; k++)
                for (int l = 0; l < 3; l++)
                    p->stress[i][j] += p->turn[i][k] * old[k][l] * p->turn[j][l];
        }
}

/* Remembered and acting forces of the hourglass modes. */
static void plain_modes(struct plain *p, const struct scene *scene, int e, double gamma[4][8])
{
    const struct solid_element_material *m = &scene->material;
    double square = 0.0;
    for (int c = 0; c < 8; c++)
        for (int d = 0; d < 3; d++)
            square += p->b[c][d] * p->b[c][d];
    const double whole = (m->lambda + 2.0 * m->mu) * square / (24.0 * p->volume);
    const double dashpot = 2.0 * m->hourglass_viscosity * sqrt(whole * scene->mass[e] / 64.0);
    for (int a = 0; a < 4; a++)
        for (int i = 0; i < 3; i++) {
            double q = 0.0;
            for (int c = 0; c < 8; c++)
                q += gamma[a][c] * p->moved[c][i];
            p->mode[a][i] = m->hourglass_stiffness * whole * q;
            for (int j = 0; j < 3; j++)
                p->mode[a][i] += p->turn[i][j] * scene->state[e].hourglass[a][j];
            p->acting[a][i] = p->mode[a][i] + dashpot * q / 0.01;
        }
}

static void plain_forces(struct plain *p, const struct scene *scene, bool hexahedron)
{
    const struct solid_element_material *m = &scene->material;
    const double trace = p->strain[0][0] + p->strain[1][1] + p->strain[2][2];
    double gamma[4][8];
    memset(p->b, 0, sizeof p->b);
    p->volume = hexahedron ? solid_gradient_hexahedron(p->x, p->b)
                           : solid_gradient_tetrahedron(p->x, p->b);
    plain_gamma(p, p->x, gamma);
    for (int c = 0; c < 8; c++)
        for (int i = 0; i < 3; i++) {
            p->force[c][i] = 0.0;
            for (int j = 0; j < 3; j++)
                p->force[c][i] +=
                    p->b[c][j] * (p->stress[i][j] + m->damping / 0.01 *
                                                        (2.0 * m->mu * p->strain[i][j] +
                                                         (i == j) * m->lambda * trace));
            for (int a = 0; hexahedron && a < 4; a++)
                p->force[c][i] += gamma[a][c] * p->acting[a][i];
        }
}

static void expect_plain(const struct scene *before, const struct scene *after, int e,
                         bool hexahedron)
{
    static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    struct plain p;
    plain_motion(&p, before, e, hexahedron);
    plain_stress(&p, before, e);
    for (int k = 0; k < 6; k++)
        EXPECT_NEAR(after->state[e].stress[k], p.stress[pair[k][0]][pair[k][1]], 1e-12 * 1000);
    if (hexahedron) {
        double gamma[4][8], middle[8][3];
        for (int c = 0; c < 8; c++)
            for (int d = 0; d < 3; d++)
                middle[c][d] = p.x[c][d] - 0.5 * p.moved[c][d];
        plain_gamma(&p, middle, gamma);
        plain_modes(&p, before, e, gamma);
        for (int k = 0; k < 12; k++)
            EXPECT_NEAR(after->state[e].hourglass[k / 3][k % 3], p.mode[k / 3][k % 3], 1e-11);
    }
    plain_forces(&p, before, hexahedron);
    int at = 0; /* in the list */
    while (before->elements[at] != e)
        at++;
    for (int c = 0; c < (hexahedron ? 8 : 4); c++) {
        for (int i = 0; i < 3; i++)
            EXPECT_NEAR(after->force[at].corner[c][i], p.force[c][i], 1e-11);
        EXPECT(after->force[at].corner[c][3] == 0.0);
    }
    EXPECT_NEAR(after->state[e].volume, p.volume, 1e-14);
}

TEST(elastic_elements_by_the_formulas)
{
    static struct scene before, after;
    for (int round = 0; round < 5; round++) {
        scene_fill(&before, false, 10.0);
        for (int shape = 0; shape < 2; shape++) {
            const struct solid_element_kernel kernel = solid_element_choose(ISA_AUTO);
            memcpy(&after, &before, sizeof after);
            after.material.yield = after.yield;
            scene_apply(&after, &kernel, (enum solid_element_shape)shape);
            for (int e = 0; e < N; e++)
                if (shape == 0 ? e % 2 == 0 : e % 2 == 1)
                    expect_plain(&before, &after, e, shape == 0);
        }
    }
}

TEST(all_instruction_sets_give_the_same_bits)
{
    static struct scene expected, got;
    for (int choice = 0; choice < 4; choice++) {
        const enum solid_element_shape shape =
            choice & 1 ? SOLID_ELEMENT_HEXAHEDRON : SOLID_ELEMENT_TETRAHEDRON;
        for (int isa = ISA_AUTO + 1; isa < ISA_N; isa++) {
            if (!isa_runs((enum isa)isa))
                continue;
            const struct solid_element_kernel first = solid_element_choose(ISA_AUTO),
                                              other = solid_element_choose((enum isa)isa);
            scene_fill(&expected, choice & 2, 10.0);
            memcpy(&got, &expected, sizeof got);
            got.material.yield = got.yield;
            for (int step = 0; step < 5; step++) {
                EXPECT(scene_apply(&expected, &first, shape) ==
                       scene_apply(&got, &other, shape));
                EXPECT(memcmp(expected.state, got.state, sizeof got.state) == 0);
                EXPECT(memcmp(expected.force, got.force, sizeof got.force) == 0);
            }
            /* Whole lines of a matrix plasticity must have been met. */
            if (choice & 2)
                EXPECT(expected.state[1].plastic_strain > 0.05);
        }
    }
}

/* ------------------------------------------------------------------- plastic flow */

/* Shears or stretches element 0 of a cube of side 1 at a constant rate. */
static void deform(struct scene *scene, double rate[3][3], int n_steps)
{
    const struct solid_element_kernel kernel = solid_element_choose(ISA_AUTO);
    memset(scene->state, 0, sizeof scene->state);
    for (int step = 0; step < n_steps; step++) {
        for (int e = 0; e < N; e++)
            for (int c = 0; c < 8; c++)
                for (int i = 0; i < 3; i++) {
                    double *row = scene->node[8 * e + c].lane;
                    row[i] = 0.5 * XI[c][i];
                    row[4 + i] = 0.0;
                    for (int j = 0; j < 3; j++)
                        row[4 + i] += rate[i][j] * 0.5 * XI[c][j];
                    /* as if it had come from half a step back to half a step on */
                    row[i] += 0.5 * 0.01 * row[4 + i];
                }
        EXPECT(!scene_apply(scene, &kernel, SOLID_ELEMENT_HEXAHEDRON));
    }
}

/* Monotonic shear by gamma: tau sqrt 3 = yield stress at the plastic strain
 * (gamma - tau/mu)/sqrt 3, exact for radial return at whatever step. */
TEST(flow_in_shear_follows_the_yield_curve)
{
    static struct scene scene;
    scene_fill(&scene, true, 0.0);
    for (int n = 1; n <= 60; n++) {
        double rate[3][3] = {{0.0}};
        rate[0][1] = rate[1][0] = 0.5 * 0.3; /* pure: without turning */
        deform(&scene, rate, n);
        const double gamma = 0.3 * 0.01 * n, tau = scene.state[0].stress[3];
        const double p = scene.state[0].plastic_strain;
        const double mu = scene.material.mu;
        if (gamma * mu * sqrt(3.0) <= 20.0) {
            EXPECT(p == 0.0);
            EXPECT_NEAR(tau, mu * gamma, 1e-11);
        } else {
            EXPECT_NEAR(p, (gamma - tau / mu) / sqrt(3.0), 1e-13);
            EXPECT_NEAR(sqrt(3.0) * tau, solid_element_yield_stress(&scene.material, p), 1e-11);
            EXPECT_NEAR(solid_element_mises(&scene.state[0]), sqrt(3.0) * tau, 1e-11);
        }
    }
    EXPECT(scene.state[0].plastic_strain > 0.07); /* through all pieces of the curve */
}

/* One step far beyond two corners of the curve: worked out by hand. */
TEST(flow_crosses_corners_of_the_curve)
{
    static struct scene scene;
    double rate[3][3] = {{0.0}};
    scene_fill(&scene, true, 0.0);
    const double mu = scene.material.mu, trial = 150.0; /* von Mises */
    rate[0][1] = rate[1][0] = trial / sqrt(3.0) / (2.0 * mu) / 0.01;
    deform(&scene, rate, 1);
    /* q - 3 mu p = 31 + 20 (p - .06) */
    EXPECT_NEAR(scene.state[0].plastic_strain, (trial - 31.0 + 1.2) / (3.0 * mu + 20.0), 1e-14);
}

/* Stretched without room to narrow: s = sigma_xx - sigma_yy is the von Mises stress, and p its
 * flow; pressure stays elastic. */
TEST(flow_leaves_pressure_alone)
{
    static struct scene scene;
    double rate[3][3] = {{0.0}};
    scene_fill(&scene, true, 0.0);
    rate[0][0] = 1.0;
    deform(&scene, rate, 10);
    const struct solid_element_state *state = &scene.state[0];
    const struct solid_element_material *m = &scene.material;
    const double p = state->plastic_strain, strain = 0.1;
    EXPECT_NEAR(state->stress[0] + state->stress[1] + state->stress[2],
                (3.0 * m->lambda + 2.0 * m->mu) * strain, 1e-10);
    EXPECT_NEAR(state->stress[0] - state->stress[1], solid_element_yield_stress(m, p), 1e-11);
    EXPECT_NEAR(state->stress[0] - state->stress[1], 2.0 * m->mu * (strain - 1.5 * p), 1e-11);
}

/* What flows is what work does not come back: heat = yield stress times flow, in the mean. */
TEST(heat_of_flow)
{
    static struct scene scene;
    double rate[3][3] = {{0.0}};
    scene_fill(&scene, true, 0.0);
    scene.material.n_yield = 1; /* 20 + 200 p */
    rate[0][1] = rate[1][0] = 0.15;
    deform(&scene, rate, 200);
    const double p = scene.state[0].plastic_strain;
    EXPECT_NEAR(scene.state[0].plastic_work / (20.0 * p + 100.0 * p * p), 1.0, 1e-4);
}

/* --------------------------------------------------------------- failures, limits */

TEST(failures_are_noticed)
{
    static struct scene scene;
    const struct solid_element_kernel kernel = solid_element_choose(ISA_AUTO);
    scene_fill(&scene, false, 1.0);
    EXPECT(!scene_apply(&scene, &kernel, SOLID_ELEMENT_HEXAHEDRON));
    scene.node[8 * 3 + 6].lane[4] = (double)NAN;
    EXPECT(scene_apply(&scene, &kernel, SOLID_ELEMENT_HEXAHEDRON));
    scene_fill(&scene, false, 1.0);
    scene.node[8 * 20].lane[2] += 9.0; /* beyond the opposite corner */
    EXPECT(scene_apply(&scene, &kernel, SOLID_ELEMENT_HEXAHEDRON));
    scene_fill(&scene, false, 1.0);
    scene.node[8 * 20].lane[4 + 2] -= 1800.0; /* half a step back it was */
    EXPECT(scene_apply(&scene, &kernel, SOLID_ELEMENT_HEXAHEDRON));
}

/* Power iteration with the kernel itself as the stiffness matrix, at a motion that hardly
 * changes the geometry. */
static double frequency(struct scene *scene, enum solid_element_shape shape)
{
    const struct solid_element_kernel kernel = solid_element_choose(ISA_AUTO);
    const int n = solid_element_corners(shape);
    const double tiny = 1e-7, share = scene->mass[0] / n;
    double v[8][3], size = 1.0;
    for (int c = 0; c < n; c++)
        for (int d = 0; d < 3; d++)
            v[c][d] = solid_block_random(&seed);
    for (int round = 0; round < 400; round++) {
        memset(scene->state, 0, sizeof scene->state);
        for (int c = 0; c < n; c++)
            for (int d = 0; d < 3; d++)
                scene->node[c].lane[4 + d] = tiny * v[c][d] / 0.01;
        scene_apply(scene, &kernel, shape);
        size = 0.0;
        for (int c = 0; c < n; c++)
            for (int d = 0; d < 3; d++) {
                v[c][d] = scene->force[0].corner[c][d] / (tiny * share);
                size += v[c][d] * v[c][d];
            }
        size = sqrt(size);
        for (int c = 0; c < n; c++)
            for (int d = 0; d < 3; d++)
                v[c][d] /= size;
    }
    return size; /* omega^2 */
}

TEST(bounds_on_frequencies_hold_and_are_near)
{
    static struct scene scene;
    for (int round = 0; round < 40; round++) {
        const enum solid_element_shape shape =
            round % 2 == 0 ? SOLID_ELEMENT_HEXAHEDRON : SOLID_ELEMENT_TETRAHEDRON;
        scene_fill(&scene, false, 0.0);
        scene.material.damping = scene.material.hourglass_viscosity = 0.0;
        scene.material.hourglass_stiffness = round % 3 == 0 ? 1.5 : 0.1;
        double x[8][3];
        for (int c = 0; c < 8; c++) {
            memcpy(x[c], XI[c], sizeof x[c]);
            for (int d = 0; d < 3; d++) {
                if (round >= 20)
                    x[c][d] += 0.2 * solid_block_random(&seed);
                if (shape == SOLID_ELEMENT_TETRAHEDRON && c == 3)
                    x[c][d] = d == 2 ? 1.0 : 0.2;
                x[c][d] *= d == 0 && round % 4 < 2 ? 0.2 : 0.5;
            }
            memcpy(scene.node[c].lane, x[c], sizeof x[c]);
        }
        const struct solid_element_load load =
            solid_element_load(shape, x, scene.mass[0], &scene.material);
        const double step = solid_element_critical_step(&load, 0.0, 0.0);
        const double exact = 2.0 / sqrt(frequency(&scene, shape));
        EXPECT(step <= exact * (1.0 + 1e-6));
        EXPECT(step >= exact * 0.75);
        if (round < 20 && round % 2 == 0 && round % 3 != 0) /* boxes: it is the frequency */
            EXPECT(step >= exact * 0.95);
    }
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
