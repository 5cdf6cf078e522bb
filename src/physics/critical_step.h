/*
 * Steps beyond which explicit integration fails, and how long contacts last (THEORY.md,
 * "Critical step").
 */
#ifndef TREMIE_PHYSICS_CRITICAL_STEP_H
#define TREMIE_PHYSICS_CRITICAL_STEP_H

#include "model/material.h"

/* Time of a Rayleigh wave around a sphere: pi R sqrt(rho/G) / (0.1631 nu + 0.8766) [s].  The
 * usual bound on the step of spheres in contact.  (6.1) */
double critical_step_rayleigh(double radius, double density, double young, double poisson);

/* Duration of an elastic Hertz impact: 2.87 (m*^2 / (R* E*^2 v))^(1/5) [s], from effective
 * mass, radius, modulus and the approach velocity [SI].  For reports only.  (6.2) */
double critical_step_hertz_duration(double mass, double radius, double young, double speed);

/*
 * What one contact does to the step, and what all of a sphere's contacts do.
 *
 * Contacts are springs between masses.  The highest frequency that a set of them can have is
 * bounded sphere by sphere, from the springs on it alone: so the bound needs no eigenvalues and
 * no neighbours' neighbours.  It is a bound, not the limit; tests/stability measures the
 * distance.
 */
struct critical_step_spring {
    double stiffness; /* of the stiffer direction, turning included [N/m]          (6.3) */
    double damping;   /* likewise, as integration takes it [kg/s]                  (6.4) */
};

/* The spring of a contact of radius a [m] between spheres of effective mass m* [kg]. */
struct critical_step_spring critical_step_spring(const struct material_pair *pair,
                                                 double contact_radius, double mass);

/* Sums over the contacts of a sphere. */
struct critical_step_sums {
    /* With neighbours taken at their own mass, and as if they had the sphere's. */
    double stiffness[2]; /* [1/s2] */
    double damping[2];   /* [1/s] */
};

/* Adds a contact with a partner; inverse masses in 1/kg, the partner's 0 for a wall. */
void critical_step_add(struct critical_step_sums *sums,
                       const struct critical_step_spring *spring, double inverse_mass,
                       double inverse_mass_of_partner);

/* The step up to which springs of these sums are stable [s]; infinite without springs.  Over
 * all spheres take the least for k = 0 and for k = 1; the larger of the two holds.  (6.5) */
double critical_step_bound(const struct critical_step_sums *sums, int k);

/* Overlap at rest of a sphere that weighs this much on one contact [m], from weight [N] and
 * 1/R* [1/m]. */
double critical_step_rest_overlap(const struct material_pair *pair, double weight,
                                  double inverse_radius);
/* Largest overlap of an elastic impact at this speed [m], from effective mass [kg] and speed
 * [m/s]. (1.25) */
double critical_step_impact_overlap(const struct material_pair *pair, double mass,
                                    double inverse_radius, double speed);

/* The largest number of two significant decimal digits that is not above x > 0. */
double critical_step_round_down(double x);

#endif
