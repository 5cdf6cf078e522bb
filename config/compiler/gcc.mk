# Warnings that only gcc knows.  psabi tells of a change between versions 4.5 and 4.6.
compiler_warnings = -Wlogical-op -Wduplicated-cond -Wduplicated-branches -Wno-psabi
