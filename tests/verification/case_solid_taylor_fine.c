/*
 * Taylor's copper cylinder, in finer cells, and the order with which it converges: taylor.h.
 * What 2 cells have and 4 have not goes with the size to the same power as what 3 have and 6
 * have not, two thirds as large.  Where all is smooth that power is 2.  The rim of the foot is
 * not: there free surface folds on to the wall, strain has no bound, and the radius of the foot
 * is that rim's, so it comes with the first.
 */
/* long */
#include <math.h>

#include "taylor.h"
#include "verify.h"

/* The power, and what is left where cells are as small as can be. */
static double order_of(double two, double three, double four, double six, double *limit)
{
    const double order = log((two - four) / (three - six)) / log(1.5);
    *limit = six - (three - six) / (exp2(order) - 1.0);
    return order;
}

static void order_rows(const struct taylor_result *two, const struct taylor_result *three,
                       const struct taylor_result *four, const struct taylor_result *six)
{
    double length, foot;
    const double of_length =
        order_of(two->length, three->length, four->length, six->length, &length);
    const double of_foot = order_of(two->foot, three->foot, four->foot, six->foot, &foot);
    verify_row("extrapolated: length at 80 us", "mm", 21.4, 1e3 * length, 0.1, VERIFY_ABSOLUTE,
               "published results lie between 21.3 and 21.5");
    verify_row("extrapolated: radius of the foot", "mm", 7.0, 1e3 * foot, 0.25, VERIFY_ABSOLUTE,
               "published results lie between 6.9 and 7.2, of cells no finer");
    verify_source("second order, first at the rim of the foot");
    verify_row("order of the length, by 2, 4 and 3, 6 cells along half a radius", "", 1.5,
               of_length, 0.5, VERIFY_ABSOLUTE, "1 to 2: the rim is part of it");
    verify_row("order of the radius of the foot, likewise", "", 1.0, of_foot, 0.25,
               VERIFY_ABSOLUTE, "strain at the rim grows as cells get smaller");
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Solids: Taylor bar, finer",
                 "commonly quoted; E 117e9, nu .35, rho 8930, sy 400e6, H 100e6");
    const struct taylor_result two = taylor_run(2, 24), three = taylor_run(3, 36),
                               four = taylor_run(4, 48), six = taylor_run(6, 72);
    taylor_rows(&six, 6, 72);
    order_rows(&two, &three, &four, &six);
    return verify_end();
}
