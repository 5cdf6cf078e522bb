# For fuzzing, with clang: sanitizers, and counters of what was reached (tests/fuzz).
flavour_flags = -O1 -g -fno-omit-frame-pointer -fsanitize=address,undefined,fuzzer-no-link -fno-sanitize-recover=all
