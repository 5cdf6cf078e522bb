/*
 * Materials, and what the contact law needs of each pair of them.
 */
#ifndef TREMIE_MODEL_MATERIAL_H
#define TREMIE_MODEL_MATERIAL_H

struct job;

/*
 * The constants of Hertz-Mindlin contact for one pair of materials (equations in
 * src/THEORY.md). With contact radius a = sqrt(R* overlap):
 *   normal force      f_n = normal a overlap - c_n v_n,   normal = 4/3 E*           [Pa]
 *   tangential        k_t = tangential a,                 tangential = 8 G*         [Pa]
 *   normal dashpot    c_n = damping sqrt(a m*),           damping = 2 sqrt(5/6) beta sqrt(2 E*)
 *   tangential dashpot c_t = damping_ratio c_n,           damping_ratio = sqrt(8 G* / 2 E*)
 */
struct material_pair {
    double normal;        /* [Pa] */
    double tangential;    /* [Pa] */
    double damping;       /* [sqrt(Pa)] */
    double damping_ratio; /* [-] */
    double friction;      /* [-] */
};

struct materials {
    int n;
    double *density;             /* [kg/m3] */
    double *young;               /* [Pa] */
    double *poisson;             /* [-] */
    struct material_pair *pairs; /* n x n, symmetric; pair (a, b) at a * n + b */
};

void materials_build(struct materials *materials, const struct job *job);
void materials_clear(struct materials *materials);

#endif
