/*
 * Instruction sets: the hot loops exist several times, compiled for vectors of 2, 4 and 8
 * lanes, and one set is chosen when the program starts.  All give the same bits.
 *
 * They are named by what they ask of the processor: v2, v3 and v4 are the levels of x86-64.
 * Which files are compiled so stands in the Makefile; there KERNEL_ISA says for what.
 */
#ifndef TREMIE_BASE_ISA_H
#define TREMIE_BASE_ISA_H

#include <stdbool.h>

enum isa {
    ISA_AUTO, /* the widest that runs */
    ISA_GENERIC,
    ISA_V2,
    ISA_V3,
    ISA_V4,
    ISA_N,
};

/* "auto", "generic", "v2", "v3", "v4": what --isa takes. */
const char *isa_name(enum isa isa);
/* Whether this program is compiled for that set and this processor runs it. */
bool isa_runs(enum isa isa);
/* The set itself, which must run; for ISA_AUTO the widest that does. */
enum isa isa_choose(enum isa isa);

/* How a file that is compiled for each set offers what it holds: ISA_OFFER(f) names f of this
 * compilation, ISA_DECLARE(type, f) declares all of them, and ISA_PICK(isa, f) calls one. */
#if !defined KERNEL_ISA || KERNEL_ISA == 0
#define ISA_OFFER(name) name##_generic
#elif KERNEL_ISA == 2
#define ISA_OFFER(name) name##_v2
#elif KERNEL_ISA == 3
#define ISA_OFFER(name) name##_v3
#else
#define ISA_OFFER(name) name##_v4
#endif

#define ISA_DECLARE(type, name)                                                                \
    type name##_generic(void);                                                                 \
    type name##_v2(void);                                                                      \
    type name##_v3(void);                                                                      \
    type name##_v4(void)

#if defined __x86_64__
#define ISA_PICK(isa, name)                                                                    \
    ((isa) == ISA_V4 ? name##_v4() : (isa) == ISA_V3 ? name##_v3() : name##_v2())
#else
#define ISA_PICK(isa, name) ((void)(isa), name##_generic())
#endif

#endif
