/*
 * Elements, as many side by side as a vector has lanes: see solid_element.h.  Compiled once for
 * each instruction set (base/isa.h).
 *
 * Hourglass control costs little here.  With the gradient L of the motion, what an hourglass
 * mode moves is the pattern of the motion less L times the pattern of the places; and its
 * forces are the pattern's own spread over the corners less what acts as a stress.  So the
 * patterns orthogonal to uniform strain are never formed.
 */
#include "physics/solid_element_blocks.h"

#include <stddef.h>

#include "physics/lanes_rows.h"
#include "physics/solid_element_rows.h"
#include "physics/solid_gradient.h"
#include "physics/solid_law.h"

enum { WIDTH = LANES_WIDTH, ROW = 8, MODES = 4 };

/* Gradient of the motion.  (12.3) */
LANES_INLINE void motion_gradient(int n_corners, lanes moved[][3], lanes b[][3], lanes volume,
                                  lanes gradient[3][3])
{
    const lanes per_volume = lanes_all(1.0) / volume;
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++)
#pragma GCC unroll 3
        for (int j = 0; j < 3; j++) {
            lanes sum = moved[0][i] * b[0][j];
#pragma GCC unroll 8
            for (int c = 1; c < n_corners; c++)
                sum += moved[c][i] * b[c][j];
            gradient[i][j] = sum * per_volume;
        }
}

/* Writes S b of each corner, and what is given besides, for pairs of corners.  (12.4) */
LANES_INLINE lanes give_forces(struct solid_element_force *force_at, int n_corners,
                               lanes stress[3][3], lanes b[][3], lanes besides[][3])
{
    lanes odd = lanes_all(0.0);
#pragma GCC unroll 4
    for (int c = 0; c < n_corners; c += 2) {
        double *at[WIDTH];
        lanes row[ROW];
#pragma GCC unroll 2
        for (int k = 0; k < 2; k++) {
#pragma GCC unroll 3
            for (int i = 0; i < 3; i++) {
                const lanes force = solid_gradient_dot(stress[i], b[c + k]);
                row[4 * k + i] = besides != NULL ? force + besides[c + k][i] : force;
                odd += row[4 * k + i] * lanes_all(0.0);
            }
            row[4 * k + 3] = lanes_all(0.0);
        }
#pragma GCC unroll 8
        for (int l = 0; l < WIDTH; l++)
            at[l] = force_at[l].corner[c];
        lanes_give_rows(at, row);
    }
    return odd;
}

/* Components of a field's patterns, of each direction. */
LANES_INLINE void patterns_of(lanes field[8][3], lanes pattern[3][MODES])
{
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        lanes f[8];
#pragma GCC unroll 8
        for (int c = 0; c < 8; c++)
            f[c] = field[c][i];
        solid_gradient_patterns(f, pattern[i]);
    }
}

LANES_INLINE lanes square_of(lanes b[8][3])
{
    lanes sum = lanes_all(0.0);
#pragma GCC unroll 8
    for (int c = 0; c < 8; c++)
        sum += solid_gradient_dot(b[c], b[c]);
    return sum;
}

/* What hourglass control needs of the geometry: motion of the modes, their stiffness and
 * dashpot.  (12.6) */
struct hourglass {
    lanes moved[3][MODES];
    lanes stiffness, dashpot;
};

LANES_INLINE void hourglass_motion(const struct solid_element_work *work, const int *elements,
                                   lanes middle[8][3], lanes moved[8][3], lanes b[8][3],
                                   lanes volume, lanes gradient[3][3],
                                   struct hourglass *hourglass)
{
    const struct solid_element_material *m = work->material;
    lanes places[3][MODES];
    patterns_of(middle, places);
    patterns_of(moved, hourglass->moved);
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++)
#pragma GCC unroll 4
        for (int a = 0; a < MODES; a++)
            hourglass->moved[i][a] -=
                (gradient[i][0] * places[0][a] + gradient[i][1] * places[1][a]) +
                gradient[i][2] * places[2][a];
    double mass[WIDTH];
#pragma GCC unroll 8
    for (int l = 0; l < WIDTH; l++)
        mass[l] = work->mass[elements[l]];
    const lanes whole = lanes_all((m->lambda + 2.0 * m->mu) / 24.0) * square_of(b) / volume;
    hourglass->stiffness = whole * lanes_all(m->hourglass_stiffness);
    hourglass->dashpot = lanes_sqrt(whole * lanes_load(mass)) *
                         lanes_all(0.25 * m->hourglass_viscosity / work->dt);
}

/* Forces of the modes: those remembered, turned, and more; in `acting` with the dashpots'.
 * (12.6) */
LANES_INLINE void hourglass_resist(const struct hourglass *hourglass, lanes turn[3][3],
                                   lanes first[ROW], lanes second[ROW], lanes acting[3][MODES])
{
    lanes work = lanes_all(0.0), heat = lanes_all(0.0);
#pragma GCC unroll 4
    for (int a = 0; a < MODES; a++) {
        lanes old[3];
#pragma GCC unroll 3
        for (int i = 0; i < 3; i++) {
            const int k = 3 * a + i;
            old[i] = k < ROW ? first[k] : second[k - ROW];
        }
#pragma GCC unroll 3
        for (int i = 0; i < 3; i++) {
            const int k = 3 * a + i;
            const lanes moved = hourglass->moved[i][a];
            const lanes turned = solid_gradient_dot(turn[i], old);
            const lanes now = turned + hourglass->stiffness * moved;
            const lanes dashpot = hourglass->dashpot * moved;
            work += (turned + now) * moved;
            heat += dashpot * moved;
            acting[i][a] = now + dashpot;
            if (k < ROW)
                first[k] = now;
            else
                second[k - ROW] = now;
        }
    }
    second[4] += work * lanes_all(0.5);
    second[5] += heat;
}

