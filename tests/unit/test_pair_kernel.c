/*
 * The pair kernel: every instruction set that runs here gives the bits of a plain loop over
 * single contacts, and leaves exact zeros where nothing touches.
 */
#include "check.h"

#include <stdlib.h>

#include "pair_scene.h"
#include "physics/contact_law.h"

enum { STEPS = 40 };

/* The arithmetic of one pair, written out. */
static struct contact_law_meeting meeting_of(const double *a, const double *b,
                                             const double *spin_a, const double *spin_b)
{
    const double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const double distance = sqrt(contact_law_dot(d, d)), inverse = 1.0 / distance;
    const double overlap = (b[3] + a[3]) - distance;
    struct contact_law_meeting meeting = {
        .normal = {d[0] * inverse, d[1] * inverse, d[2] * inverse},
        .overlap = overlap > 0.0 ? overlap : 0.0,
        .inverse_radius = spin_b[3] + spin_a[3],
        .width = 1.0,
        .inverse_mass = spin_b[7] + spin_a[7],
    };
    const double *n = meeting.normal, half = 0.5 * meeting.overlap;
    double s[3];
    for (int x = 0; x < 3; x++)
        s[x] = (spin_b[x] + spin_a[x]) - half * (spin_b[4 + x] + spin_a[4 + x]);
    for (int x = 0; x < 3; x++) {
        const int y = (x + 1) % 3, z = (x + 2) % 3;
        meeting.velocity[x] = (b[4 + x] - a[4 + x]) - (s[y] * n[z] - s[z] * n[y]);
        meeting.spin[x] = spin_b[4 + x] - spin_a[4 + x];
    }
    return meeting;
}

static void apply_one(struct pair_kernel_work *work, int k, const struct material_pair *pair,
                      struct contact_law_choice choice)
{
    const int i = work->first[k], j = work->second[k];
    const double *a = work->motion[i].lane, *b = work->motion[j].lane;
    const struct contact_law_meeting meeting =
        meeting_of(a, b, work->spin[i].lane, work->spin[j].lane);
    const double *n = meeting.normal, relative = meeting.overlap * meeting.inverse_radius;
    const double half = 0.5 * meeting.overlap, sum = b[3] + a[3], difference = b[7] - a[7];
    double *f = work->force[i].lane, *g = work->force[j].lane, history[CONTACT_LANES];
    struct contact_law_result result;

    for (int lane = 0; lane < CONTACT_LANES; lane++)
        history[lane] = work->history[lane][k];
    contact_law_scalar(&meeting, pair, work->dt, choice, history, &result);
    for (int lane = 0; lane < CONTACT_LANES; lane++)
        work->history[lane][k] = history[lane];
    for (int x = 0; x < 3; x++) {
        const int y = (x + 1) % 3, z = (x + 2) % 3;
        const double turn = n[z] * result.tangential[y] - n[y] * result.tangential[z];
        const double force = result.tangential[x] + result.normal * n[x];
        f[x] += -force;
        g[x] += force;
        const double torque = choice.full ? result.torque[x] : 0.0;
        f[4 + x] += (0.5 * (sum - difference) - half) * turn - torque;
        g[4 + x] += (0.5 * (sum + difference) - half) * turn + torque;
    }
    if (choice.ledger) {
        f[3] += 0.5 * result.lost_friction;
        g[3] += 0.5 * result.lost_friction;
        f[7] += 0.5 * result.lost_damping;
        g[7] += 0.5 * result.lost_damping;
        if (i < work->n_owned)
            exact_sum_add(work->wound, result.wound);
    }
    work->overlap_max = 0.5 * relative > work->overlap_max ? 0.5 * relative : work->overlap_max;
}

static void apply_all(struct pair_kernel_work *work, bool uniform,
                      struct contact_law_choice choice)
{
    work->overlap_max = 0.0;
    for (int k = 0; k < work->n_padded; k++) {
        const int a = work->material[work->first[uniform ? 0 : k]];
        const int b = work->material[work->second[uniform ? 0 : k]];
        apply_one(work, k, &work->pairs[a * work->n_materials + b], choice);
    }
}

/* What a scene must contain for the comparison to mean something. */
struct seen {
    int touching, apart, new, ended, sliding, rolling, slid;
};

static void look(const struct scene *before, const struct scene *after, struct seen *seen)
{
    for (int k = 0; k < after->n; k++) {
        const bool was = before->history[CONTACT_RADIUS_LANE][k] > 0.0;
        const bool is = after->history[CONTACT_RADIUS_LANE][k] > 0.0;
        seen->touching += is;
        seen->apart += !is;
        seen->new += is && !was;
        seen->ended += was && !is;
        seen->rolling += after->history[CONTACT_ROLLING_LANE][k] != 0.0;
        seen->slid += after->history[CONTACT_LAW_SLIDING][k] > 0.0;
    }
    for (int i = 0; i < SCENE_SPHERES; i++)
        seen->sliding += after->force[i].lane[3] > 0.0;
}

static void compare(enum isa isa, bool uniform, struct contact_law_choice choice,
                    struct seen *seen)
{
    const struct pair_kernel kernel =
        pair_kernel_choose(isa, uniform, choice.full, choice.ledger);
    static struct scene expected, got, before;

