/*
 * One-point elements of deformable solids: hexahedra with mean gradients and hourglass control
 * (Flanagan and Belytschko), tetrahedra of constant strain (THEORY.md, section 12).
 *
 * An element is evaluated once a step, with its nodes at x(n) and their velocities those of
 * n - 1/2.  From the geometry half way back and the motion of the step come strain and turn;
 * stress and hourglass forces turn along and take up what the law says; the forces on the
 * corners come from the geometry at x(n).
 *
 * State lies in rows of 64 bytes, as nodes do: kernels load whole rows of as many elements as a
 * vector has lanes and transpose them, so it does not matter which elements stand side by side,
 * and a list of any elements costs the same as all of them.
 */
#ifndef TREMIE_PHYSICS_SOLID_ELEMENT_H
#define TREMIE_PHYSICS_SOLID_ELEMENT_H

#include <stdbool.h>

#include "base/isa.h"

enum {
    SOLID_ELEMENT_CORNERS = 8, /* room for; a tetrahedron has four */
    SOLID_ELEMENT_PAD = 8,     /* lists are multiples of */
};

enum solid_element_shape {
    SOLID_ELEMENT_HEXAHEDRON,
    SOLID_ELEMENT_TETRAHEDRON,
    SOLID_ELEMENT_SHELL_QUAD, /* these four: physics/shell_element.h */
    SOLID_ELEMENT_SHELL_TRIANGLE,
    SOLID_ELEMENT_MEMBRANE_QUAD,
    SOLID_ELEMENT_MEMBRANE_TRIANGLE,
    SOLID_ELEMENT_N_SHAPES
};

/* A node: {x y z - | vx vy vz -}, place at step n, velocity at n - 1/2. */
struct solid_element_node {
    double lane[8];
} __attribute__((aligned(64)));

/* What an element remembers. */
struct solid_element_state {
    double stress[6];      /* Cauchy's: xx yy zz xy yz zx [Pa] */
    double plastic_strain; /* equivalent [-] */
    double plastic_work;   /* turned into heat by plastic flow [J] */
    double hourglass[4][3];
    double hourglass_work;   /* taken up by hourglass stiffness [J] */
    double hourglass_damped; /* turned into heat by hourglass viscosity [J] */
    double damped;           /* by stiffness-proportional damping [J] */
    double volume;           /* at step n [m3] */
} __attribute__((aligned(64)));

/* Forces of an element on its corners' nodes that resist deformation, opposite to what nodes
 * feel: {fx fy fz 0} of each corner [N]; of a shell's corner c that at 2 c and its moment
 * {mx my mz 0} behind it [N m]. */
struct solid_element_force {
    double corner[SOLID_ELEMENT_CORNERS][4];
} __attribute__((aligned(64)));

struct shell_element_state;

/* A piece of the yield curve, from its first point on. */
struct solid_element_yield {
    double strain;  /* plastic [-] */
    double stress;  /* [Pa] */
    double slope;   /* [Pa] */
    double inverse; /* 1 / (3 mu + slope) [1/Pa] */
};

struct solid_element_material {
    double density;                    /* [kg/m3] */
    double lambda, mu;                 /* Lame's [Pa] */
    double damping;                    /* stiffness-proportional [s] */
    double hourglass_stiffness;        /* 1: as fast as the fastest wave across a cube [-] */
    double hourglass_viscosity;        /* 1: critical for such an oscillation [-] */
    int n_yield;                       /* pieces; 0: never yields */
    struct solid_element_yield *yield; /* the first from strain 0 on */
};

/*
 * n elements of one shape and material, n a multiple of SOLID_ELEMENT_PAD; padding names an
 * element that exists for that alone.  No element twice, but for that one.
 *
 * Read: nodes, corners, mass.  Brought to the present: state.  Written: forces, in the order of
 * the list, of the corners that the shape has.
 */
struct solid_element_work {
    int n;
    const int *elements;
    const struct solid_element_node *nodes;
    int (*corners)[SOLID_ELEMENT_CORNERS];
    const double *mass; /* of each element [kg] */
    struct solid_element_state *state;
    struct solid_element_force *force; /* n */
    const struct solid_element_material *material;
    /* Of shells and membranes besides: */
    const struct solid_element_node *spins; /* {wx wy wz -} at n - 1/2; shells only */
    struct shell_element_state *shells;     /* of each element */
    int layers;                             /* of shells */
    double dt;                              /* [s] */
    double since; /* dt, or 0 where stress is already that of x(n): at the start [s] */
    bool failed;  /* out: a volume that is not positive, or a number that is none */
};

struct solid_element_kernel {
    void (*apply[SOLID_ELEMENT_N_SHAPES])(struct solid_element_work *work);
};

/* The kernel for an instruction set, which must run; all give the same bits. */
struct solid_element_kernel solid_element_choose(enum isa isa);

/* Lame's constants.  (12.7) */
void solid_element_elastic(struct solid_element_material *material, double young,
                           double poisson);

/* Energy that stress holds in the element [J].  (12.9) */
double solid_element_energy(const struct solid_element_state *state,
                            const struct solid_element_material *material);
/* Von Mises's equivalent stress [Pa]. */
double solid_element_mises(const struct solid_element_state *state);

/* Yield stress at a plastic strain [Pa]. */
double solid_element_yield_stress(const struct solid_element_material *material, double strain);

/* How many corners it has. */
int solid_element_corners(enum solid_element_shape shape);
/* Volume of an element whose corners are at x [m3]. */
double solid_element_volume(enum solid_element_shape shape, double x[][3]);

/* What an element allows of the step. */
struct solid_element_load {
    double stretch;          /* of the modes of mean strain: largest frequency squared [1/s2] */
    double damping;          /* stiffness-proportional [s] */
    double hourglass;        /* of hourglass modes [1/s2] */
    double hourglass_damped; /* their damping over mass [1/s] */
    double mixed;            /* what couples the two kinds [1/s2] */
};
/* Bounds, by (12.11) to (12.13), for corners of a quarter or an eighth of the mass. */
struct solid_element_load solid_element_load(enum solid_element_shape shape, double x[][3],
                                             double mass,
                                             const struct solid_element_material *material);
/* The step that is stable while contacts put springs of this stiffness over mass [1/s2], and
 * dashpots of this damping over mass [1/s], on the element's nodes besides [s]. */
double solid_element_critical_step(const struct solid_element_load *load, double contact,
                                   double contact_damping);

#endif
