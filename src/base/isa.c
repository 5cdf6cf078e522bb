/*
 * See isa.h.  The levels of x86-64 are asked for feature by feature, as gcc 12 and clang 14
 * understand them.
 */
#include "base/isa.h"

#include <stddef.h>

#include "base/report.h"

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
} SETS[ISA_N] = {
    [ISA_AUTO] = {"auto", always},
#if defined __x86_64__
    [ISA_GENERIC] = {"generic", NULL}, [ISA_V2] = {"v2", runs_v2},
    [ISA_V3] = {"v3", runs_v3},        [ISA_V4] = {"v4", runs_v4},
#else
    [ISA_GENERIC] = {"generic", always},
    [ISA_V2] = {"v2", NULL},
    [ISA_V3] = {"v3", NULL},
    [ISA_V4] = {"v4", NULL},
#endif
};

const char *isa_name(enum isa isa)
{
    return SETS[isa].name;
}

bool isa_runs(enum isa isa)
{
    return SETS[isa].runs != NULL && SETS[isa].runs();
}

enum isa isa_choose(enum isa isa)
{
    if (isa == ISA_AUTO)
        for (isa = ISA_V4; isa > ISA_AUTO && !isa_runs(isa);)
            isa--;
    CHECK(isa != ISA_AUTO && isa_runs(isa), "the instruction set %s does not run here",
          SETS[isa].name);
    return isa;
}
