/*
 * What a scene allows of the time step, known before it runs: the Rayleigh step, the step that
 * the springs of the expected contacts allow, and how many steps an impact lasts.
 *
 * Contacts are not there yet, so they are expected: a sphere amid eight partners of its size,
 * each pressed on it as by a column of spheres as high as the domain, that another strikes at
 * the highest speed that can be foreseen.  What does happen is watched in the run
 * (run/watch.h).
 */
#ifndef TREMIE_RUN_LIMITS_H
#define TREMIE_RUN_LIMITS_H

struct job;
struct materials;
struct packing_sphere;

/* An impact of a sphere on the partner that makes it shortest or longest. */
struct limits_impact {
    double duration;     /* [s] */
    const char *partner; /* material */
};

struct limits {
    double rayleigh; /* least of the spheres [s]                                      (6.1) */
    double springs;  /* critical step of such contacts, least of all [s]           (6.7) */
    double speed;    /* highest that can be foreseen [m/s] */
    double overlap;  /* largest of an impact at that speed, over radius [-] */
    struct limits_impact shortest, longest;
};

/* No sphere yet: everything is infinite. */
struct limits limits_nothing(double speed);
/* What this sphere allows, with whatever partners its material has; limits->speed is given. */
void limits_add(struct limits *limits, const struct job *job, const struct materials *materials,
                const struct packing_sphere *sphere);
/* Speed after a fall through half the domain along gravity; 1 m/s without gravity. */
double limits_fall_speed(const struct job *job);

/* The step that `step: auto` takes: `safety` of the Rayleigh step, but no more than four fifths
 * of what the springs allow, rounded down to two digits [s]. */
double limits_step(const struct limits *limits, double safety);

/* By how much restitution scatters with the phase of first touch, at so many steps a contact
 * (THEORY.md, section 1.2; between what is measured there, a power). */
double limits_scatter(double n_steps);

#endif
