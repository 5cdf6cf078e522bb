/*
 * The first frequency of a cantilever.  One-point hexahedra bend through their hourglass modes:
 * of the beam's stiffness in bending, n cells across have 1 - 1/n^2 by their mean strains, the
 * rest by hourglass stiffness, which is right where it is the one of (12.10).
 */
#include <math.h>
#include <stdio.h>

#include "cantilever.h"
#include "verify.h"

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Solids: cantilever, 1 m x .05 m x .05 m",
                 "1.8751^2/2 pi sqrt(EI/(rho A L^4))");
    const double theory = cantilever_theory(), bending = cantilever_bending_stiffness();
    char text[128];
    double error[2];
    for (int n = 1; n <= 2; n++) {
        snprintf(text, sizeof text, "%d cells across, hourglass stiffness for bending %.3f", n,
                 bending);
        verify_row(text, "1/s", theory, cantilever_frequency(n, bending), 0.01, VERIFY_RELATIVE,
                   "shear and the clamp: beam theory knows neither");
    }
    for (int k = 0; k < 2; k++) {
        const int n = 2 << k;
        const double share = 1.0 - (1.0 - 0.1 / bending) / (n * n);
        const double got = cantilever_frequency(n, 0.1);
        error[k] = got / theory - 1.0;
        snprintf(text, sizeof text, "%d cells across, hourglass stiffness .1", n);
        verify_row(text, "1/s", theory * sqrt(share), got, 0.01, VERIFY_RELATIVE,
                   "as above; softer by what is missing of 1/n^2");
    }
    verify_source("second order in the size of cells");
    verify_row("order of the error from 2 to 4 cells across", "", 2.0,
               log2(fabs(error[0] / error[1])), 0.25, VERIFY_ABSOLUTE,
               "what beam theory neglects, .2 %, beside 2 %");
    return verify_end();
}
