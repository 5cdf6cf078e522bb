/*
 * Chooses among the compilations of shell_element_blocks.c; and what is asked of one element at
 * a time.
 *
 * The bound on the step is the element's own largest frequency: with its strains' forces b_k on
 * nodes (13.9) and stiffness d_k, that of the small matrix sqrt(d_k d_l) b_k b_l over the
 * masses.
 */
#include "physics/shell_element.h"

#include <math.h>
#include <string.h>

#include "physics/eigenvalue.h"
#include "physics/shell_element_blocks.h"
#include "physics/shell_geometry.h"
#include "physics/shell_law.h"

void shell_element_choose(enum isa isa, struct solid_element_kernel *kernel)
{
    const struct solid_element_kernel own = ISA_PICK(isa_choose(isa), shell_element_blocks);
    for (int shape = 0; shape < SOLID_ELEMENT_N_SHAPES; shape++)
        if (shell_element_is((enum solid_element_shape)shape))
            kernel->apply[shape] = own.apply[shape];
}

struct shell_element_points shell_element_points(int layers)
{
    /* Roots of Legendre's polynomials. */
    static const struct shell_element_points points[SHELL_ELEMENT_LAYERS] = {
        {{0.0}, {1.0}},
        {{-0.57735026918962576, 0.57735026918962576}, {0.5, 0.5}},
        {{-0.77459666924148338, 0.0, 0.77459666924148338},
         {0.27777777777777778, 0.44444444444444444, 0.27777777777777778}},
        {{-0.86113631159405258, -0.33998104358485626, 0.33998104358485626, 0.86113631159405258},
         {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693}},
        {{-0.90617984593866399, -0.53846931010568309, 0.0, 0.53846931010568309,
          0.90617984593866399},
         {0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324,
          0.11846344252809454}}};
    return points[layers - 1];
}

bool shell_element_turns(enum solid_element_shape shape)
{
    return shape == SOLID_ELEMENT_SHELL_QUAD || shape == SOLID_ELEMENT_SHELL_TRIANGLE;
}

bool shell_element_is(enum solid_element_shape shape)
{
    return shell_element_turns(shape) || shape == SOLID_ELEMENT_MEMBRANE_QUAD ||
           shape == SOLID_ELEMENT_MEMBRANE_TRIANGLE;
}

static bool is_triangle(enum solid_element_shape shape)
{
    return solid_element_corners(shape) == 3;
}

static struct shell_geometry geometry_of(enum solid_element_shape shape, double x[][3])
{
    struct shell_geometry g;
    if (is_triangle(shape))
        shell_geometry_triangle(x, &g);
    else
        shell_geometry_quad(x, &g);
    return g;
}

double shell_element_area(enum solid_element_shape shape, double x[][3])
{
    return geometry_of(shape, x).area;
}

double shell_element_facing(enum solid_element_shape shape, double x[][3], double y[][3])
{
    const struct shell_geometry g = geometry_of(shape, x), other = geometry_of(shape, y);
    return g.area * solid_gradient_dot(g.axis[2], other.axis[2]);
}

double shell_element_inertia(enum solid_element_shape shape, double x[][3], double thickness)
{
    const double area = shell_element_area(shape, x), own = thickness * thickness / 12.0;
    const double least = is_triangle(shape) ? area / 4.0 : area / 8.0;
    return own > least ? own : least;
}

struct shell_element_state shell_element_begin(double thickness,
                                               const struct solid_element_material *material)
{
    return (struct shell_element_state){.thickness = thickness,
                                        .across = shell_law_of(material).across};
}

double shell_element_mises(const struct shell_element_state *shell,
                           enum solid_element_shape shape, int layers)
{
    double most = 0.0;
    for (int l = 0; l < (shell_element_turns(shape) ? layers : 1); l++) {
        const double *s = shell->layer[l];
        const double square = s[0] * s[0] - s[0] * s[1] + s[1] * s[1] + 3.0 * (s[2] * s[2]);
        most = square > most ? square : most;
    }
    return sqrt(most);
}

double shell_element_energy(enum solid_element_shape shape,
                            const struct solid_element_state *state,
                            const struct shell_element_state *shell, int layers,
                            const struct solid_element_material *material)
{
    const struct shell_law law = shell_law_of(material);
    const int n = shell_element_turns(shape) ? layers : 1;
    const struct shell_element_points points = shell_element_points(n);
    double sum = 0.0;
    for (int l = 0; l < n; l++) {
        const double *s = shell->layer[l];
        sum += points.weight[l] *
               ((s[0] * s[0] + s[1] * s[1] - 2.0 * law.poisson * s[0] * s[1]) / law.young +
                s[2] * s[2] / law.shear);
    }
    const double *s = shell->shear;
    if (shell_element_turns(shape))
        sum += (s[0] * s[0] + s[1] * s[1]) / shell->across;
    return 0.5 * state->volume * sum;
}

