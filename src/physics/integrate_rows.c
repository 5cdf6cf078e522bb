/*
 * Integration, row by row: see integrate.h.  Compiled once for each instruction set
 * (base/isa.h), but with four lanes at most: half a row holds what moves together.
 *
 * What is spent of the allowances is gathered by component, whose norm bounds the largest |v| /
 * allowance and needs no square root a sphere.
 */
#if KERNEL_ISA >= 3
#define LANES_WIDTH 4
#else
#define LANES_WIDTH 2
#endif

#include "physics/integrate_rows.h"

#include "physics/integrate.h"
#include "physics/lanes_rows.h"

enum { WIDTH = LANES_WIDTH, HALF = 4, PARTS = HALF / WIDTH };

/* Half a row of which three lanes hold a vector and the fourth something that stays. */
struct half {
    lanes part[PARTS];
};

/* Of a vector and what goes with it. */
LANES_INLINE struct half half_of(const double vector[3], double fourth)
{
    const double all[HALF] = {vector[0], vector[1], vector[2], fourth};
    struct half half;
#pragma GCC unroll 2
    for (int p = 0; p < PARTS; p++)
        half.part[p] = lanes_load(all + WIDTH * p);
    return half;
}

/* x in the lanes of the vector, 0 in the fourth. */
LANES_INLINE lanes in_vector(double x, int part)
{
#if LANES_WIDTH == 4
    (void)part;
    return (lanes){x, x, x, 0.0};
#else
    return part == 0 ? lanes_all(x) : (lanes){x, 0.0};
#endif
}

/* The vector of the one with the fourth lane of the other. */
LANES_INLINE lanes with_fourth(lanes vector, lanes fourth, int part)
{
#if LANES_WIDTH == 4
    (void)part;
    return LANES_SHUFFLE(vector, fourth, 0, 1, 2, 7);
#else
    return part == 1 ? LANES_SHUFFLE(vector, fourth, 0, 3) : vector;
#endif
}

LANES_INLINE lanes larger(lanes a, lanes b)
{
    return lanes_where(a > b, a, b);
}

/* What does not change from sphere to sphere. */
struct move {
    struct half keep, fall, step, snap;
    double kick; /* [s] */
};

/* Running maxima of |v| / allowance by component, for both lists. */
struct spent {
    struct half most[2];
    lanes bad; /* stays 0.0 as long as everything is finite: 0 x is NaN otherwise */
};

/* What mass-proportional damping takes in a step: c (m v(n)^2 + 2/5 m R^2 w(n)^2) dt [J]. */
static double background_loss(const struct integrate_work *work, const double *motion,
                              const double *spin, const double *v_after, const double *w_after)
{
    double speed2 = 0.0, spin2 = 0.0;
    for (int k = 0; k < 3; k++) {
        const double v = 0.5 * (motion[4 + k] + v_after[k]),
                     w = 0.5 * (spin[4 + k] + w_after[k]);
        speed2 += v * v;
        spin2 += w * w;
    }
    const double radius = motion[3], inverse_mass = spin[7];
    return work->damping * work->dt / inverse_mass * (speed2 + 0.4 * radius * radius * spin2);
}

