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

static void add_power(struct ticks *ticks, double least, double most, double lead, int power)
{
    const double at = log10(lead) + power, slack = 1e-9 * (most - least);
    if (at < least - slack || at > most + slack || ticks->n >= TICKS_MAX)
        return;
    ticks->values[ticks->n] = lead * pow(10.0, power);
    if (power < -3 || power > 4)
        snprintf(ticks->texts[ticks->n], TICKS_TEXT_SIZE, "%.0fe%d", lead, power);
    else
        snprintf(ticks->texts[ticks->n], TICKS_TEXT_SIZE, "%g", ticks->values[ticks->n]);
    ticks->n++;
}

struct ticks ticks_of_decades(double least, double most)
{
    struct ticks ticks = {0};
    const int first = (int)floor(least), last = (int)ceil(most);
    const int stride = 1 + (last - first) / (TICKS_MAX - 2);
    for (int power = first; power <= last; power += stride) {
        add_power(&ticks, least, most, 1.0, power);
        if (most - least > 2.5)
            continue;
        add_power(&ticks, least, most, 2.0, power);
        add_power(&ticks, least, most, 5.0, power);
    }
    return ticks;
}
