/*
 * The real limit of the step of a scene that is at rest, found by bisection.
 *
 * The scene comes to rest under background damping at a small step and is saved.  Each trial
 * restarts from that checkpoint at another step, without background damping, gives spheres a
 * little motion, far below what opens a contact, and looks whether it grows.
 */
#ifndef TREMIE_TESTS_STABILITY_LIMIT_H
#define TREMIE_TESTS_STABILITY_LIMIT_H

enum limit_push {
    LIMIT_PUSH_ALL,
    LIMIT_PUSH_X,    /* along x alone */
    LIMIT_PUSH_Z,    /* along z alone */
    LIMIT_PUSH_SPIN, /* along x, and about y */
};

struct limit {
    double step;         /* the real limit, to 2e-3 of it [s] */
    double bound;        /* critical step of the contacts at rest (THEORY.md (6.5)) [s] */
    double automatic;    /* what `step: auto` takes [s] */
    double rayleigh;     /* least Rayleigh step of the spheres [s] */
    double partners;     /* contacts of a sphere, in the mean */
    double overlap_mean; /* over radius */
};

/* `yaml` is a job without `time`, with damping to come to rest within `n_steps` of `dt`. */
struct limit limit_find(const char *yaml, double dt, int n_steps, enum limit_push push);

#endif
