/*
 * What solids allow of the time step, known before a run: their elements alone by the bounds
 * that the watch goes by, (12.11) to (12.13), and with the contacts that may be expected on
 * their nodes.
 *
 * Contacts are not there yet.  On each node of the surface are taken: what its own ball and
 * those of other solids can do, where `touches` lets them, while rigid bodies that forces move
 * yield to as many of them as may meet it at once; of spheres one that strikes as fast as can
 * be foreseen, and as many as find room on what the node stands for, each pressed by what may
 * rest on it.  What does happen is watched in the run (run/watch.h).
 */
#ifndef TREMIE_RUN_SOLID_STEP_H
#define TREMIE_RUN_SOLID_STEP_H

#include <stdbool.h>

struct bodies;
struct job;
struct job_body;
struct limits_spheres;
struct materials;

/* Share of such a step that the automatic step takes: elements that are pressed together allow
 * less. */
#define SOLID_STEP_SHARE 0.7

struct solid_step {
    double step; /* stable up to this [s] */
    int element; /* of the body's mesh, that allows no more */
    int node;    /* its corner with the stiffest contacts; -1: none are expected */
    bool of_spheres, of_bodies; /* contacts of which it was asked */
};

/* Of the elements of body b, which is a solid, without contacts.  Local. */
struct solid_step solid_step_alone(const struct job *job, int b);
/* Of those at its surface as its own nodes touch bodies, whichever these are.  Local. */
struct solid_step solid_step_touching(const struct job *job, const struct bodies *bodies,
                                      int b);
/* With all contacts that may be expected; `spheres` NULL: of bodies alone, and of elements at
 * the surface.  Local. */
struct solid_step solid_step_with_contacts(const struct job *job, const struct bodies *bodies,
                                           const struct materials *materials,
                                           const struct limits_spheres *spheres, int b);
/* What is safe as bodies touch, of all solids' elements at the surface, as long as none flows
 * much; infinite without any [s].  Local. */
double solid_step_safe(const struct job *job, const struct bodies *bodies);
/* What `step: auto` takes of the least of all contacts: less where a solid will flow.  (12.21)
 * Local. */
double solid_step_auto(const struct job *job, const struct bodies *bodies,
                       const struct materials *materials, const struct limits_spheres *spheres);

/* By how much a solid would flow in the mean if all its motion at the start went into that; 0
 * where it never yields [-].  Local. */
double solid_step_flow(const struct job *job, const struct job_body *body);

#endif
