/*
 * See sizes.h.  A density by number is tabulated at radii in geometric steps and goes
 * straight between them; with CELLS cells over at most 18 deviations, the cumulative
 * distribution is off by less than 1e-5.  Each curve is cut off REACH deviations from its
 * middle, beyond which there is less than one radius in 1e18.  A draw is one random number, a
 * bisection and a square root.
 */
#include "model/sizes.h"

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/elementary.h"
#include "base/random.h"
#include "job/job.h"

enum { CELLS = 4096 };

static const double REACH = 9.0;                                 /* [deviations] */
static const double SPHERE = 4.18879020478639098461685784437267; /* 4/3 pi */

/* The density asked for, by number or by mass, as exp(-(x - middle)^2/(2 deviation^2)) of
 * x = r or x = ln r, or even. */
struct curve {
    bool bell, logarithmic;
    bool by_mass;
    double middle, deviation;
    double
        nearest; /* least (x - middle)^2/(2 deviation^2): keeps exponentials from vanishing */
    double unit; /* a radius [m] that others are measured by */
};

/* The share of `value` in a bell's exponent. */
static double exponent(const struct curve *curve, double radius)
{
    const double x = curve->logarithmic ? elementary_log(radius) : radius;
    const double z = (x - curve->middle) / curve->deviation;
    return 0.5 * z * z;
}

/* The density by number, to some scale.                                    (11.1), (11.2) */
static double density(const struct curve *curve, double radius)
{
    const double r = radius / curve->unit;
    double value = 1.0;
    if (curve->bell)
        value = elementary_exp(curve->nearest - exponent(curve, radius));
    if (curve->logarithmic)
        value = value / r;
    if (curve->by_mass)
        value = value / (r * r * r);
    return value;
}

/* Appends n cells with radii in geometric steps; `share` is the area below the curve there, or
 * 0: as it is.  Returns the radius at the end. */
static void add_cells(struct sizes *sizes, const struct curve *curve, double from, double to,
                      int n)
{
    const double ratio = elementary_log(to / from) / (double)n;
    double radius = from;
    for (int k = 1; k <= n; k++) {
        const double end = k < n ? from * elementary_exp((double)k * ratio) : to;
        sizes->cells[sizes->n++] = (struct sizes_cell){.radius = radius,
                                                       .width = end - radius,
                                                       .low = density(curve, radius),
                                                       .high = density(curve, end)};
        radius = end;
    }
}

static double cell_area(const struct sizes_cell *cell)
{
    return cell->width > 0.0 ? 0.5 * (cell->low + cell->high) * cell->width : cell->low;
}

static double cubed(double r)
{
    return r * r * r;
}

/* The integral of r^3 times the density over a cell, by Simpson's rule. */
static double cell_volume(const struct sizes_cell *cell)
{
    const double a = cell->radius, b = a + cell->width, middle = a + 0.5 * cell->width;
    if (cell->width == 0.0)
        return cell->low * cubed(a);
    return cell->width / 6.0 *
           (cell->low * cubed(a) + 2.0 * (cell->low + cell->high) * cubed(middle) +
            cell->high * cubed(b));
}

/* Sums the cells up to a cumulative distribution. */
static void finish(struct sizes *sizes)
{
    double area = 0.0, volume = 0.0, sum = 0.0;
    for (int c = 0; c < sizes->n; c++) {
        area += cell_area(&sizes->cells[c]);
        volume += cell_volume(&sizes->cells[c]);
    }
    sizes->min = HUGE_VAL;
    sizes->max = 0.0;
    for (int c = 0; c < sizes->n; c++) {
        struct sizes_cell *cell = &sizes->cells[c];
        const double end = cell->radius + cell->width;
        sum += cell_area(cell);
        cell->below = sum / area;
        sizes->min = cell->radius < sizes->min ? cell->radius : sizes->min;
        sizes->max = end > sizes->max ? end : sizes->max;
    }
    sizes->cells[sizes->n - 1].below = 1.0;
    sizes->mean_volume = SPHERE * volume / area;
}

/* One curve between the limits, or as much of it as is not nothing. */
static void build_curve(struct sizes *sizes, struct curve *curve, double least, double most)
{
    double low = least, high = most;
    if (curve->bell) {
        const double spread = curve->deviation * REACH;
        const double shift = curve->logarithmic && curve->by_mass
                                 ? 3.0 * curve->deviation * curve->deviation
                                 : 0.0;
        double a = curve->middle - spread - shift, b = curve->middle + spread;
        a = curve->logarithmic ? elementary_exp(a) : a;
        b = curve->logarithmic ? elementary_exp(b) : b;
        low = a > low ? a : low;
        high = b < high ? b : high;
        const double below = exponent(curve, low), above = exponent(curve, high);
        const double x = curve->logarithmic ? elementary_exp(curve->middle) : curve->middle;
        curve->nearest = x >= low && x <= high ? 0.0 : below < above ? below : above;
    }
    curve->unit = high;
    sizes->cells = array_allocate(CELLS, sizeof *sizes->cells);
    add_cells(sizes, curve, low, high, CELLS);
}

