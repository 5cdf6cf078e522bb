/* See eigenvalue.h.  The 4096th root of the trace of the matrix's 4096th power. */
#include "physics/eigenvalue.h"

#include <math.h>
#include <string.h>

static double trace_of(int n, double (*g)[EIGENVALUE_SIZE])
{
    double sum = g[0][0];
    for (int i = 1; i < n; i++)
        sum += g[i][i];
    return sum;
}

/* g <- (g / scale)^2 */
static void square(int n, double (*g)[EIGENVALUE_SIZE], double scale)
{
    double next[EIGENVALUE_SIZE][EIGENVALUE_SIZE];
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            g[i][j] /= scale;
    for (int i = 0; i < n; i++) {
        memset(next[i], 0, sizeof next[i]);
        for (int k = 0; k < n; k++)
            for (int j = 0; j < n; j++)
                next[i][j] += g[i][k] * g[k][j];
    }
    memcpy(g, next, (size_t)n * sizeof *g);
}

/* The root of as high a degree as there have been rounds. */
static double root_of(const double *scale, int rounds)
{
    double root = scale[rounds];
    for (int round = rounds - 1; round >= 0; round--)
        root = scale[round] * sqrt(root);
    return root;
}

double eigenvalue_bound(int n, const double *matrix, double enough)
{
    enum { SQUARINGS = 12 };
    double g[EIGENVALUE_SIZE][EIGENVALUE_SIZE] = {{0.0}}, scale[SQUARINGS + 1];
    for (int i = 0; i < n; i++)
        memcpy(g[i], matrix + (size_t)i * (size_t)n, (size_t)n * sizeof *matrix);
    for (int round = 0; round < SQUARINGS; round++) {
        scale[round] = trace_of(n, g);
        if (!(scale[round] > 0.0))
            return scale[round]; /* no strain resists, or no number */
        const double bound = enough > 0.0 ? root_of(scale, round) : 0.0;
        if (bound > 0.0 && bound <= enough)
            return bound;
        square(n, g, scale[round]);
    }
    scale[SQUARINGS] = trace_of(n, g);
    return scale[SQUARINGS] > 0.0 ? root_of(scale, SQUARINGS) : scale[SQUARINGS];
}

double eigenvalue_largest(int n, const double *matrix)
{
    return eigenvalue_bound(n, matrix, 0.0);
}
