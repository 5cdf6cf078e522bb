/*
 * How plates bend, stretch and ring: closed forms for what can be said of a wall before a run
 * (THEORY.md, 10.5).  Estimates, for people; nothing here feeds the state.
 *
 * A plate is a rectangle, held all round against moving; its edges are clamped or hinged, and
 * what is real lies between.
 */
#ifndef TREMIE_PHYSICS_PLATE_H
#define TREMIE_PHYSICS_PLATE_H

#include <stdbool.h>

struct plate {
    double thickness;               /* [m] */
    double young, poisson, density; /* [Pa], [-], [kg/m3] */
    double span;                    /* the lesser of its sides; 0: nothing holds it [m] */
    double ratio;                   /* of that to the other side, up to 1 [-] */
    double curvature;               /* of a curved wall, 1/R of a cylinder [1/m] */
};

/* How far it yields, and which shares of the load bending and all else bear. */
struct plate_sag {
    double deflection; /* in the middle; infinite where nothing holds it [m] */
    double bending;    /* of the load [-] */
};

/* D = E t^3 / 12 (1 - nu^2) [N m]. */
double plate_stiffness(const struct plate *plate);
/* Under this pressure all over it [Pa].  (10.11), (10.12) */
struct plate_sag plate_under_pressure(const struct plate *plate, double pressure, bool hinged);
/* Under this force in its middle [N].  (10.13) */
struct plate_sag plate_under_force(const struct plate *plate, double force, bool hinged);

/* Zener's parameter of a sphere of this mass [kg] that would go this deep [m] into a wall that
 * does not yield, at this speed [m/s].  (10.15) */
double plate_zener(const struct plate *plate, double mass, double depth, double speed);
/* What of the restitution and of the greatest force is left on a large plate.  (10.16) */
double plate_restitution(double zener);
double plate_blow(double zener);
/* What is left of the greatest force of an impact on a spring that would yield, under that
 * force, by this many times the contact's depth.  (10.17) */
double plate_blow_on_spring(double yields);
/* How far bending waves get while such an impact lasts [m].  (10.20) */
double plate_reach(const struct plate *plate, double depth, double speed);

#endif
