# For work: optimised, with debug information (which costs no time).
flavour_flags = -O2 -g
