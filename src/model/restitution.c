/*
 * Restitution of the contact that cannot pull, by integration, and its inverse, by bisection.
 *
 * A head-on impact through Hertz's spring and its dashpot is, in a stretched time and with the
 * root of the elastic energy for a coordinate, a linear oscillator with the damping ratio beta:
 * THEORY.md (1.21).  So steps by a Taylor series hold to the last digits, and from the first
 * touch on, where the contact in its own time starts with an infinite derivative.  The contact
 * ends when its force falls to zero.
 *
 * There is a closed form with exp and arcsin (THEORY.md (1.23), the tests compare with it);
 * this needs neither, so it gives the same bits everywhere.  A pair of materials costs some
 * hundred microseconds, once.
 */
#include "model/restitution.h"

#include "base/report.h"

enum {
    TAYLOR_TERMS = 10, /* with STRIDE: relative error of a step below 1e-17 */
    BISECTIONS = 60,   /* to the last bit of a double */
};
#define STRIDE 0.0625

/* p'' + 2 beta p' + p = 0, in units of the oscillator's own time. */
struct oscillator {
    double p; /* 0 at first touch */
    double v; /* 1 at first touch */
};

/* Spring and dashpot together: positive from just after the first touch to the end. */
static double push(struct oscillator now, double beta)
{
    return now.p + 2.0 * beta * now.v;
}

static struct oscillator advanced(struct oscillator now, double beta, double time)
{
    struct oscillator sum = now, term = now;

    for (int k = 1; k <= TAYLOR_TERMS; k++) {
        const double share = time / k;
        const struct oscillator next = {share * term.v, -share * push(term, beta)};
        sum.p += next.p;
        sum.v += next.v;
        term = next;
    }
    return sum;
}

double restitution_returned(double damping)
{
    const double stride = STRIDE / (1.0 + 2.0 * damping);
    struct oscillator now = {0.0, 1.0}, next = advanced(now, damping, stride);
    double early = 0.0, late = stride;

    while (push(next, damping) > 0.0) {
        now = next;
        next = advanced(now, damping, stride);
    }
    for (int k = 0; k < BISECTIONS; k++) {
        const double middle = 0.5 * (early + late);
        if (push(advanced(now, damping, middle), damping) > 0.0)
            early = middle;
        else
            late = middle;
    }
    return -advanced(now, damping, early).v;
}

double restitution_damping(double restitution)
{
    CHECK(restitution >= RESTITUTION_LEAST && restitution <= 1.0, "no damping returns %g",
          restitution);
    if (!(restitution < 1.0))
        return 0.0;

    double weak = 0.0, strong = 1.0;
    while (restitution_returned(strong) > restitution)
        strong *= 2.0;
    for (int k = 0; k < BISECTIONS; k++) {
        const double middle = 0.5 * (weak + strong);
        if (restitution_returned(middle) > restitution)
            weak = middle;
        else
            strong = middle;
    }
    return 0.5 * (weak + strong);
}
