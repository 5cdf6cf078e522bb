/* See ticks.h. */
#include "ticks.h"

#include <math.h>
#include <stdio.h>

double ticks_round_up(double value)
{
    static const double steps[] = {1.0, 2.0, 2.5, 5.0, 10.0};
    const double power = pow(10.0, floor(log10(value)));
    for (int i = 0; i < 5; i++)
        if (value <= steps[i] * power * (1.0 + 1e-12))
            return steps[i] * power;
    return 10.0 * power;
}

static double round_step(double rough)
{
    const double power = pow(10.0, floor(log10(rough)));
    const double lead = rough / power;
    return (lead < 1.5 ? 1.0 : lead < 3.5 ? 2.0 : lead < 7.5 ? 5.0 : 10.0) * power;
}

static void write_tick(char *text, double value, double step, double largest)
{
    const int decimals = (int)ceil(-log10(step) - 1e-9);
    if (largest >= 1e6 || largest < 1e-3)
        snprintf(text, TICKS_TEXT_SIZE, "%.3g", value);
    else
        snprintf(text, TICKS_TEXT_SIZE, "%.*f", decimals > 0 ? decimals : 0, value);
}

struct ticks ticks_between(double least, double most, int wanted)
{
    struct ticks ticks = {0};
    const double step = round_step((most - least) / wanted);
    const double largest = fabs(most) > fabs(least) ? fabs(most) : fabs(least);
    const double slack = 1e-9 * (most - least);
    for (double k = ceil((least - slack) / step);
         k * step <= most + slack && ticks.n < TICKS_MAX; k += 1.0) {
        ticks.values[ticks.n] = k * step + 0.0; /* not -0 */
        write_tick(ticks.texts[ticks.n], ticks.values[ticks.n], step, largest);
        ticks.n++;
    }
    return ticks;
}
