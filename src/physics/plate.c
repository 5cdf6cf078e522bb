/*
 * See plate.h.  Deflections of rectangles are Timoshenko's tables, drawn into formulas that
 * are 5 % off at most; what stretches is added as a spring beside them, as is usual for plates
 * that bend by more than their thickness.
 */
#include "physics/plate.h"

#include <math.h>

#include "base/elementary.h"

/* Of a long strip w D / p a^4 under pressure and w D / F a^2 under a force: Timoshenko and
 * Woinowsky-Krieger, tables 35 and 8, 37 and 23. */
static const double PRESSED[2] = {1.0 / 384.0, 5.0 / 384.0}; /* clamped, hinged */
static const double PUSHED[2] = {0.00725, 0.01695};

static double power(double x, double exponent)
{
    return x > 0.0 ? elementary_exp(exponent * elementary_log(x)) : 0.0;
}

double plate_stiffness(const struct plate *plate)
{
    const double t = plate->thickness, nu = plate->poisson;
    return plate->young * t * t * t / (12.0 * (1.0 - nu * nu));
}

/* A wall as springs, for a load q of the deflection w: q = (bend + curve) w + stretch w^3. */
struct springs {
    double bend, curve, stretch;
};

/* Where all of them together bear the load. */
static struct plate_sag settle(const struct springs *springs, double load)
{
    enum { ROUNDS = 200 };
    const double linear = springs->bend + springs->curve, cubic = springs->stretch;
    if (!(linear > 0.0))
        return (struct plate_sag){(double)INFINITY, 0.0};
    double w = load / linear; /* from above, so Newton's steps stay there */
    for (int k = 0; k < ROUNDS; k++) {
        const double off = (linear + cubic * w * w) * w - load;
        const double next = w - off / (linear + 3.0 * cubic * w * w);
        if (!(next < w))
            break;
        w = next;
    }
    return (struct plate_sag){w, load > 0.0 ? springs->bend * w / load : 1.0};
}

/* What a curved wall resists by its curvature, as a bed of springs: hoops [N/m3]. */
static double bedding(const struct plate *plate)
{
    return plate->young * plate->thickness * plate->curvature * plate->curvature;
}

struct plate_sag plate_under_pressure(const struct plate *plate, double pressure, bool hinged)
{
    const double s = plate->ratio, s2 = s * s, a2 = plate->span * plate->span;
    const double stiffer = hinged ? 1.0 + 2.207 * s2 * s : 1.0 + 1.067 * s2 * s2;
    const double stretch = 23.4 + 7.7 * s2 * s2; /* w = 0.318 a (p a / E t)^(1/3) of a square */
    struct springs springs = {.curve = bedding(plate)};
    if (plate->span > 0.0) {
        springs.bend = plate_stiffness(plate) * stiffer / (PRESSED[hinged] * a2 * a2);
        springs.stretch = stretch * plate->young * plate->thickness / (a2 * a2);
    }
    return settle(&springs, pressure);
}

struct plate_sag plate_under_force(const struct plate *plate, double force, bool hinged)
{
    const double s = plate->ratio, s2 = s * s, a2 = plate->span * plate->span;
    const double stiffer = hinged ? 1.0 + 0.461 * s2 * s2 : 1.0 + 0.295 * s2 * s2 * s;
    const double bend = plate_stiffness(plate);
    const double half = 4.0 * sqrt(bedding(plate) * bend); /* bent as much as hooped */
    struct springs springs = {.bend = half, .curve = half};
    if (plate->span > 0.0) {
        springs.bend += bend * stiffer / (PUSHED[hinged] * a2);
        /* Schwerin's round membrane, 9 pi/16 E t w^3/r^2, r half the span */
        springs.stretch = 7.07 * plate->young * plate->thickness / a2;
    }
    return settle(&springs, force);
}

double plate_zener(const struct plate *plate, double mass, double depth, double speed)
{
    const double time = 0.9147 * depth / speed; /* [s] */
    const double resists =
        8.0 * sqrt(plate_stiffness(plate) * plate->density * plate->thickness); /* [kg/s] */
    return mass / (resists * time);
}

double plate_restitution(double zener)
{
    return elementary_exp(-1.719 * zener);
}

double plate_blow(double zener)
{
    return 1.0 / (1.0 + 1.04 * zener);
}

double plate_blow_on_spring(double yields)
{
    enum { ROUNDS = 60 };
    double low = 0.0, high = 1.0;
    for (int k = 0; k < ROUNDS; k++) {
        const double x = 0.5 * (low + high);
        if (power(x, 5.0 / 3.0) + 1.25 * yields * x * x < 1.0)
            low = x;
        else
            high = x;
    }
    return 0.5 * (low + high);
}

double plate_reach(const struct plate *plate, double depth, double speed)
{
    const double lasts = 2.943 * depth / speed; /* [s] */
    return sqrt(lasts * sqrt(plate_stiffness(plate) / (plate->density * plate->thickness)));
}
