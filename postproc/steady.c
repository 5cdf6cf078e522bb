/* See steady.h. */
#include "steady.h"

#include <math.h>
#include <stdio.h>

static const double SHARE_LEAST = 0.2; /* of the flow's time that a window must cover */
static const double ENDS_FAR = 3.0;    /* standard deviations */
static const double RATE_LEAST = 2.0;  /* half widths of the interval */
static const double CORRELATED = 0.4;  /* between neighbouring batches */

struct batches {
    int n;
    double begin, length; /* [s] */
    double rate[STEADY_BATCHES_MAX];
};

struct moments {
    double mean, deviation;
};

double steady_student(int degrees)
{
    /* Expansion in 1/degrees of the quantile about the normal one (Abramowitz and Stegun
     * 26.7.5). */
    const double z = 1.959963984540054, v = degrees;
    const double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z, z9 = z7 * z * z;
    return z + (z3 + z) / (4.0 * v) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * v * v) +
           (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * v * v * v) +
           (79.0 * z9 + 776.0 * z7 + 1482.0 * z5 - 1920.0 * z3 - 945.0 * z) /
               (92160.0 * v * v * v * v);
}

void steady_write_interval(char text[STEADY_TEXT_SIZE], double value, double half_width)
{
    if (!(half_width > 1e-12 * fabs(value)) || half_width > 1e9 || half_width < 1e-9) {
        snprintf(text, STEADY_TEXT_SIZE, "%.6g +- %.2g", value, half_width);
        return;
    }
    const double unit = pow(10.0, floor(log10(half_width)) - 1.0);
    const int decimals = unit < 0.5 ? (int)lround(-log10(unit)) : 0;
    snprintf(text, STEADY_TEXT_SIZE, "%.*f +- %.*f", decimals, round(value / unit) * unit,
             decimals, round(half_width / unit) * unit);
}

/* The total at any time, linear between samples. */
static double total_at(int n, const double *time, const double *total, double t)
{
    int low = 0, high = n - 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (time[middle] <= t)
            low = middle;
        else
            high = middle;
    }
    const double share = (t - time[low]) / (time[high] - time[low]);
    return total[low] + (share < 1.0 ? share : 1.0) * (total[high] - total[low]);
}

static struct moments moments_of(int n, const double *values)
{
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < n; i++)
        sum += values[i];
    for (int i = 0; i < n; i++)
        squares += (values[i] - sum / n) * (values[i] - sum / n);
    return (struct moments){sum / n, sqrt(squares / (n - 1))};
}

/*
 * Is a trend there?  Slope and curvature are the components along the first two orthogonal
 * polynomials of equally spaced points, so each is tested by itself against what the parabola
 * leaves over.
 */
static bool has_trend(int n, const double *values, double mean)
{
    double along[2] = {0.0, 0.0}, norm[2] = {0.0, 0.0}, all = 0.0;
    const double middle = 0.5 * (n - 1), spread = (n * (double)n - 1.0) / 12.0;
    for (int i = 0; i < n; i++) {
        const double x = i - middle, basis[2] = {x, x * x - spread};
        for (int k = 0; k < 2; k++) {
            along[k] += basis[k] * (values[i] - mean);
            norm[k] += basis[k] * basis[k];
        }
        all += (values[i] - mean) * (values[i] - mean);
    }
    const double parts[2] = {along[0] * along[0] / norm[0], along[1] * along[1] / norm[1]};
    const double rest = all - parts[0] - parts[1];
    const double t = steady_student(n - 3 > 4 ? n - 3 : 4);
    const double limit = t * t * (rest > 0.0 ? rest : 0.0) / (n - 3) + 1e-24 * n * mean * mean;
    return parts[0] > limit || parts[1] > limit;
}

static bool ends_far(int n, const double *values, struct moments moments)
{
    const int ends[4] = {0, 1, n - 2, n - 1};
    for (int k = 0; k < 4; k++)
        if (fabs(values[ends[k]] - moments.mean) >
            ENDS_FAR * moments.deviation + 1e-12 * fabs(moments.mean))
            return true;
    return false;
}

static bool window_is_steady(int n, const double *values)
{
    /* The deviation of the inner batches: those at the ends are on trial. */
    const struct moments inner = moments_of(n - 4, values + 2), all = moments_of(n, values);
    const struct moments judge = {inner.mean, n - 4 >= STEADY_BATCHES_LEAST ? inner.deviation
                                                                            : all.deviation};
    return !ends_far(n, values, judge) && !has_trend(n, values, all.mean);
}

