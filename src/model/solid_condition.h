/*
 * What is prescribed on a set of a body that deforms, as a function of time: nodes that stay,
 * go a way or with a velocity, move as a rigid body would, a force on nodes, a pressure on
 * sides.  Nothing is accumulated: a restart finds the same bits.  Local, all of it.
 */
#ifndef TREMIE_MODEL_SOLID_CONDITION_H
#define TREMIE_MODEL_SOLID_CONDITION_H

struct job_boundary;
struct job_motion;
struct job_value;
struct solid_mesh;
struct solid_mesh_set;

enum solid_condition_kind {
    SOLID_CONDITION_FIXED,
    SOLID_CONDITION_MOTION,
    SOLID_CONDITION_DISPLACEMENT,
    SOLID_CONDITION_VELOCITY,
    SOLID_CONDITION_FORCE,
    SOLID_CONDITION_PRESSURE
};

struct solid_condition {
    enum solid_condition_kind kind;
    const struct solid_mesh_set *set;
    int directions; /* a set of enum job_direction; none of a pressure and a motion */
    int turns;      /* axes about which what is fixed does not turn, likewise */
    int n_motions;  /* of the job */
    const struct job_motion *motions;
    /* The value where there are no rows: displacement [m], velocity [m/s], force on all of the
     * set's nodes together [N], pressure against the surface [Pa]; 0 of what is fixed. */
    double constant;
    int n;                        /* rows of a table */
    const struct job_value *rows; /* of the job */
};

/* The item as it acts on a mesh, which has the set; both are to outlive it. */
struct solid_condition solid_condition_of(const struct job_boundary *asked,
                                          const struct solid_mesh *mesh);

#endif
