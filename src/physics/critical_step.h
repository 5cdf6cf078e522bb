/*
 * Steps beyond which explicit integration fails, and how long contacts last (THEORY.md,
 * "Critical step").
 */
#ifndef TREMIE_PHYSICS_CRITICAL_STEP_H
#define TREMIE_PHYSICS_CRITICAL_STEP_H

/* Time of a Rayleigh wave around a sphere: pi R sqrt(rho/G) / (0.1631 nu + 0.8766) [s].  The
 * usual bound on the step of spheres in contact.  (6.1) */
double critical_step_rayleigh(double radius, double density, double young, double poisson);

/* Duration of an elastic Hertz impact: 2.87 (m*^2 / (R* E*^2 v))^(1/5) [s], from effective
 * mass, radius, modulus and the approach velocity [SI].  For reports only.  (6.2) */
double critical_step_hertz_duration(double mass, double radius, double young, double speed);

/* The largest number of two significant decimal digits that is not above x > 0. */
double critical_step_round_down(double x);

#endif
