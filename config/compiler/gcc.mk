# Warnings that only gcc knows.
compiler_warnings = -Wlogical-op -Wduplicated-cond -Wduplicated-branches
