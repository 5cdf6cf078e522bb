/* See critical_step.h. */
#include "physics/critical_step.h"

#include <math.h>

#include "base/elementary.h"

double critical_step_rayleigh(double radius, double density, double young, double poisson)
{
    const double pi = 3.14159265358979323846;
    const double shear = young / (2.0 * (1.0 + poisson));
    return pi * radius * sqrt(density / shear) / (0.1631 * poisson + 0.8766);
}

double critical_step_hertz_duration(double mass, double radius, double young, double speed)
{
    return 2.87 *
           elementary_exp(0.2 * elementary_log(mass * mass / (radius * young * young * speed)));
}

/* Compares quotients, which are correctly rounded; products with powers of ten would make 11 of
 * 12. */
double critical_step_round_down(double x)
{
    double scale = 1.0;
    while (10.0 / scale > x)
        scale *= 10.0;
    while (100.0 / scale <= x)
        scale /= 10.0;
    double digits = (double)(int)(x * scale) + 1.0;
    while (digits / scale > x)
        digits -= 1.0;
    return digits / scale;
}
