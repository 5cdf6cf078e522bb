/*
 * See principal.h.  Jacobi's rotations, in cycles through the three elements beside the
 * diagonal until these are 0: the error is a rounding of the greatest value even where two
 * values are the same, which formulas with an arc cosine do not give, and nothing but + - * /
 * and the square root is used, so the bits are those of the matrix.
 */
#include "physics/principal.h"

#include <math.h>

enum { CYCLES = 16 /* five do it */ };

/* The rotation in the plane i, j that makes a[i][j] zero. */
static void rotate(double a[3][3], int i, int j)
{
    const int k = 3 - i - j;
    const double across = a[i][j];
    if (!(fabs(across) > 0.0))
        return;
    const double slope = (a[j][j] - a[i][i]) / (2.0 * across);
    const double root = sqrt(slope * slope + 1.0); /* may be infinite */
    const double t = slope < 0.0 ? -1.0 / (root - slope) : 1.0 / (root + slope);
    const double c = 1.0 / sqrt(t * t + 1.0), s = t * c;
    const double ik = a[i][k], jk = a[j][k];
    a[i][i] -= t * across;
    a[j][j] += t * across;
    a[i][j] = a[j][i] = 0.0;
    a[i][k] = a[k][i] = c * ik - s * jk;
    a[j][k] = a[k][j] = s * ik + c * jk;
}

static void order(double *high, double *low)
{
    const double swap = *high;
    if (*high >= *low)
        return;
    *high = *low;
    *low = swap;
}

void principal_values(const double matrix[6], double values[3])
{
    double a[3][3] = {{matrix[0], matrix[3], matrix[5]},
                      {matrix[3], matrix[1], matrix[4]},
                      {matrix[5], matrix[4], matrix[2]}};
    for (int cycle = 0; cycle < CYCLES; cycle++) {
        rotate(a, 0, 1);
        rotate(a, 1, 2);
        rotate(a, 2, 0);
    }
    for (int i = 0; i < 3; i++)
        values[i] = a[i][i];
    order(&values[0], &values[1]);
    order(&values[1], &values[2]);
    order(&values[0], &values[1]);
}
