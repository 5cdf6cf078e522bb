# Warnings that only gcc knows.  psabi tells of a change between versions 4.5 and 4.6.
compiler_warnings = -Wlogical-op -Wduplicated-cond -Wduplicated-branches -Wno-psabi
# Loops over three components are unrolled where that takes more room, too: 4 % of a run with walls that deform.
compiler_flags = -fpeel-loops $(if $(filter sanitize,$(FLAVOUR)),$(untracked))
# Else gcc takes three times as long for kernels with sanitizers, to follow variables through them.
untracked = -fno-var-tracking-assignments
# With vectors of eight lanes gcc's second scheduling fills registers that loops then lack: 2 to 4 % of a pair.
kernel_flags_v4 += -fno-schedule-insns2