/* The modes' forces: on the corners, and as a stress.  (12.6) */
LANES_INLINE void hourglass_forces(lanes acting[3][MODES], lanes x[8][3], lanes volume,
                                   lanes stress[3][3], lanes besides[8][3])
{
    const lanes per_volume = lanes_all(1.0) / volume;
    lanes places[3][MODES];
    patterns_of(x, places);
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        lanes f[8];
        solid_gradient_spread(acting[i], f);
#pragma GCC unroll 8
        for (int c = 0; c < 8; c++)
            besides[c][i] = f[c];
#pragma GCC unroll 3
        for (int j = 0; j < 3; j++)
            stress[i][j] -= ((acting[i][0] * places[j][0] + acting[i][1] * places[j][1]) +
                             (acting[i][2] * places[j][2] + acting[i][3] * places[j][3])) *
                            per_volume;
    }
}

/* Turns not 0 where something failed. */
LANES_INLINE lanes_mask not_sound(lanes volume, lanes middle_volume, lanes odd)
{
    const lanes zero = lanes_all(0.0);
    return ~((volume > zero) & (middle_volume > zero) & (odd == zero));
}

LANES_INLINE lanes_mask hexahedra(const struct solid_element_work *work, const int *elements,
                                  struct solid_element_force *force_at, bool plastic)
{
    lanes x[8][3], moved[8][3], middle[8][3], b[8][3], besides[8][3];
    lanes gradient[3][3], turn[3][3], acting[3][MODES], stress[3][3];
    lanes own[ROW], first[ROW], second[ROW];
    struct hourglass hourglass;

    solid_element_take_corners(work, elements, 8, x, moved);
    solid_element_midway(8, x, moved, middle);
    const lanes middle_volume = solid_gradient_hexahedron(middle, b);
    motion_gradient(8, moved, b, middle_volume, gradient);
    hourglass_motion(work, elements, middle, moved, b, middle_volume, gradient, &hourglass);
    solid_element_take_state(work, elements, 0, own);
    solid_element_take_state(work, elements, 1, first);
    solid_element_take_state(work, elements, 2, second);
    solid_law_turn(gradient, turn);
    second[6] += solid_law_stress(work->material, work->dt, gradient, turn, middle_volume,
                                  plastic, own, stress);
    hourglass_resist(&hourglass, turn, first, second, acting);
    const lanes volume = solid_gradient_hexahedron(x, b);
    second[7] = volume;
    solid_element_give_state(work, elements, 0, own);
    solid_element_give_state(work, elements, 1, first);
    solid_element_give_state(work, elements, 2, second);
    hourglass_forces(acting, x, volume, stress, besides);
    const lanes odd = give_forces(force_at, 8, stress, b, besides);
    return not_sound(volume, middle_volume, odd);
}

LANES_INLINE lanes_mask tetrahedra(const struct solid_element_work *work, const int *elements,
                                   struct solid_element_force *force_at, bool plastic)
{
    lanes x[4][3], moved[4][3], middle[4][3], b[4][3];
    lanes gradient[3][3], turn[3][3], stress[3][3];
    lanes own[ROW], second[ROW];

    solid_element_take_corners(work, elements, 4, x, moved);
    solid_element_midway(4, x, moved, middle);
    const lanes middle_volume = solid_gradient_tetrahedron(middle, b);
    motion_gradient(4, moved, b, middle_volume, gradient);
    solid_element_take_state(work, elements, 0, own);
    solid_element_take_state(work, elements, 2, second);
    solid_law_turn(gradient, turn);
    second[6] += solid_law_stress(work->material, work->dt, gradient, turn, middle_volume,
                                  plastic, own, stress);
    const lanes volume = solid_gradient_tetrahedron(x, b);
    second[7] = volume;
    solid_element_give_state(work, elements, 0, own);
    solid_element_give_state(work, elements, 2, second);
    const lanes odd = give_forces(force_at, 4, stress, b, NULL);
    return not_sound(volume, middle_volume, odd);
}

LANES_INLINE void all_blocks(struct solid_element_work *work, enum solid_element_shape shape,
                             bool plastic)
{
    const struct solid_element_work own = *work, *w = &own;
    lanes_mask failed = {0};
    for (int k = 0; k < w->n; k += WIDTH)
        failed |= shape == SOLID_ELEMENT_HEXAHEDRON
                      ? hexahedra(w, w->elements + k, w->force + k, plastic)
                      : tetrahedra(w, w->elements + k, w->force + k, plastic);
    work->failed = lanes_any(failed);
}

static void apply_hexahedra(struct solid_element_work *work)
{
    if (work->material->n_yield > 0)
        all_blocks(work, SOLID_ELEMENT_HEXAHEDRON, true);
    else
        all_blocks(work, SOLID_ELEMENT_HEXAHEDRON, false);
}

static void apply_tetrahedra(struct solid_element_work *work)
{
    if (work->material->n_yield > 0)
        all_blocks(work, SOLID_ELEMENT_TETRAHEDRON, true);
    else
        all_blocks(work, SOLID_ELEMENT_TETRAHEDRON, false);
}

struct solid_element_kernel ISA_OFFER(solid_element_blocks)(void)
{
    return (struct solid_element_kernel){{[SOLID_ELEMENT_HEXAHEDRON] = apply_hexahedra,
                                          [SOLID_ELEMENT_TETRAHEDRON] = apply_tetrahedra}};
}