/* Correlation of neighbouring batches. */
static double correlation(int n, const double *values, struct moments moments)
{
    double sum = 0.0;
    for (int i = 0; i + 1 < n; i++)
        sum += (values[i] - moments.mean) * (values[i + 1] - moments.mean);
    const double variance = moments.deviation * moments.deviation * (n - 1);
    return variance > 0.0 ? sum / variance : 0.0;
}

/* Rate and interval of a window. */
static void measure(struct steady *steady, const struct batches *batches, int first, int n)
{
    double values[STEADY_BATCHES_MAX];
    for (int i = 0; i < n; i++)
        values[i] = batches->rate[first + i];
    steady->found = true;
    steady->from = batches->begin + first * batches->length;
    steady->to = steady->from + n * batches->length;
    steady->rate = moments_of(n, values).mean;
    while (n >= 2 * STEADY_BATCHES_LEAST &&
           correlation(n, values, moments_of(n, values)) > CORRELATED) {
        n /= 2;
        for (int i = 0; i < n; i++)
            values[i] = 0.5 * (values[2 * i] + values[2 * i + 1]);
    }
    steady->n_batches = n;
    steady->half_width = steady_student(n - 1) * moments_of(n, values).deviation / sqrt(n);
}

static void search_windows(struct steady *steady, const struct batches *batches)
{
    const int share = (int)ceil(SHARE_LEAST * batches->n);
    const int least = share > STEADY_BATCHES_LEAST ? share : STEADY_BATCHES_LEAST;
    for (int n = batches->n; n >= least + 2; n--) {
        int best = -1;
        double best_deviation = INFINITY;
        for (int first = 0; first + n <= batches->n; first++) {
            const double deviation = moments_of(n, batches->rate + first).deviation;
            if (deviation < best_deviation && window_is_steady(n, batches->rate + first)) {
                best = first;
                best_deviation = deviation;
            }
        }
        if (best >= 0) {
            measure(steady, batches, best + 1, n - 2);
            return;
        }
    }
    snprintf(steady->why, sizeof steady->why,
             "the rate drifts in every window of %.0f %% or more of the flow's time",
             100.0 * SHARE_LEAST);
}

/* First and last row between which the total changes; false when it never does. */
static bool find_flow(int n, const double *total, int *first, int *last)
{
    int low = 0, high = n - 1;
    while (low < n - 1 && total[low + 1] == total[0])
        low++;
    while (high > 0 && total[high - 1] == total[n - 1])
        high--;
    *first = low;
    *last = high;
    return low < high;
}

struct steady steady_find(int n, const double *time, const double *total)
{
    struct steady steady = {0};
    int first, last;
    if (n < 2 || !find_flow(n, total, &first, &last)) {
        snprintf(steady.why, sizeof steady.why,
                 n < 2 ? "there are fewer than two samples" : "nothing passed");
        return steady;
    }
    steady.flows = true;
    steady.begin = time[first];
    steady.end = time[last];
    const int n_intervals = last - first;
    struct batches batches = {.n = n_intervals < STEADY_BATCHES_MAX ? n_intervals
                                                                    : STEADY_BATCHES_MAX,
                              .begin = steady.begin};
    if (batches.n < STEADY_BATCHES_LEAST + 2) {
        snprintf(steady.why, sizeof steady.why,
                 "it flows in %d samples only; at least %d are needed", n_intervals,
                 STEADY_BATCHES_LEAST + 2);
        return steady;
    }
    batches.length = (steady.end - steady.begin) / batches.n;
    for (int i = 0; i < batches.n; i++)
        batches.rate[i] = (total_at(n, time, total, batches.begin + (i + 1) * batches.length) -
                           total_at(n, time, total, batches.begin + i * batches.length)) /
                          batches.length;
    search_windows(&steady, &batches);
    if (steady.found && !(fabs(steady.rate) >= RATE_LEAST * steady.half_width)) {
        steady.found = false;
        snprintf(steady.why, sizeof steady.why,
                 "the rate scatters too much: %.3g +- %.2g in the best window", steady.rate,
                 steady.half_width);
    }
    return steady;
}
