# For tests: the address and undefined-behaviour sanitizers stop at the first mistake.
flavour_flags = -O1 -g -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=all
flavour_sources = config/compiler/sanitize.c
