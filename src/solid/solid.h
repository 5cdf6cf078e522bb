/*
 * A deformable solid: nodes, elements between them, what holds and loads it; one time step
 * (THEORY.md, sections 12 and 13).  Its elements may be hexahedra and tetrahedra, and
 * quadrilaterals and triangles of shells and membranes, side by side on the same nodes.
 *
 * All of the solid is in memory; solid_assign() says which nodes this rank moves.  It then
 * computes every element that has one of them for a corner, and needs places and velocities of
 * all their nodes; others' nodes it never changes.  A node adds up its elements' forces in
 * ascending order of elements, so nothing depends on who moves what.  Elements are numbered
 * from 0 and keep their numbers when others die.
 *
 * A step, with dt the same throughout:
 *
 *     solid_forces()     stress at x(n), forces of elements and loads on nodes
 *     ...                contacts add what they do to nodes to `contact`
 *     solid_move()       velocities at n + 1/2, places at n + 1; clears `contact`
 *
 * What must be saved for the next solid_forces() stands in solid_node_fields[] and
 * solid_element_fields[]; the last of them only where nodes turn, and where there are shells or
 * membranes.  Nothing here is collective.
 */
#ifndef TREMIE_SOLID_SOLID_H
#define TREMIE_SOLID_SOLID_H

#include <stdbool.h>
#include <stdint.h>

#include "base/field.h"
#include "base/vec3.h"
#include "physics/shell_element.h"
#include "physics/solid_element.h"
#include "solid/solid_load.h"
#include "solid/solid_support.h"
#include "solid/solid_turn.h"

/* What a solid is made of, as people give it. */
struct solid_material {
    double density;             /* [kg/m3] */
    double young, poisson;      /* [Pa], [-] */
    double damping;             /* stiffness-proportional [s] */
    double hourglass_stiffness; /* share of the stiffness of a wave across a cube; of shells and
                                   membranes, of what full integration has [-] */
    double hourglass_viscosity; /* share of critical damping; not of shells and membranes [-] */
    int n_yield; /* points of the yield curve, the first at strain 0; 0: elastic */
    const struct solid_yield_point *yield;
    double hardening; /* slope behind the last point [Pa] */
};

struct solid_yield_point {
    double strain; /* plastic [-] */
    double stress; /* [Pa] */
};

/* What a solid is built from; copied. */
struct solid_parts {
    int n_nodes;
    double (*places)[3]; /* [m] */
    int n_elements;
    const enum solid_element_shape *shapes;
    int (*corners)[SOLID_ELEMENT_CORNERS]; /* positive volumes: physics/solid_gradient.h */
    const int *materials;                  /* of each element; NULL: all 0 */
    /* Of shells and membranes: */
    const double *thickness; /* of each element [m]; NULL: there are none */
    int layers;              /* points through the thickness of shells, 1 to 5 */
};

/* What works on nodes, and so on the solid. */
enum solid_work {
    SOLID_WORK_INTERNAL, /* taken up by elements */
    SOLID_WORK_LOADS,
    SOLID_WORK_CONTACT,
    SOLID_WORK_GRAVITY,
    SOLID_WORK_SUPPORTS,
    SOLID_WORK_DAMPING, /* taken by mass-proportional damping */
    SOLID_N_WORKS
};

/* Elements of one shape and material, of one part of the solid, that are computed here. */
struct solid_list {
    int part; /* elements part * SOLID_PART to (part + 1) * SOLID_PART - 1 */
    enum solid_element_shape shape;
    int material;
    int first, n; /* in `listed`; padded */
};

/* Elements whose forces are held before they are added to nodes: as many as stay in the
 * cache. */
enum { SOLID_PART = 512 };

struct solid {
    int n_nodes;
    double (*reference)[3];          /* place at the start [m] */
    struct solid_element_node *node; /* and corners of the element that pads */
    double *mass;                    /* [kg] */
    double (*internal)[3];           /* force of the elements at step n [N] */
    double (*external)[3];           /* of loads, without gravity [N] */
    double (*contact)[3];            /* from outside; solid_move() clears it [N] */
    double (*work)[SOLID_N_WORKS];   /* up to the middle of the last move [J] */
    bool *moves;                     /* by this rank */

    int n_elements;
    enum solid_element_shape *shape;
    int (*corners)[SOLID_ELEMENT_CORNERS]; /* and those of the element that pads */
    int *material;
    int32_t *alive;
    double *element_mass; /* [kg] */
    struct solid_element_state *state;
    int layers;                        /* of shells */
    struct shell_element_state *shell; /* of each element; NULL: neither shells nor membranes */
    int *first; /* of each node: where its corners begin in `meets`; n_nodes + 1 */
    int *meets; /* element * SOLID_ELEMENT_CORNERS + corner, ascending */

    int n_materials;
    struct solid_element_material *materials;
    struct solid_supports supports;
    struct solid_loads loads;
    struct solid_turns turns; /* of nodes of shells */
    double gravity[3];        /* now [m/s2] */
    double damping;           /* mass-proportional [1/s] */

