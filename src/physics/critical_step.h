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
 * What contacts do to the step.
 *
 * Contacts are springs and dashpots between masses.  The highest frequency that a set of them
 * can have is bounded sphere by sphere, from the contacts on it alone: each contact is split
 * between its two spheres, and what is then on a sphere is a matrix of its six freedoms.  So
 * the bound needs no neighbours' neighbours.  It comes in two strengths: sums over a sphere's
 * contacts, cheap, and the matrix, worth its cost where the sums leave a doubt.  Either holds;
 * tests/stability measures how far the real limit is above.
 */

/* A contact, as integration feels it. */
struct critical_step_contact {
    /* Across and along the contact, and of rolling and twisting, as at an arm of R* [N/m]. */
    double stiffness[3];
    double damping[3]; /* likewise, times 4, 2, 2: dashpots use velocities of the past [kg/s] */
};

/* The largest of what a contact's springs or dashpots have, across and along. */
static inline double critical_step_stiffest(const double parts[3])
{
    const double most = parts[0] > parts[1] ? parts[0] : parts[1];
    return most > parts[2] ? most : parts[2];
}

/* The contact of radius a [m] between spheres of effective mass m* [kg].  (6.3) */
struct critical_step_contact critical_step_contact(const struct material_pair *pair,
                                                   double contact_radius, double mass);

/* What of a contact falls to the first sphere; curvatures in 1/m, of a wall 0. */
struct critical_step_side {
    double share; /* of the contact, over the sphere's mass [1/kg]  (6.4) */
    double arm;   /* R* over R, squared [-] */
};
struct critical_step_side critical_step_side(double inverse_mass, double curvature,
                                             double curvature_of_partner);

/* Sums over a sphere's contacts: of the stiffer direction, turning included. */
struct critical_step_sums {
    double stiffness; /* [1/s2] */
    double damping;   /* [1/s] */
};
void critical_step_add(struct critical_step_sums *sums,
                       const struct critical_step_contact *contact,
                       const struct critical_step_side *side);
/* The step up to which such springs are stable [s]; infinite without springs.  (6.5) */
double critical_step_of_sums(const struct critical_step_sums *sums);

/* The same as a matrix over the three directions and three axes; rotation is measured such that
 * inertia is the mass.  (6.6) */
struct critical_step_matrix {
    double stiffness[6][6]; /* [1/s2] */
    double damping[6][6];   /* [1/s] */
};
/* Adds a contact whose normal points away from the sphere. */
void critical_step_add_matrix(struct critical_step_matrix *matrix,
                              const struct critical_step_contact *contact,
                              const struct critical_step_side *side, const double normal[3]);
/* dt^2 / 4 times the largest eigenvalue, or up to 6 % more: not above 1 is stable [-]. */
double critical_step_load(const struct critical_step_matrix *matrix, double dt);
/* The step at which that is 1 [s]. */
double critical_step_of_matrix(const struct critical_step_matrix *matrix);

/* What n equal contacts on all sides are to a sphere among its like: add one that is deeper
 * with critical_step_add().  (6.7) */
struct critical_step_sums critical_step_amid(const struct critical_step_contact *contact,
                                             double inverse_mass, int n);

/* Overlap at rest of a sphere that weighs this much on one contact [m], from weight [N] and
 * 1/R* [1/m]. */
double critical_step_rest_overlap(const struct material_pair *pair, double weight,
                                  double inverse_radius);
/* Largest overlap of an elastic impact at this speed [m], from effective mass [kg] and speed
 * [m/s]. (1.25) */
double critical_step_impact_overlap(const struct material_pair *pair, double mass,
                                    double inverse_radius, double speed);

/* How long such an impact lasts [s]. */
double critical_step_duration(const struct material_pair *pair, double mass,
                              double inverse_radius, double speed);

/* The largest number of two significant decimal digits that is not above x > 0. */
double critical_step_round_down(double x);

#endif
