/*
 * Sine, cosine, logarithm, exponential and arcus tangent by range reduction and Taylor series:
 * see elementary.h.
 *
 * Angles: x - n pi/2 with pi/2 cut into pieces of 24 bits, so that n times a piece is exact for
 * |n| < 2^29; what the one inexact subtraction drops is kept as a tail.  The remainder lies
 * within +-pi/4, where the series to r^17 leaves 1e-19.
 * Logarithm: x = 2^k m with m within sqrt(1/2)..sqrt(2), then 2 atanh((m-1)/(m+1)).
 * Exponential: x = n ln 2 + r with |r| <= ln(2)/2, then the series to r^14.
 * Arcus tangent: t within 0..1 is taken relative to the nearest eighth; the series to r^15.
 * Taylor series need a term or two more than minimax polynomials, but their coefficients
 * explain themselves; nothing here is hot.
 */
#include "base/elementary.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

static const double REDUCIBLE = 8e8;       /* keeps n below 2^29 */
static const double TO_INTEGER = 0x1.8p52; /* adding and taking away rounds to a whole number */
static const double LN2_HIGH = 0x1.62e42feep-1; /* 32 bits, so that n times it is exact */
static const double LN2_LOW = 0x1.a39ef35793c76p-33;

static double from_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static uint64_t to_bits(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* 2^n for normal results. */
static double power_of_two(int n)
{
    return from_bits((uint64_t)(n + 1023) << 52);
}

struct reduced {
    double angle, tail; /* x = quadrant pi/2 + angle + tail, |angle| <= pi/4 */
    int quadrant;       /* 0..3 */
};

static struct reduced reduce_angle(double x)
{
    const double n = (x * 0x1.45f306dc9c883p-1 + TO_INTEGER) - TO_INTEGER;
    const double rough = (x - n * 0x1.921fb4p+0) - n * 0x1.4442dp-24;
    const double lost = n * 0x1.846988p-48;
    const double angle = rough - lost;
    const double tail = ((rough - angle) - lost) - n * 0x1.8cc51701b839ap-72;
    return (struct reduced){angle, tail, (int)((int64_t)n & 3)};
}

static double sin_near(double r, double tail)
{
    const double z = r * r;
    double p = 1.0 / 355687428096000.0;
    p = p * z - 1.0 / 1307674368000.0;
    p = p * z + 1.0 / 6227020800.0;
    p = p * z - 1.0 / 39916800.0;
    p = p * z + 1.0 / 362880.0;
    p = p * z - 1.0 / 5040.0;
    p = p * z + 1.0 / 120.0;
    p = p * z - 1.0 / 6.0;
    return r + (r * z * p + tail * (1.0 - 0.5 * z));
}

static double cos_near(double r, double tail)
{
    const double z = r * r;
    double p = -1.0 / 6402373705728000.0;
    p = p * z + 1.0 / 20922789888000.0;
    p = p * z - 1.0 / 87178291200.0;
    p = p * z + 1.0 / 479001600.0;
    p = p * z - 1.0 / 3628800.0;
    p = p * z + 1.0 / 40320.0;
    p = p * z - 1.0 / 720.0;
    p = p * z + 1.0 / 24.0;
    const double half = 0.5 * z, main = 1.0 - half;
    return main + (((1.0 - main) - half) + (z * z * p - r * tail));
}

static double quarter_wave(struct reduced reduced, int shift)
{
    const int quadrant = (reduced.quadrant + shift) & 3;
    const double value = (quadrant & 1) ? cos_near(reduced.angle, reduced.tail)
                                        : sin_near(reduced.angle, reduced.tail);
    return (quadrant & 2) ? -value : value;
}

double elementary_sin(double x)
{
    if (!(x <= REDUCIBLE && x >= -REDUCIBLE))
        return (double)NAN;
    if (x == 0.0)
        return x;
    return quarter_wave(reduce_angle(x), 0);
}

double elementary_cos(double x)
{
    if (!(x <= REDUCIBLE && x >= -REDUCIBLE))
        return (double)NAN;
    return quarter_wave(reduce_angle(x), 1);
}

double elementary_log(double x)
{
    if (x == 0.0)
        return -(double)INFINITY;
    if (!(x > 0.0))
        return (double)NAN;
    if (!(x <= 0x1.fffffffffffffp1023))
        return x;
    int k = 0;
    if (x < 0x1p-1022) {
        x *= 0x1p54;
        k = -54;
    }
    k += (int)(to_bits(x) >> 52) - 1023;
    double m = from_bits((to_bits(x) & 0xfffffffffffff) | ((uint64_t)1023 << 52));
    if (m > 0x1.6a09e667f3bcdp0) {
        m *= 0.5;
        k++;
    }
    const double f = m - 1.0, s = f / (2.0 + f), z = s * s;
    double p = 2.0 / 25.0;
    for (int odd = 23; odd >= 3; odd -= 2)
        p = p * z + 2.0 / (double)odd;
    /* 2 atanh(s) = f - f^2/2 + s (f^2/2 + z p): the large terms are exact or nearly so. */
    const double half = 0.5 * f * f, n = (double)k;
    return n * LN2_HIGH - ((half - (s * (half + z * p) + n * LN2_LOW)) - f);
}

double elementary_exp(double x)
{
    if (x != x)
        return x;
    if (x > 709.79)
        return (double)INFINITY;
    if (x < -745.14)
        return 0.0;
    const double n = (x * 0x1.71547652b82fep+0 + TO_INTEGER) - TO_INTEGER;
    const double r = (x - n * LN2_HIGH) - n * LN2_LOW;
    double p = 1.0;
    for (int k = 14; k >= 3; k--)
        p = 1.0 + p * r / (double)k;
    const double value = 1.0 + (r + 0.5 * r * r * p);
    /* Two factors, since 2^n alone may not be a normal number. */
    const int half = (int)n / 2;
    return value * power_of_two(half) * power_of_two((int)n - half);
}

/* Of 0 <= t <= 1. */
static double atan_to_one(double t)
{
    static const double eighths[] = {0.0,
                                     0x1.fd5ba9aac2f6ep-4,
                                     0x1.f5b75f92c80ddp-3,
                                     0x1.6f61941e4def1p-2,
                                     0x1.dac670561bb4fp-2,
                                     0x1.1e00babdefeb4p-1,
                                     0x1.4978fa3269ee1p-1,
                                     0x1.700a7c5784634p-1,
                                     0x1.921fb54442d18p-1};
    const int k = (int)(8.0 * t + 0.5);
    const double near = 0.125 * (double)k, r = (t - near) / (1.0 + t * near), z = r * r;
    double p = 0.0;
    for (int odd = 15; odd >= 3; odd -= 2)
        p = 1.0 / (double)odd - z * p;
    return eighths[k] + (r - r * z * p);
}

double elementary_atan2(double y, double x)
{
    const double up = y < 0.0 ? -y : y, along = x < 0.0 ? -x : x;
    if (x != x || y != y)
        return (double)NAN;
    if (!(up > 0.0 || along > 0.0))
        return 0.0;
    double angle =
        up > along ? 0x1.921fb54442d18p+0 - atan_to_one(along / up) : atan_to_one(up / along);
    angle = x < 0.0 ? 0x1.921fb54442d18p+1 - angle : angle;
    return y < 0.0 ? -angle : angle;
}
