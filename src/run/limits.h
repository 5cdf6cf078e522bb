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
struct material_pair;
struct materials;
struct packing_sphere;

/* An impact of a sphere on the partner that makes it shortest or longest. */
struct limits_impact {
    double duration;     /* [s] */
    const char *partner; /* material */
};

/* Radii of the spheres of a material; `most` is 0 where there are none [m]. */
struct limits_sizes {
    double least, most;
};

/* All spheres that a run will have, in short. */
struct limits_spheres {
    double speed; /* highest that can be foreseen [m/s] */
    double mass;  /* of all together [kg] */
    int n_materials;
    struct limits_sizes *sizes; /* one a material */
};

struct limits {
    double rayleigh; /* least of the spheres [s]                                      (6.1) */
    double springs;  /* critical step of such contacts, least of all [s]           (6.7) */
    double speed;    /* as of limits_spheres [m/s] */
    double overlap;  /* largest of an impact at that speed, over radius [-] */
    struct limits_impact shortest, longest;
    struct limits_spheres *all; /* where sizes of spheres are noted */
};

/* No sphere yet, none in motion. */
void limits_spheres_init(struct limits_spheres *spheres, const struct job *job);
void limits_spheres_clear(struct limits_spheres *spheres);

/* No sphere yet: everything is infinite. */
struct limits limits_nothing(struct limits_spheres *all);
/* What this sphere allows, with whatever partners its material has.  Its size is noted. */
void limits_add(struct limits *limits, const struct job *job, const struct materials *materials,
                const struct packing_sphere *sphere);
/* Speed after a fall through half the domain along gravity; 1 m/s without gravity. */
double limits_fall_speed(const struct job *job);

/* One of the spheres on a wall: an impact as fast as can be foreseen, and a contact under as
 * much as may rest on it, a column of its like as high as the domain, or all spheres. */
struct limits_strike {
    int material;        /* of the sphere */
    double radius, mass; /* [m], [kg] */
    double overlap,
        force; /* of the impact at its deepest, on a wall that does not yield [m], [N] */
    double struck, pressed; /* contact radii of the impact and of what rests; 0: nothing [m] */
};
struct limits_strike limits_strike(const struct limits_spheres *spheres, const struct job *job,
                                   const struct material_pair *pair, int material,
                                   double radius);
/* Of all spheres the one that strikes such a wall with the greatest force; a force of 0 where
 * nothing can. */
struct limits_strike limits_hardest_strike(const struct limits_spheres *spheres,
                                           const struct job *job,
                                           const struct materials *materials, int wall);

/* The step that `step: auto` takes: `safety` of the Rayleigh step, but no more than four fifths
 * of what the springs allow, rounded down to two digits [s]. */
double limits_step(const struct limits *limits, double safety);

/* By how much restitution scatters with the phase of first touch, at so many steps a contact
 * (THEORY.md, section 1.2; between what is measured there, a power). */
double limits_scatter(double n_steps);

#endif
