/* See solid_side.h. */
#include "solid/solid_side.h"

#include "model/solid_mesh.h"
#include "solid/solid.h"

/* The face as it is, or from the other side. */
static int shell_nodes(const struct solid *solid, int element, int side,
                       int nodes[SOLID_SIDE_NODES])
{
    const int n = solid_element_corners(solid->shape[element]);
    if (side < 0 || side > 1)
        return 0;
    for (int c = 0; c < n; c++)
        nodes[c] = solid->corners[element][side == 0 ? c : (n - c) % n];
    return n;
}

int solid_side_nodes(const struct solid *solid, int element, int side,
                     int nodes[SOLID_SIDE_NODES])
{
    if (shell_element_is(solid->shape[element]))
        return shell_nodes(solid, element, side, nodes);
    const int n =
        solid_mesh_side_corners(solid_element_corners(solid->shape[element]), side, nodes);
    for (int c = 0; c < n; c++)
        nodes[c] = solid->corners[element][nodes[c]];
    return n;
}

static void triangle_areas(double x[SOLID_SIDE_NODES][3], double area[SOLID_SIDE_NODES][3])
{
    double a[3], b[3];
    for (int i = 0; i < 3; i++) {
        a[i] = x[1][i] - x[0][i];
        b[i] = x[2][i] - x[0][i];
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double share = (a[j] * b[k] - a[k] * b[j]) / 6.0;
        for (int c = 0; c < 3; c++)
            area[c][i] = share;
    }
}

void solid_side_areas(int n, double x[SOLID_SIDE_NODES][3], double area[SOLID_SIDE_NODES][3])
{
    static const double xi[4] = {-1.0, 1.0, 1.0, -1.0}, eta[4] = {-1.0, -1.0, 1.0, 1.0};
    if (n == 3) {
        triangle_areas(x, area);
        return;
    }
    double a[3], b[3], twist[3]; /* x = .. + a xi + b eta + twist xi eta */
    for (int i = 0; i < 3; i++) {
        const double p = x[2][i] - x[0][i], q = x[1][i] - x[3][i];
        a[i] = 0.25 * (p + q);
        b[i] = 0.25 * (p - q);
        twist[i] = 0.25 * ((x[0][i] - x[1][i]) + (x[2][i] - x[3][i]));
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double plain = a[j] * b[k] - a[k] * b[j];
        const double along_xi = a[j] * twist[k] - a[k] * twist[j];
        const double along_eta = twist[j] * b[k] - twist[k] * b[j];
        for (int c = 0; c < 4; c++)
            area[c][i] = plain + (xi[c] * along_xi + eta[c] * along_eta) / 3.0;
    }
}
