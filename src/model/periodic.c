/*
 * See periodic.h.  The quantum is 2^-52 of a power of two B that is at least twice the largest
 * coordinate and two periods: then what lies a period or two beyond the domain is still a
 * multiple of it that a double holds.  The constant that rounds to it, 1.5 B, does so up to
 * B/2.
 */
#include "model/periodic.h"

#include <math.h>
#include <stdint.h>

#include "job/job.h"

static double larger(double a, double b)
{
    return a > b ? a : b;
}

static double rounded(double d, double snap)
{
    return (d + snap) - snap;
}

static void begin_along(struct periodic *periodic, int k, double min, double max)
{
    const double beyond = 2.0 * (larger(fabs(min), fabs(max)) + (max - min));
    double bound = 0x1p-100;
    while (bound < beyond)
        bound *= 2.0;
    periodic->along[k] = periodic->any = true;
    periodic->quantum[k] = bound * 0x1p-52;
    periodic->snap[k] = 1.5 * bound;
    periodic->low[k] = rounded(min, periodic->snap[k]);
    periodic->high[k] = rounded(max, periodic->snap[k]);
    periodic->period[k] = periodic->high[k] - periodic->low[k];
    if (periodic->period[k] < periodic->shortest)
        periodic->shortest = periodic->period[k];
}

void periodic_init(struct periodic *periodic, const struct job *job)
{
    const struct vec3 low = job->domain.min, high = job->domain.max;
    const double min[3] = {low.x, low.y, low.z}, max[3] = {high.x, high.y, high.z};
    *periodic = (struct periodic){.shortest = INFINITY};
    for (int k = 0; k < 3; k++)
        if (job->domain.periodic & 1 << k)
            begin_along(periodic, k, min[k], max[k]);
}

/* Periods by which x lies beyond the domain; 0 where it has run away from all bounds. */
static int turns_of(const struct periodic *periodic, int k, double x)
{
    const double low = periodic->low[k], high = periodic->high[k], period = periodic->period[k];
    if (x >= low && x < high)
        return 0;
    const double away = (x - low) / period;
    if (!(away > -1e6 && away < 1e6))
        return 0;
    int turns = (int)away;
    while (x - turns * period >= high)
        turns++;
    while (x - turns * period < low)
        turns--;
    return turns;
}

void periodic_wrap(const struct periodic *periodic, double x[3], int turns[3])
{
    for (int k = 0; k < 3; k++) {
        turns[k] = periodic->along[k] ? turns_of(periodic, k, x[k]) : 0;
        if (turns[k] != 0)
            x[k] -= turns[k] * periodic->period[k];
    }
}

struct vec3 periodic_shortest(const struct periodic *periodic, struct vec3 way)
{
    double w[3] = {way.x, way.y, way.z};
    for (int k = 0; k < 3 && periodic->any; k++) {
        const double period = periodic->period[k], half = 0.5 * period;
        if (!periodic->along[k] || (w[k] >= -half && w[k] < half) ||
            !(fabs(w[k]) < 1e6 * period))
            continue;
        w[k] -= period * (double)(int64_t)(w[k] / period);
        if (w[k] >= half)
            w[k] -= period;
        else if (w[k] < -half)
            w[k] += period;
    }
    return (struct vec3){w[0], w[1], w[2]};
}

struct vec3 periodic_settled(const struct periodic *periodic, struct vec3 x)
{
    double place[3] = {x.x, x.y, x.z};
    int turns[3];
    if (!periodic->any)
        return x;
    periodic_wrap(periodic, place, turns);
    for (int k = 0; k < 3; k++)
        if (periodic->along[k])
            place[k] = rounded(place[k], periodic->snap[k]);
    periodic_wrap(periodic, place, turns); /* rounding may reach the upper end */
    return (struct vec3){place[0], place[1], place[2]};
}

int periodic_shifts(const struct periodic *periodic, double shifts[PERIODIC_IMAGES][3])
{
    static const int codes[3] = {0, -1, 1};
    int n = 0;
    for (int code = 0; code < PERIODIC_IMAGES; code++) {
        const int digits[3] = {code % 3, code / 3 % 3, code / 9};
        bool exists = true;
        for (int k = 0; k < 3; k++)
            exists = exists && (digits[k] == 0 || periodic->along[k]);
        if (!exists)
            continue;
        for (int k = 0; k < 3; k++)
            shifts[n][k] = codes[digits[k]] * periodic->period[k];
        n++;
    }
    return n;
}
