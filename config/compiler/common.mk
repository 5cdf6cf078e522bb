# What every compiler and flavour shares.

packages = ompi-c hdf5-openmpi yaml-0.1 libpng zlib
# The libraries' headers are included as system headers: their warnings are not ours.
CPPFLAGS := -D_GNU_SOURCE -Isrc $(subst -I,-isystem ,$(shell pkg-config --cflags $(packages) 2>/dev/null))
LDLIBS := $(shell pkg-config --libs $(packages) 2>/dev/null) -lm -pthread

warnings = -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion -Wstrict-prototypes \
    -Wmissing-prototypes -Wundef -Wvla -Wcast-qual -Wformat=2 -Wwrite-strings -Wswitch-enum

# Every compiler, flavour and processor must round alike: no contraction to fused multiply-add, nothing
# reordered.  The other two only drop side effects (errno, traps) that keep loops from using vectors.
numerics = -ffp-contract=off -fno-math-errno -fno-trapping-math

# Programs run on any x86-64 processor of the last fifteen years; only the kernels are compiled for newer
# ones as well.
ifeq ($(shell uname -m),x86_64)
march = -march=x86-64-v2
kernel_isas = v2 v3 v4
kernel_flags_v2 = -DKERNEL_ISA=2 -march=x86-64-v2
kernel_flags_v3 = -DKERNEL_ISA=3 -march=x86-64-v3
kernel_flags_v4 = -DKERNEL_ISA=4 -march=x86-64-v4 -mprefer-vector-width=512
else
kernel_isas = generic
kernel_flags_generic = -DKERNEL_ISA=0
endif

CFLAGS = -std=c11 $(warnings) $(compiler_warnings) $(if $(WERROR),-Werror) $(numerics) $(compiler_flags) $(flavour_flags)
