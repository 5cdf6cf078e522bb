/*
 * Materials, and what the contact law needs of each pair of them.
 */
#ifndef TREMIE_MODEL_MATERIAL_H
#define TREMIE_MODEL_MATERIAL_H

#include <stdbool.h>

struct job;
struct job_pair;

/*
 * The constants of contact for one pair of materials (equations in src/THEORY.md, section 1).
 * With the contact radius a = sqrt(R* overlap), or a = 1 with the linear law:
 *   normal force       f_n = normal a overlap - c_n v_n    normal = 4/3 E*        [Pa]
 *   tangential         k_t = tangential a,                 tangential = 8 G*      [Pa]
 *   normal dashpot     c_n = damping sqrt(a m*),   damping = 2 sqrt(5/6) beta sqrt(2 E*)
 *   tangential dashpot c_t = damping_ratio c_n,            damping_ratio = sqrt(8 G* / 2 E*)
 * and with the linear law normal = k_n, tangential = k_t [N/m], damping = 2 beta sqrt(k_n),
 * damping_ratio = sqrt(k_t / k_n).
 */
struct material_pair {      /* the first eight as a row: see physics/contact_law.h */
    double normal;          /* [Pa] or [N/m] */
    double tangential;      /* [Pa] or [N/m] */
    double damping;         /* [sqrt(Pa)] or [sqrt(N/m)] */
    double damping_ratio;   /* [-] */
    double friction;        /* of what slides [-] */
    double linear;          /* 1 with the linear law, else 0 */
    double static_friction; /* of what does not slide yet, >= friction [-] */
    double rolling;         /* rolling friction: torque over R* f_n [-] */
    double twisting;        /* twisting friction likewise [-] */
    double constant_torque; /* 1 where rolling friction has no spring, else 0 */
};

struct materials {
    int n;
    double *density;             /* [kg/m3] */
    double *young;               /* [Pa] */
    double *poisson;             /* [-] */
    struct material_pair *pairs; /* n x n, symmetric; pair (a, b) at a * n + b */
    bool full; /* some pair resists rolling or twisting or has static friction of its own */
};

/* The spring of a node of one body of these materials on a face of another, of a width of 1 m.
 * (12.19) */
struct material_pair material_touch(const struct job *job, const struct job_pair *asked);
void materials_build(struct materials *materials, const struct job *job);
void materials_clear(struct materials *materials);

#endif