/* A logarithm's mean and deviation from those of the radius itself.               (11.2) */
static struct curve lognormal(const struct job_sizes *asked, bool by_mass)
{
    const double spread = asked->deviation / asked->mean;
    const double variance = elementary_log(1.0 + spread * spread);
    return (struct curve){.bell = true,
                          .logarithmic = true,
                          .by_mass = by_mass,
                          .middle = elementary_log(asked->mean) - 0.5 * variance,
                          .deviation = sqrt(variance)};
}

/* Between two points of the table the number, or the mass, is spread evenly. */
static void build_table(struct sizes *sizes, const struct job_sizes *asked, bool by_mass)
{
    const int n_each = CELLS / asked->n + 16;
    struct curve curve = {.by_mass = by_mass, .unit = asked->list[asked->n - 1].radius};
    sizes->cells = array_allocate((size_t)asked->n * (size_t)n_each, sizeof *sizes->cells);
    for (int i = 1; i < asked->n; i++) {
        const double from = asked->list[i - 1].radius, to = asked->list[i].radius;
        const double share = asked->list[i].share - asked->list[i - 1].share;
        const int first = sizes->n;
        if (!(share > 0.0))
            continue;
        add_cells(sizes, &curve, from, to, n_each);
        for (int c = first; c < sizes->n; c++) {
            sizes->cells[c].low *= share / (to - from);
            sizes->cells[c].high *= share / (to - from);
        }
    }
}

static void build_list(struct sizes *sizes, const struct job_sizes *asked, bool by_mass)
{
    sizes->cells = array_allocate((size_t)asked->n, sizeof *sizes->cells);
    for (int i = 0; i < asked->n; i++) {
        const struct job_size *size = &asked->list[i];
        const double weight =
            by_mass ? size->share / cubed(size->radius / asked->list[0].radius) : size->share;
        if (weight > 0.0)
            sizes->cells[sizes->n++] =
                (struct sizes_cell){.radius = size->radius, .low = weight, .high = weight};
    }
}

void sizes_build(struct sizes *sizes, const struct job_sizes *asked, double radius)
{
    const bool by_mass = asked->by == JOB_SIZES_BY_MASS;
    struct job_size one = {radius, 1.0};
    const struct job_sizes single = {.kind = JOB_SIZES_LIST, .n = 1, .list = &one};
    struct curve curve = {.by_mass = by_mass};
    *sizes = (struct sizes){0.0, 0.0, 0.0, 0, NULL};
    if (!asked->given) {
        build_list(sizes, &single, false);
        finish(sizes);
        return;
    }
    switch (asked->kind) {
    case JOB_SIZES_LIST:
        build_list(sizes, asked, by_mass);
        break;
    case JOB_SIZES_UNIFORM:
        build_curve(sizes, &curve, asked->min, asked->max);
        break;
    case JOB_SIZES_NORMAL:
        curve.bell = true;
        curve.middle = asked->mean;
        curve.deviation = asked->deviation;
        build_curve(sizes, &curve, asked->min, asked->max);
        break;
    case JOB_SIZES_LOGNORMAL:
        curve = lognormal(asked, by_mass);
        build_curve(sizes, &curve, asked->min, asked->max);
        break;
    case JOB_SIZES_TABLE:
        build_table(sizes, asked, by_mass);
        break;
    }
    finish(sizes);
}

void sizes_clear(struct sizes *sizes)
{
    free(sizes->cells);
    *sizes = (struct sizes){0.0, 0.0, 0.0, 0, NULL};
}

/* Where in its cell a share of it lies: the root of a quadratic.                  (11.3) */
static double within(const struct sizes_cell *cell, double share)
{
    const double p = cell->low, q = cell->high;
    const double root = sqrt(p * p + share * (q * q - p * p));
    return p + root > 0.0 ? share * (p + q) / (p + root) : 0.0;
}

double sizes_draw(const struct sizes *sizes, uint64_t seed, uint64_t stream, int64_t k)
{
    if (sizes->n == 1 && sizes->cells[0].width == 0.0)
        return sizes->cells[0].radius;
    const double u = random_unit(seed, stream, (uint64_t)k);
    int low = 0, high = sizes->n - 1; /* the first cell that ends beyond u */
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (sizes->cells[middle].below > u)
            high = middle;
        else
            low = middle + 1;
    }
    const struct sizes_cell *cell = &sizes->cells[low];
    const double begin = low > 0 ? sizes->cells[low - 1].below : 0.0;
    const double share = cell->below > begin ? (u - begin) / (cell->below - begin) : 0.0;
    const double end = cell->radius + cell->width;
    const double radius = cell->radius + cell->width * within(cell, share);
    return radius < end ? radius : end;
}

double sizes_share_below(const struct sizes *sizes, double radius)
{
    double share = 0.0;
    for (int c = 0; c < sizes->n; c++) {
        const struct sizes_cell *cell = &sizes->cells[c];
        const double begin = c > 0 ? sizes->cells[c - 1].below : 0.0;
        const double t = cell->width > 0.0 ? (radius - cell->radius) / cell->width
                                           : (radius >= cell->radius ? 1.0 : 0.0);
        const double in = t <= 0.0   ? 0.0
                          : t >= 1.0 ? 1.0
                                     : t * (2.0 * cell->low + t * (cell->high - cell->low)) /
                                           (cell->low + cell->high);
        share += in * (cell->below - begin);
    }
    return share;
}