    struct solid_element_kernel kernel;
    int n_lists, lists_capacity; /* in ascending order of parts */
    struct solid_list *lists;
    int n_listed, listed_capacity;
    int *listed; /* elements, list after list */
    int n_here, here_capacity;
    int *here;                         /* nodes of these, ascending, and others moved here */
    int *slot;                         /* of each element in `force`; -1: not computed here */
    struct solid_element_force *force; /* of one part */
    int force_capacity;
};

enum solid_node_field {
    SOLID_NODE_POSITION,
    SOLID_NODE_VELOCITY,
    SOLID_NODE_WORK,
    SOLID_NODE_N_PLAIN,
    SOLID_NODE_SPIN = SOLID_NODE_N_PLAIN, /* where nodes turn */
    SOLID_NODE_N_FIELDS
};

enum solid_element_field {
    SOLID_ELEMENT_STRESS,
    SOLID_ELEMENT_PLASTIC_STRAIN,
    SOLID_ELEMENT_PLASTIC_WORK,
    SOLID_ELEMENT_HOURGLASS,
    SOLID_ELEMENT_HOURGLASS_WORK,
    SOLID_ELEMENT_HOURGLASS_DAMPED,
    SOLID_ELEMENT_DAMPED,
    SOLID_ELEMENT_ALIVE,
    SOLID_ELEMENT_N_PLAIN,
    SOLID_ELEMENT_LAYERS = SOLID_ELEMENT_N_PLAIN, /* these where there are sheets */
    SOLID_ELEMENT_SHEAR,
    SOLID_ELEMENT_THICKNESS,
    SOLID_ELEMENT_N_FIELDS
};

extern const struct field solid_node_fields[SOLID_NODE_N_FIELDS];
extern const struct field solid_element_fields[SOLID_ELEMENT_N_FIELDS];

/* At rest and without stress at the mesh's places, all of it moved here. */
void solid_create(struct solid *solid, const struct solid_parts *mesh, int n_materials,
                  const struct solid_material *materials, enum isa isa);
void solid_destroy(struct solid *solid);

/* Where a field of the tables lies: node or element 0 first; nowhere where there is none. */
struct field_view solid_node_view(const struct solid *solid, enum solid_node_field field);
struct field_view solid_element_view(const struct solid *solid, enum solid_element_field field);

/* Chooses the nodes that this rank moves (NULL: all) and lists the living elements that are
 * computed for them.  Due again after solid_kill() and after `alive` was read from a file. */
void solid_assign(struct solid *solid, const bool *moves);
/* Gives back the memory of all that is neither moved nor computed here, nor among the nodes to
 * keep, and forgets its state. */
void solid_forget(struct solid *solid, const bool *keep);
/* The element resists nothing from now on; its mass stays with its nodes. */
void solid_kill(struct solid *solid, int element);
/* Puts a mass on a node, and inertia against turning, which counts where it turns [kg],
 * [kg m2]. */
void solid_add_mass(struct solid *solid, int node, double mass, double inertia);
/* Is this rank the one that counts the element?  The one that moves its first corner. */
bool solid_counts(const struct solid *solid, int element);

/* Stress at x(n) from the motion since x(n-1); at step 0 that is none.  Once a step, and not
 * twice.  False: some element failed, solid_find_fault() knows which. */
bool solid_forces(struct solid *solid, int64_t step, double dt);
/* From x(n), v(n-1/2) to x(n+1), v(n+1/2), and the work that was done. */
void solid_move(struct solid *solid, int64_t step, double dt);
/* The same, but contacts push on: `contact` stays. */
void solid_move_on(struct solid *solid, int64_t step, double dt);

/* What is the same for all nodes in a step: factors of (5.3). */
struct solid_pace {
    double dt, keep, kick;
    double earlier; /* share of the velocity before in the one that work is done at */
};

static inline struct solid_pace solid_pace_of(const struct solid *solid, double dt)
{
    const double half = 0.5 * solid->damping * dt, push = 1.0 / (1.0 + half);
    return (struct solid_pace){dt, (1.0 - half) * push, push * dt, 0.5};
}

/* Node i as solid_move() is about to move it. */
struct solid_advance {
    double velocity[3]; /* at n + 1/2 [m/s] */
    double place[3];    /* at n + 1 [m] */
    double support[3];  /* force of what holds it [N] */
};
/* `supports` for the step: solid_supports_set(). */
struct solid_advance solid_advance(const struct solid *solid, int i, double dt);
/* Velocity at the step, between those of the half steps [m/s]. */
void solid_velocity_now(const struct solid *solid, int i, double dt, double v[3]);
/* Power of what works on a node that moves at v, of each enum solid_work [W]. */
void solid_power(const struct solid *solid, int i, const struct solid_advance *advance,
                 const double v[3], double power[SOLID_N_WORKS]);

static inline double *solid_place(const struct solid *solid, int i)
{
    return solid->node[i].lane;
}
static inline double *solid_velocity(const struct solid *solid, int i)
{
    return solid->node[i].lane + 4;
}
/* Von Mises's equivalent stress; of shells the most of all layers [Pa]. */
double solid_mises(const struct solid *solid, int element);
/* Places of an element's corners [m]; returns how many. */
int solid_corner_places(const struct solid *solid, int element,
                        double x[SOLID_ELEMENT_CORNERS][3]);

#endif
