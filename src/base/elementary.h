/*
 * Elementary functions whose bits depend on their argument alone.
 *
 * The C library chooses variants by processor and compilers fold constants with yet another
 * one, so what feeds simulated state is evaluated here: range reduction and Taylor polynomials
 * in + - * /. Errors stay below about 2 units in the last place.
 */
#ifndef TREMIE_BASE_ELEMENTARY_H
#define TREMIE_BASE_ELEMENTARY_H

/* |x| up to 8e8 [rad]; NaN beyond. */
double elementary_sin(double x);
double elementary_cos(double x);
/* -infinity at 0, NaN below. */
double elementary_log(double x);
double elementary_exp(double x);
/* Angle of the direction (x, y), from -pi to pi; 0 where both are. */
double elementary_atan2(double y, double x);

#endif