LANES_INLINE void move_sphere(const struct move *move, double *motion, double *spin,
                              double *force, const double inverse_allowance[2], bool periodic,
                              struct spent *spent)
{
    const double radius = motion[3], inverse_radius = spin[3], inverse_mass = spin[7];
    /* Inertia of a sphere 2/5 m R^2.  (5.2) */
    const double gain = move->kick * inverse_mass;
    const double turn = move->kick * 2.5 * inverse_mass * inverse_radius * inverse_radius;

#pragma GCC unroll 2
    for (int p = 0; p < PARTS; p++) {
        double *x_at = motion + WIDTH * p, *spin_at = spin + WIDTH * p;
        double *force_at = force + WIDTH * p;
        const lanes f = lanes_load(force_at), t = lanes_load(force_at + HALF);
        const lanes v = lanes_load(x_at + HALF) * move->keep.part[p] + f * in_vector(gain, p) +
                        move->fall.part[p];
        const lanes w =
            lanes_load(spin_at + HALF) * move->keep.part[p] + t * in_vector(turn, p);
        lanes d = v * move->step.part[p];
        if (periodic)
            d = (d + move->snap.part[p]) - move->snap.part[p]; /* (5.5) */
        const lanes x = lanes_load(x_at) + d;
        lanes_store(x_at, x);
        lanes_store(x_at + HALF, v);
        lanes_store(spin_at, with_fourth(w * lanes_all(radius), lanes_load(spin_at), p));
        lanes_store(spin_at + HALF, w);
        lanes_store(force_at, lanes_all(0.0));
        lanes_store(force_at + HALF, lanes_all(0.0));
        spent->bad += ((x + v) + w) * 0.0;
        const lanes speed = (lanes)((lanes_mask)v & INT64_MAX);
#pragma GCC unroll 2
        for (int s = 0; s < 2; s++)
            spent->most[s].part[p] =
                larger(speed * in_vector(inverse_allowance[s], p), spent->most[s].part[p]);
    }
}

/* The two factors of v(n+1/2) = keep v(n-1/2) + push a(n) dt under mass-proportional damping c:
 * (1 - c dt/2)/(1 + c dt/2) and 1/(1 + c dt/2); the same for w.  (5.3) */
LANES_INLINE void move_spheres(struct integrate_work *work, bool ledger, bool damped,
                               bool periodic)
{
    const struct integrate_work own = *work, *w = &own;
    const double half = 0.5 * w->damping * w->dt;
    const double push = 1.0 / (1.0 + half), keep = (1.0 - half) / (1.0 + half);
    const double kick = push * w->dt;
    const double falls[3] = {kick * w->gravity[0], kick * w->gravity[1], kick * w->gravity[2]};
    const struct move move = {.keep = half_of((const double[3]){keep, keep, keep}, 1.0),
                              .fall = half_of(falls, 0.0),
                              .step = half_of((const double[3]){w->dt, w->dt, w->dt}, 0.0),
                              .snap = half_of(w->snap, 0.0),
                              .kick = kick};
    struct spent spent = {{{{{0.0}}}}, {0.0}};

    for (int i = 0; i < w->n; i++) {
        double *motion = w->motion[i].lane, *spin = w->spin[i].lane;
        double *force = w->force[i].lane;
        const double friction = force[3], damping = force[7];
        struct sphere_row motion_before, spin_before;
        if (ledger && damped) {
            motion_before = w->motion[i];
            spin_before = w->spin[i];
        }
        move_sphere(&move, motion, spin, force, w->inverse_allowance[i], periodic, &spent);
        if (ledger) {
            w->dissipated_friction[i] += friction;
            w->dissipated_damping[i] += damping;
        }
        if (ledger && damped) {
            w->dissipated_damping[i] += background_loss(w, motion_before.lane, spin_before.lane,
                                                        motion + HALF, spin + HALF);
        }
    }
    for (int s = 0; s < 2; s++) {
        double most[HALF];
        for (int p = 0; p < PARTS; p++)
            lanes_store(most + WIDTH * p, spent.most[s].part[p]);
        work->spent[s] =
            sqrt(most[0] * most[0] + most[1] * most[1] + most[2] * most[2]) * w->dt;
    }
    work->bad = lanes_any(~(spent.bad == lanes_all(0.0)));
}

static void apply(struct integrate_work *work)
{
    const bool damped = work->damping > 0.0;
    if (work->periodic)
        move_spheres(work, work->ledger, damped, true);
    else if (work->ledger && damped)
        move_spheres(work, true, true, false);
    else if (work->ledger)
        move_spheres(work, true, false, false);
    else
        move_spheres(work, false, false, false);
}

struct integrate_kernel ISA_OFFER(integrate_rows)(void)
{
    return (struct integrate_kernel){apply};
}
