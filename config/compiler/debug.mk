# For a debugger: what is written is what runs, with the same bits.
flavour_flags = -O0 -g3