/* ------------------------------------------------------------------------------- the step */

/* Stiffness of strains that are not coupled: of plane stress, the sum and the difference of
 * two.  0: the shape has no such strain. */
static void stiffness_of(enum solid_element_shape shape, const struct shell_geometry *g,
                         double thickness, int layers,
                         const struct solid_element_material *material,
                         double stiffness[SHELL_GEOMETRY_STRAINS])
{
    const struct shell_law law = shell_law_of(material);
    const double volume = g->area * thickness;
    const double plane[3] = {2.0 * law.all, 2.0 * law.shear, law.shear};
    const bool triangle = is_triangle(shape), turns = shell_element_turns(shape);
    const struct shell_element_points points = shell_element_points(turns ? layers : 1);
    double modes[10] = {0.0}, lever = 0.0;
    for (int l = 0; l < layers && turns; l++)
        lever += points.weight[l] * points.place[l] * points.place[l];
    shell_law_modes(&law, g, thickness, triangle, modes);
    for (int k = 0; k < 3; k++) {
        stiffness[SHELL_GEOMETRY_STRETCH + k] = plane[k] * volume;
        stiffness[SHELL_GEOMETRY_BEND + k] =
            plane[k] * volume * lever * 0.25 * thickness * thickness;
    }
    for (int k = 0; k < 2; k++)
        stiffness[SHELL_GEOMETRY_SHEAR + k] =
            turns ? shell_law_across(&law, g, thickness, triangle) * volume : 0.0;
    const int n_modes = shell_law_n_modes(turns, triangle);
    for (int a = 0; a < 10; a++)
        stiffness[SHELL_GEOMETRY_MODES + a] = a < n_modes ? modes[a] : 0.0;
}

/* Forces and moments, 6 of each corner, of a unit of one of these strains. */
static void forces_of(enum solid_element_shape shape, const struct shell_geometry *g,
                      int strain, double row[4][2][3])
{
    double f[SHELL_GEOMETRY_STRAINS] = {0.0}, force[4][3] = {{0.0}}, moment[4][3] = {{0.0}};
    const int pair = strain < SHELL_GEOMETRY_SHEAR ? strain % 3 : 2;
    f[strain] = 1.0;
    if (pair < 2) { /* of two direct stresses the sum and the difference, of length 1 */
        const int first = strain - pair;
        f[first] = sqrt(0.5);
        f[first + 1] = pair == 0 ? sqrt(0.5) : -sqrt(0.5);
    }
    if (shape == SOLID_ELEMENT_SHELL_QUAD)
        shell_geometry_quad_resist(g, f, force, moment);
    else if (shape == SOLID_ELEMENT_SHELL_TRIANGLE)
        shell_geometry_triangle_resist(g, f, force, moment);
    else if (shape == SOLID_ELEMENT_MEMBRANE_QUAD)
        shell_geometry_quad_pull(g, f, force);
    else
        shell_geometry_triangle_pull(g, f, force);
    for (int c = 0; c < 4; c++) {
        memcpy(row[c][0], force[c], sizeof force[c]);
        memcpy(row[c][1], moment[c], sizeof moment[c]);
    }
}

static double product(int n, const double *a, const double *b)
{
    double sum = 0.0;
    for (int k = 0; k < n; k++)
        sum += a[k] * b[k];
    return sum;
}

struct solid_element_load shell_element_load(enum solid_element_shape shape, double x[][3],
                                             double mass, double thickness, int layers,
                                             const struct solid_element_material *material,
                                             double enough)
{
    enum { N = SHELL_GEOMETRY_STRAINS, ALL = 4 * 2 * 3 };
    const struct shell_geometry g = geometry_of(shape, x);
    const double share = mass / solid_element_corners(shape);
    const double inertia = shell_element_inertia(shape, x, thickness);
    struct solid_element_load load = {.damping = material->damping};
    double stiffness[N], row[N][4][2][3], matrix[N][N];
    stiffness_of(shape, &g, thickness, layers, material, stiffness);
    for (int k = 0; k < N; k++) {
        const double of_force = sqrt(stiffness[k] / share);
        const double of_moment = sqrt(stiffness[k] / (share * inertia));
        forces_of(shape, &g, k, row[k]);
        for (int c = 0; c < 4; c++)
            for (int i = 0; i < 3; i++) {
                row[k][c][0][i] *= of_force;
                row[k][c][1][i] *= of_moment;
            }
        load.stretch += product(ALL, &row[k][0][0][0], &row[k][0][0][0]);
    }
    if (load.stretch <= enough) /* their sum is */
        return load;
    for (int k = 0; k < N; k++)
        for (int l = 0; l <= k; l++)
            matrix[k][l] = matrix[l][k] = product(ALL, &row[k][0][0][0], &row[l][0][0][0]);
    load.stretch = eigenvalue_bound(N, &matrix[0][0], enough);
    return load;
}
