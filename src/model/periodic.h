/*
 * Space that repeats: what leaves on one side of the domain comes in on the other.
 *
 * Along a periodic direction every place is a multiple of a quantum, and so is the period:
 * adding and subtracting it is exact.  A sphere and its image a period away therefore see the
 * same differences, to the last bit, and moving a place by a period changes nothing but the
 * place.  Between searches places may run past the boundary; the place *within* the domain
 * (low <= x < high) is what all see that depends on where things are: bodies, sections, the
 * canonical order, files.  (THEORY.md, section 5.1)
 */
#ifndef TREMIE_MODEL_PERIODIC_H
#define TREMIE_MODEL_PERIODIC_H

#include <stdbool.h>

#include "base/vec3.h"

struct job;

struct periodic {
    bool any;               /* is any direction periodic? */
    bool along[3];          /* x, y, z */
    double low[3], high[3]; /* where it repeats [m]; known only along periodic directions */
    double period[3];       /* high - low, exactly; 0 along other directions [m] */
    double quantum[3];      /* places are multiples of it; 0: any number [m] */
    double snap[3];         /* (d + snap) - snap is d rounded to the quantum; 0: d itself [m] */
    double shortest;        /* least period; infinite without any [m] */
};

/* As the job says.  Local. */
void periodic_init(struct periodic *periodic, const struct job *job);

/* A place rounded to the quantum and brought into the domain: where spheres are born. */
struct vec3 periodic_settled(const struct periodic *periodic, struct vec3 x);
/* Brings a place into the domain; turns[] says by how many periods it lay beyond. */
void periodic_wrap(const struct periodic *periodic, double x[3], int turns[3]);

/* The place within the domain. */
static inline struct vec3 periodic_place(const struct periodic *periodic, const double x[3])
{
    double place[3] = {x[0], x[1], x[2]};
    int turns[3];
    if (periodic->any)
        periodic_wrap(periodic, place, turns);
    return (struct vec3){place[0], place[1], place[2]};
}

/* The same way to the nearest image. */
struct vec3 periodic_shortest(const struct periodic *periodic, struct vec3 way);

enum { PERIODIC_IMAGES = 27 };

/* Where images of a sphere lie, beside it: n shifts of one period at most along each periodic
 * direction, the first of them none at all.  Returns n. */
int periodic_shifts(const struct periodic *periodic, double shifts[PERIODIC_IMAGES][3]);

#endif
