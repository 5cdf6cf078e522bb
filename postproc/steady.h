/*
 * The steady part of a flow, and its rate with a confidence interval.
 *
 * Given is what has passed (mass [kg], say) as a running total over time.  The time during
 * which anything passes is cut into batches of equal length, each with its mean rate.  A window
 * of batches is called steady when
 *   - fitted by a parabola, neither its slope nor its curvature differs from zero at the 5 %
 *     level, and
 *   - its first two and last two batches lie within three standard deviations of its mean (a
 *     flow that starts or ends within a batch must not hide in the noise).
 * The longest such window counts, of equal ones that with the least scatter, if it has enough
 * batches and covers enough of the flow.  The batch at either end is dropped: the end of a ramp
 * may hide in its noise.  The mean rate comes with a 95 % interval from the batch means and
 * Student's t; where neighbouring batches are still correlated, they are merged in pairs first.
 * A rate below twice its half-width counts as none.
 *
 * Drawbacks: choosing the longest of many windows makes the test a little kinder than 5 %; a
 * slow drift below the noise is not seen.  The interval speaks of this one flow, not of other
 * packings.
 */
#ifndef TREMIE_POSTPROC_STEADY_H
#define TREMIE_POSTPROC_STEADY_H

#include <stdbool.h>

enum { STEADY_BATCHES_MAX = 32, STEADY_BATCHES_LEAST = 6, STEADY_TEXT_SIZE = 160 };

struct steady {
    bool flows;        /* anything passed */
    double begin, end; /* of the flow [s] */
    bool found;        /* a steady window; else `why` says what is missing */
    char why[STEADY_TEXT_SIZE];
    double from, to;   /* the window [s] */
    int n_batches;     /* that the interval rests on */
    double rate;       /* mean over the window [per s] */
    double half_width; /* of the 95 % interval [per s] */
};

/* n samples of a running total at increasing times. */
struct steady steady_find(int n, const double *time, const double *total);

/* A number with its uncertainty, both to the latter's second digit: "29430 +- 710". */
void steady_write_interval(char text[STEADY_TEXT_SIZE], double value, double half_width);

/* Student's t for a two-sided 95 % interval, 4 or more degrees of freedom (to three digits). */
double steady_student(int degrees);

#endif
