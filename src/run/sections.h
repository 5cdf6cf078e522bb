/*
 * Sections: planes, discs and rectangles that count what passes through them, each way, by
 * number and mass, in all and apart by material and size class.
 *
 * A sphere passes when its centre's side of the plane changes; sides are state (a bit a
 * section).  A disc or a rectangle counts only what passes within it: the place of the passage
 * follows from the place and velocity after the step, along which the sphere has just moved.
 * Only spheres that can reach a plane before the next search are looked at: a saving that
 * changes no count.  A plane across a periodic direction is repeated with it: sides are those
 * of the nearest image, and change without being counted half way between two.
 */
#ifndef TREMIE_RUN_SECTIONS_H
#define TREMIE_RUN_SECTIONS_H

#include "run/tally.h"

struct job;
struct job_section;
struct spheres;

/* Passages forward (along the normal) and backward. */
struct sections_count {
    struct tally passed[2];
};

struct sections {
    int n;
    const struct job_section *list;
    struct sections_count *counts; /* one a section: this rank's share, since step 0 */
    int n_near, near_capacity;
    struct sections_near {
        int sphere, section;
    } * near;
};

void sections_init(struct sections *sections, const struct job *job);
void sections_clear(struct sections *sections);
/* Sets the side bits of owned sphere i as it is now (at its birth). */
void sections_begin(const struct sections *sections, struct spheres *spheres, int i);
/* Lists who is near; at each search.  Local. */
void sections_search(struct sections *sections, const struct spheres *spheres);
/* Counts who has passed; after each step.  Local. */
void sections_pass(struct sections *sections, struct spheres *spheres);

#endif
