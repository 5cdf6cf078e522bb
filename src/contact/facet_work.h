/* What facet_contact, facet_groups and facet_step share, and keep from step to step. */
#ifndef TREMIE_CONTACT_FACET_WORK_H
#define TREMIE_CONTACT_FACET_WORK_H

#include <stdbool.h>

#include "base/vec3.h"
#include "contact/facet_circles.h"
#include "contact/facet_contact.h"
#include "contact/facet_kernel.h"
#include "contact/facet_local.h"
#include "contact/facet_patch.h"
#include "contact/facet_tree.h"

/* The entries of a sphere with a body, begin to end of the list; `near` numbers those from
 * begin on that may touch until the two have moved by `slack`. */
struct facet_work_group {
    int begin, end, n_near;
    int sphere;       /* index */
    bool is_alone;    /* nothing else is listed of the sphere */
    int circle;       /* its place among the circles that may be; -1: not there */
    double slack;     /* [m]; negative: not looked at yet */
    double travelled; /* by bodies when it was looked at [m] */
    struct vec3 from; /* where the sphere was [m] */
};

/* Until when a group's near entries are all that may touch: what facet_contacts.moved and the
 * way of the fastest body may come to. */
struct facet_work_due {
    double moved, travelled; /* [-], [m] */
};

/* What a batch's contact pushes of a surface that deforms. */
struct facet_work_pushed {
    int begin, end;      /* corners; none of a contact that ends */
    double pressure;     /* of the normal spring [Pa] */
    struct vec3 elastic; /* its force, on the body [N] */
    bool holds_energy;   /* of the normal spring: of several parts one does */
};

struct facet_work {
    struct facet_tree *trees; /* one a body */
    bool has_trees;
    struct facet_tree_found found, across;
    int next_capacity;
    struct facet_contact *next; /* the list that is being made */
    struct facet_local local;
    struct facet_patch patch;
    enum isa isa;
    struct facet_kernel_batch batch;
    struct facet_work_pushed pushed[FACET_KERNEL_BATCH]; /* of bodies that deform */
    struct facet_kernel_circles standing; /* of groups with one near entry, while that is so */
    struct facet_kernel_circles passing; /* of other groups in this step, circles for certain */
    struct facet_kernel_circles surveyed; /* entries of which one of a group may be */
    int n_corners, corner_capacity;
    struct facet_patch_corner *corners; /* of the batch's contacts with such bodies */
    struct facet_kernel_load *loads;    /* one a body */
    int n_summed;                       /* contacts in them, at most */
    struct facet_contact dummy;
    bool has_groups; /* and runs */
    int n_runs, run_capacity, n_plain, plain_capacity, faced_capacity;
    struct facet_kernel_run *runs;
    struct facet_contact **plain; /* contacts that may only touch one face */
    struct facet_contact **faced; /* those in runs, padded */
    int *faced_spheres;           /* theirs */
    int n_groups, group_capacity, near_capacity;
    struct facet_work_group *groups;
    int *near; /* of all groups, each at its entries' places */
    int is_near_capacity;
    bool *is_near;              /* of one group */
    struct facet_work_due *due; /* of all groups */
    bool *is_busy;              /* those to be looked at in every step */
    int n_busy, *busy;          /* these, ascending */
    bool busy_is_stale;         /* is_busy has changed, or what is near of them */
    double travelled;           /* by the fastest point of any body [m] */
};

/* What a step's contacts need. */
struct facet_work_step {
    struct facet_contacts *facets;
    struct spheres *spheres;
    const struct bodies *bodies;
    struct facet_kernel kernel;
    struct facet_kernel_work *kernel_work;
};

/* Of a sphere's contacts, over what the law takes them for. */
static inline double facet_work_width(const struct facet_contacts *facets, int sphere)
{
    return facets->width != NULL ? facets->width[sphere] : 1.0;
}

#endif