    scene_fill(&expected, 17);
    if (uniform)
        memset(expected.material, 0, sizeof expected.material);
    EXPECT(expected.n > 300 && expected.n < SCENE_PAIRS);
    memcpy(&got, &expected, sizeof got);
    for (int step = 0; step < STEPS; step++) {
        memcpy(&before, &got, sizeof before);
        struct pair_kernel_work work = scene_work(&expected);
        apply_all(&work, uniform, choice);
        expected.overlap_max = work.overlap_max;
        scene_apply(&got, kernel.apply);
        if (scene_difference(&expected, &got) != NULL)
            CHECK_FAIL("%s: step %d: %s differs", isa_name(isa), step,
                       scene_difference(&expected, &got));
        look(&before, &got, seen);
        scene_move(&expected);
        scene_move(&got);
    }
}

TEST(all_instruction_sets_give_the_bits_of_single_contacts)
{
    for (int isa = ISA_GENERIC; isa < ISA_N; isa++) {
        struct seen seen = {0};
        if (!isa_runs((enum isa)isa))
            continue;
        for (int choice = 0; choice < 8; choice++)
            compare((enum isa)isa, choice & 1,
                    (struct contact_law_choice){.full = choice & 2, .ledger = choice & 4},
                    &seen);
        EXPECT(seen.touching > 1000 && seen.apart > 1000);
        EXPECT(seen.new > 100 && seen.ended > 100 && seen.sliding > 1000);
        EXPECT(seen.rolling > 1000 && seen.slid > 100);
    }
}

/* The ledger is only watching. */
TEST(ledger_changes_no_force)
{
    static struct scene with, without;
    const struct pair_kernel ledger = pair_kernel_choose(ISA_AUTO, false, true, true);
    const struct pair_kernel plain = pair_kernel_choose(ISA_AUTO, false, true, false);

    scene_fill(&with, 3);
    scene_fill(&without, 3);
    for (int step = 0; step < STEPS; step++) {
        scene_apply(&with, ledger.apply);
        scene_apply(&without, plain.apply);
        scene_move(&with);
        scene_move(&without);
        for (int lane = 0; lane < CONTACT_LANES; lane++)
            EXPECT(!contact_lane_used(lane, true, false) ||
                   memcmp(with.history[lane], without.history[lane],
                          sizeof with.history[lane]) == 0);
        EXPECT(memcmp(with.motion, without.motion, sizeof with.motion) == 0);
        EXPECT(memcmp(with.spin, without.spin, sizeof with.spin) == 0);
    }
}

/* Exchanging the two spheres of a pair exchanges and negates everything, to the last bit. */
TEST(antisymmetric)
{
    static struct scene one, other;
    const struct pair_kernel kernel = pair_kernel_choose(ISA_AUTO, false, true, true);

    scene_fill(&one, 5);
    one.n = 1;
    one.n_padded = CONTACT_PAD;
    for (int k = 0; k < CONTACT_PAD; k++) {
        one.first[k] = k == 0 ? 10 : SCENE_SPHERES;
        one.second[k] = k == 0 ? 11 : SCENE_SPHERES + 1;
    }
    for (int x = 0; x < 3; x++)
        one.motion[11].lane[x] = one.motion[10].lane[x] + 0.5 * one.motion[10].lane[3];
    memcpy(&other, &one, sizeof other);
    other.first[0] = 11;
    other.second[0] = 10;
    scene_apply(&one, kernel.apply);
    scene_apply(&other, kernel.apply);
    EXPECT(one.force[10].lane[0] != 0.0);
    EXPECT(memcmp(one.force, other.force, sizeof one.force) == 0);
    for (int lane = 0; lane < 3; lane++)
        EXPECT(one.history[lane][0] == -other.history[lane][0]);
    EXPECT(one.history[3][0] == other.history[3][0] &&
           one.history[4][0] == other.history[4][0]);
}

TEST(apart_nothing_is_written_but_plus_zero)
{
    static struct scene scene;
    static const struct sphere_row nothing[SCENE_SPHERES + 2];

    for (int isa = ISA_GENERIC; isa < ISA_N; isa++) {
        if (!isa_runs((enum isa)isa))
            continue;
        scene_fill(&scene, 7);
        for (int i = 0; i < SCENE_SPHERES; i++)
            scene.motion[i].lane[0] += (i % 2 ? -1.0 : 1.0) * i; /* far apart, on both sides */
        for (int k = 0; k < scene.n; k++)
            for (int lane = 0; lane < CONTACT_LANES; lane++)
                if (contact_lane_used(lane, true, false))
                    scene.history[lane][k] = lane == CONTACT_RADIUS_LANE ? 1e-4 : -1.0 - k;
        scene_apply(&scene, pair_kernel_choose((enum isa)isa, false, true, false).apply);
        EXPECT(memcmp(scene.force, nothing, sizeof scene.force) == 0);
        for (int lane = 0; lane < CONTACT_LANES; lane++)
            for (int k = 0; k < scene.n_padded; k++)
                EXPECT(scene.history[lane][k] == 0.0 && !signbit(scene.history[lane][k]));
        EXPECT(scene.overlap_max == 0.0);
    }
}

TEST(no_pairs_is_fine)
{
    static struct scene scene;
    scene_fill(&scene, 1);
    scene.n_padded = 0;
    scene.overlap_max = 1.0;
    scene_apply(&scene, pair_kernel_choose(ISA_AUTO, true, true, true).apply);
    EXPECT(scene.overlap_max == 0.0);
}

TEST(instruction_sets_have_names)
{
    EXPECT_STRING(isa_name(ISA_AUTO), "auto");
    EXPECT_STRING(isa_name(ISA_V3), "v3");
    EXPECT(isa_runs(ISA_AUTO));
    EXPECT(pair_kernel_choose(ISA_AUTO, true, true, true).isa != ISA_AUTO);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
