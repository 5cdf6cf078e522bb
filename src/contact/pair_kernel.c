/*
 * Chooses among the kernels of pair_kernel_blocks.c by what the processor can do.
 *
 * The levels of x86-64 are asked for feature by feature, as gcc 12 and clang 14 understand
 * them.
 */
#include "contact/pair_kernel.h"

#include <stddef.h>

#include "base/report.h"
#include "contact/pair_kernel_blocks.h"
#include "physics/contact_law.h"

_Static_assert((int)CONTACT_LANES == (int)CONTACT_LAW_LANES &&
                   (int)CONTACT_DRAG_LANE == (int)CONTACT_LAW_DRAG &&
                   (int)CONTACT_RADIUS_LANE == (int)CONTACT_LAW_RADIUS &&
                   (int)CONTACT_ROLLING_LANE == (int)CONTACT_LAW_ROLLING &&
                   (int)CONTACT_TWISTING_LANE == (int)CONTACT_LAW_TWISTING,
               "contact sets keep what the law remembers");

static bool always(void)
{
    return true;
}

#if defined __x86_64__
static bool runs_v2(void)
{
    return __builtin_cpu_supports("ssse3") && __builtin_cpu_supports("sse4.2") &&
           __builtin_cpu_supports("popcnt");
}

static bool runs_v3(void)
{
    return runs_v2() && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
}

static bool runs_v4(void)
{
    return runs_v3() && __builtin_cpu_supports("avx512f") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}
#endif

static const struct {
    const char *name;
    bool (*runs)(void); /* NULL: not in this program */
    struct pair_kernel_blocks (*blocks)(void);
} isas[PAIR_KERNEL_N_ISAS] = {
    [PAIR_KERNEL_AUTO] = {"auto", always, NULL},
#if defined __x86_64__
    [PAIR_KERNEL_GENERIC] = {"generic", NULL, NULL},
    [PAIR_KERNEL_V2] = {"v2", runs_v2, pair_kernel_blocks_v2},
    [PAIR_KERNEL_V3] = {"v3", runs_v3, pair_kernel_blocks_v3},
    [PAIR_KERNEL_V4] = {"v4", runs_v4, pair_kernel_blocks_v4},
#else
    [PAIR_KERNEL_GENERIC] = {"generic", always, pair_kernel_blocks_generic},
    [PAIR_KERNEL_V2] = {"v2", NULL, NULL},
    [PAIR_KERNEL_V3] = {"v3", NULL, NULL},
    [PAIR_KERNEL_V4] = {"v4", NULL, NULL},
#endif
};

const char *pair_kernel_isa_name(enum pair_kernel_isa isa)
{
    return isas[isa].name;
}

bool pair_kernel_isa_runs(enum pair_kernel_isa isa)
{
    return isas[isa].runs != NULL && isas[isa].runs();
}

static enum pair_kernel_isa widest(void)
{
    enum pair_kernel_isa isa = PAIR_KERNEL_V4;

    while (isa > PAIR_KERNEL_AUTO && !pair_kernel_isa_runs(isa))
        isa--;
    CHECK(isa != PAIR_KERNEL_AUTO, "no pair kernel runs on this processor");
    return isa;
}

struct pair_kernel pair_kernel_choose(enum pair_kernel_isa isa, bool uniform, bool full,
                                      bool ledger)
{
    if (isa == PAIR_KERNEL_AUTO)
        isa = widest();
    CHECK(pair_kernel_isa_runs(isa), "the pair kernel %s does not run here", isas[isa].name);
    return (struct pair_kernel){isa, isas[isa].blocks().apply[uniform][full][ledger]};
}
