/* Damping for a restitution that was asked for, against published values and the closed
 * form. */
#include "check.h"

#include <math.h>

#include "model/restitution.h"

#define PI 3.14159265358979323846

/* The usual formula, exact for a contact that may pull. */
static double usual_damping(double e)
{
    return -log(e) / sqrt(PI * PI + log(e) * log(e));
}

/* THEORY.md (1.23): what a contact that cannot pull returns. */
static double closed_form(double beta)
{
    if (beta < 1.0)
        return exp(-beta / sqrt(1.0 - beta * beta) * (PI - 2.0 * asin(beta)));
    const double omega = sqrt(beta * beta - 1.0);
    return exp(-beta / omega * log((beta + omega) / (beta - omega)));
}

TEST(usual_damping_returns_too_much)
{
    const double table[][2] = {{.9, .9020}, {.8, .8081}, {.6, .6323},
                               {.5, .5503}, {.4, .4720}, {.2, .3249}};
    for (int k = 0; k < 6; k++)
        EXPECT_NEAR(restitution_returned(usual_damping(table[k][0])), table[k][1], 6e-5);
}

TEST(agrees_with_the_closed_form)
{
    for (double beta = 0.01; beta < 6.0; beta *= 1.07)
        EXPECT_NEAR(restitution_returned(beta), closed_form(beta), 1e-13);
}

TEST(asked_and_returned)
{
    for (double e = RESTITUTION_LEAST; e < 1.0; e += 0.0137) {
        EXPECT_NEAR(restitution_returned(restitution_damping(e)), e, 1e-14);
        EXPECT_NEAR(closed_form(restitution_damping(e)), e, 1e-13);
    }
}

TEST(elastic_has_no_damping)
{
    EXPECT(restitution_damping(1.0) == 0.0);
    EXPECT_NEAR(restitution_returned(0.0), 1.0, 1e-15);
    EXPECT(restitution_damping(1.0 - 1e-9) > 0.0);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
