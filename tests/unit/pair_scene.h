/*
 * Random pairs of spheres for tests of the pair kernel: touching and not, at first touch and
 * long since, sticking and sliding, of several materials and sizes.
 */
#ifndef TREMIE_TESTS_PAIR_SCENE_H
#define TREMIE_TESTS_PAIR_SCENE_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "contact/pair_kernel.h"
#include "model/restitution.h"

enum { SCENE_SPHERES = 120, SCENE_OWNED = 90, SCENE_MATERIALS = 3, SCENE_PAIRS = 4096 };

/* All that a kernel reads and writes. */
struct scene {
    int n, n_padded; /* pairs */
    int first[SCENE_PAIRS + PAIR_KERNEL_AHEAD], second[SCENE_PAIRS + PAIR_KERNEL_AHEAD];
    double history[CONTACT_LANES][SCENE_PAIRS];
    struct sphere_row motion[SCENE_SPHERES + 2], spin[SCENE_SPHERES + 2];
    struct sphere_row force[SCENE_SPHERES + 2];
    int32_t material[SCENE_SPHERES + 2];
    struct exact_sum wound;
    struct material_pair pairs[SCENE_MATERIALS * SCENE_MATERIALS];
    double dt, overlap_max;
    uint64_t random;
};

/* Evenly between the two. */
static inline double scene_random(struct scene *scene, double least, double most)
{
    scene->random = scene->random * 6364136223846793005u + 1442695040888963407u;
    return least + (most - least) * (double)(scene->random >> 11) * 0x1p-53;
}

static inline void scene_fill_row(struct scene *scene, int i)
{
    const double r = scene_random(scene, 0.6e-3, 1.2e-3);
    const double mass = 2500.0 * 4.18879020478639 * r * r * r;
    double *a = scene->motion[i].lane, *b = scene->spin[i].lane;

    a[3] = a[7] = r;
    b[3] = 1.0 / r;
    b[7] = 1.0 / mass;
    for (int x = 0; x < 3; x++) {
        a[x] = scene_random(scene, 0.0, 7.5e-3);
        a[4 + x] = scene_random(scene, -0.5, 0.5);
        b[4 + x] = scene_random(scene, -300.0, 300.0);
        b[x] = r * b[4 + x];
    }
    scene->material[i] = i % SCENE_MATERIALS;
}

static inline void scene_fill_pairs(struct scene *scene)
{
    for (int i = 0; i < SCENE_SPHERES; i++)
        for (int j = i + 1; j < SCENE_SPHERES; j++) {
            const double *a = scene->motion[i].lane, *b = scene->motion[j].lane;
            const double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
            const double distance = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            if (distance < 1.3 * (a[3] + b[3]) && distance > 0.8 * (a[3] + b[3])) {
                scene->first[scene->n] = i;
                scene->second[scene->n++] = j;
            }
        }
    scene->n_padded = (scene->n + CONTACT_PAD - 1) / CONTACT_PAD * CONTACT_PAD;
    for (int k = scene->n; k < scene->n_padded + PAIR_KERNEL_AHEAD; k++) {
        scene->first[k] = SCENE_SPHERES;
        scene->second[k] = SCENE_SPHERES + 1;
    }
}

/* Pairs of three materials: one linear, one whose rolling friction has no spring. */
static inline struct material_pair scene_pair(int a, int b)
{
    struct material_pair pair = {
        .normal = 1e7 * (1 + a + b),
        .tangential = 0.9e7 * (1 + a + b),
        .damping = restitution_damping(0.9 - 0.2 * (a + b)) * 8e3,
        .damping_ratio = 1.1,
        .friction = 0.1 + 0.3 * a * b,
        .static_friction = 0.15 + 0.4 * a * b,
        .rolling = 0.05 * (a + b),
        .twisting = 0.03 * (a + b),
        .constant_torque = a + b == 3 ? 1.0 : 0.0,
    };
    if (a + b == 2) {
        pair.linear = 1.0;
        pair.normal = 4e3;
        pair.tangential = 3e3;
        pair.damping = restitution_damping(0.5) * 2.0 * sqrt(4e3);
    }
    return pair;
}

static inline void scene_fill(struct scene *scene, uint64_t seed)
{
    memset(scene, 0, sizeof *scene);
    scene->random = seed;
    scene->dt = 2e-5;
    for (int a = 0; a < SCENE_MATERIALS; a++)
        for (int b = 0; b < SCENE_MATERIALS; b++)
            scene->pairs[a * SCENE_MATERIALS + b] = scene_pair(a, b);
    for (int i = 0; i < SCENE_SPHERES + 2; i++)
        scene_fill_row(scene, i);
    scene->motion[SCENE_SPHERES].lane[0] = 1e3;
    scene->motion[SCENE_SPHERES + 1].lane[0] = 2e3;
    scene_fill_pairs(scene);
}

static inline struct pair_kernel_work scene_work(struct scene *scene)
{
    struct pair_kernel_work work = {
        .n_padded = scene->n_padded,
        .first = scene->first,
        .second = scene->second,
        .motion = scene->motion,
        .spin = scene->spin,
        .force = scene->force,
        .material = scene->material,
        .n_materials = SCENE_MATERIALS,
        .pairs = scene->pairs,
        .n_owned = SCENE_OWNED,
        .wound = &scene->wound,
        .dt = scene->dt,
    };
    for (int lane = 0; lane < CONTACT_LANES; lane++)
        work.history[lane] = scene->history[lane];
    return work;
}

static inline void scene_apply(struct scene *scene,
                               void (*kernel)(struct pair_kernel_work *work))
{
    struct pair_kernel_work work = scene_work(scene);
    kernel(&work);
    scene->overlap_max = work.overlap_max;
}

/* A step in time, forces cleared; spheres of every fifth id pretend to be ghosts that follow
 * something else. */
static inline void scene_move(struct scene *scene)
{
    for (int i = 0; i < SCENE_SPHERES; i++) {
        double *a = scene->motion[i].lane, *b = scene->spin[i].lane, *f = scene->force[i].lane;
        for (int x = 0; x < 3; x++) {
            if (i % 5 != 0) {
                a[4 + x] += scene->dt * b[7] * f[x];
                b[4 + x] += scene->dt * b[7] * 2.5 * b[3] * b[3] * f[4 + x];
            }
            a[x] += scene->dt * a[4 + x];
            b[x] = a[3] * b[4 + x];
        }
        memset(f, 0, sizeof scene->force[i]);
    }
}

/* Where the first bit differs in what kernels write; NULL when nothing differs. */
static inline const char *scene_difference(const struct scene *a, const struct scene *b)
{
    if (memcmp(a->force, b->force, sizeof a->force) != 0)
        return "force";
    if (memcmp(a->history, b->history, sizeof a->history) != 0)
        return "history";
    struct exact_sum wound[2] = {a->wound, b->wound};
    exact_sum_normalise(&wound[0]);
    exact_sum_normalise(&wound[1]);
    if (memcmp(wound[0].limb, wound[1].limb, sizeof wound[0].limb) != 0)
        return "wound";
    return memcmp(&a->overlap_max, &b->overlap_max, sizeof a->overlap_max) != 0 ? "overlap_max"
                                                                                : NULL;
}

#endif
