# Builds tremie.  `make help` lists what there is.
#
# One makefile for the whole tree: make sees every dependency, so a change anywhere rebuilds what it
# touches and nothing else.  Objects go to BUILD, programs to BIN; other flavours than release with
# gcc keep their programs in their own build folder, so they never get mixed up.

FLAVOUR = release
ifeq ($(origin CC),default)
CC = gcc
endif
PREFIX = /usr/local
JOBS = $(shell nproc)

compiler := $(if $(findstring clang,$(CC)),clang,gcc)
build_name := $(FLAVOUR)$(if $(filter-out gcc,$(CC)),-$(notdir $(CC)))
BUILD = build/$(build_name)
BIN = $(if $(filter release,$(build_name)),bin,$(BUILD)/bin)

include config/compiler/common.mk
include config/compiler/$(compiler).mk
include config/compiler/$(FLAVOUR).mk

# Compile in parallel unless a make above this one already does.
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += -j$(JOBS)
endif
MAKEFLAGS += --no-builtin-rules
# One short line a file; V=1 shows the commands.
say = $(if $(V),,@printf '%-8s %s\n' '$(1)' '$(2)';)
.DELETE_ON_ERROR:
.SUFFIXES:

# ---------------------------------------------------------------------------- what there is to build

main := src/run/main.c
# Compiled once for each instruction set: files that say KERNEL_ISA or include what does.
kernels := src/contact/facet_kernel_blocks.c src/contact/pair_kernel_blocks.c \
    src/physics/integrate_rows.c src/physics/shell_element_blocks.c src/physics/solid_element_blocks.c
library_sources := $(filter-out $(main) $(kernels),$(sort $(wildcard src/*/*.c)))
library_objects := $(library_sources:%.c=$(BUILD)/%.o)
kernel_objects := $(foreach isa,$(kernel_isas),$(kernels:%.c=$(BUILD)/%_$(isa).o))
library := $(BUILD)/libtremie.a

# A tool is postproc/tremie_NAME.c with the other files of postproc/, which tools share.
tool_sources := $(sort $(wildcard postproc/tremie_*.c))
tool_shared := $(patsubst %.c,$(BUILD)/%.o,$(filter-out $(tool_sources),$(sort $(wildcard postproc/*.c))))
tools := $(foreach source,$(tool_sources),$(BIN)/$(subst _,-,$(basename $(notdir $(source)))))
programs := $(if $(wildcard $(main)),$(BIN)/tremie) $(tools)

unit_sources := $(sort $(wildcard tests/unit/test_*.c))
unit_tests := $(patsubst tests/unit/%.c,$(BUILD)/tests/%,$(unit_sources))

# A case of verification is tests/verification/case_NAME.c with the other files there, which cases share.
case_sources := $(sort $(wildcard tests/verification/case_*.c))
case_shared := $(patsubst %.c,$(BUILD)/%.o,\
    $(filter-out $(case_sources),$(sort $(wildcard tests/verification/*.c))))
verification_cases := $(patsubst tests/verification/%.c,$(BUILD)/tests/%,$(case_sources))

# What finite elements cost, a program of its own.
element_bench := $(BUILD)/tests/bench/elements.o

# The charts' own program: charts/*.c and what cases of verification share.
chart_objects := $(patsubst %.c,$(BUILD)/%.o,$(sort $(wildcard charts/*.c)))

# The same for stability, whose cases also use what those of verification share.
limit_sources := $(sort $(wildcard tests/stability/case_*.c))
limit_shared := $(patsubst %.c,$(BUILD)/%.o,\
    $(filter-out $(limit_sources),$(sort $(wildcard tests/stability/*.c))))
stability_cases := $(patsubst tests/stability/%.c,$(BUILD)/tests/%,$(limit_sources))

# Programs that clang's fuzzer drives, in a flavour of their own (tests/fuzz/run).
fuzz_objects := $(patsubst %.c,$(BUILD)/%.o,$(sort $(wildcard tests/fuzz/*.c)))
fuzzers := $(BUILD)/fuzz_job $(BUILD)/fuzz_checkpoint

flavour_objects := $(flavour_sources:%.c=$(BUILD)/%.o)
rules := Makefile $(wildcard config/compiler/*.mk)

all_objects := $(library_objects) $(kernel_objects) $(main:%.c=$(BUILD)/%.o) $(tool_shared) \
    $(tool_sources:%.c=$(BUILD)/%.o) $(unit_sources:%.c=$(BUILD)/%.o) $(case_sources:%.c=$(BUILD)/%.o) \
    $(case_shared) $(limit_sources:%.c=$(BUILD)/%.o) $(limit_shared) $(chart_objects) $(fuzz_objects) \
    $(element_bench) $(flavour_objects)

# --------------------------------------------------------------------------------------------- goals

.PHONY: all hopper dragline test soak fuzzers verify stability bench bench-peers bench-walls bench-elements charts-quick \
    lint help install clean unit_tests \
    verification_cases stability_cases
.DEFAULT_GOAL := all

##  make              build all programs into bin/
all: $(programs) $(library)

##  make hopper       set up what is missing, build, run jobs/hopper.yaml on all cores, show results
hopper:
	@config/setup run
	@$(MAKE) --no-print-directory all
	@config/hopper $(BIN)

##  make dragline     the same for the second example: jobs/dragline_settle.yaml, then jobs/dragline.yaml
dragline:
	@config/setup run
	@$(MAKE) --no-print-directory all
	@config/dragline $(BIN)

##  make test         set up what is missing, build, run all tests (FILTER=word: only some of them)
test:
	@config/setup test
	@$(MAKE) --no-print-directory all unit_tests verification_cases stability_cases
	@BUILD='$(BUILD)' BIN='$(BIN)' FLAVOUR='$(FLAVOUR)' CC='$(CC)' CPPFLAGS='$(CPPFLAGS)' \
	    tests/run $(FILTER)

##  make soak         faults and fuzzing for half an hour or so (FAULTS=300 FUZZ=180 SEED=number; FUZZ in seconds)
soak:
	@config/setup test soak
	@$(MAKE) --no-print-directory all
	@BIN='$(BIN)' CC='$(CC)' FAULTS='$(FAULTS)' FUZZ='$(FUZZ)' SEED='$(SEED)' tests/soak

fuzzers: $(fuzzers)

##  make verify       compare with theory and publications; writes tests/verification/README.md
verify:
	@config/setup test
	@$(MAKE) --no-print-directory all verification_cases
	@BUILD='$(BUILD)' BIN='$(BIN)' tests/verification/run

##  make stability    where methods fail: measures limits of the step; writes tests/stability/README.md
stability:
	@config/setup test
	@$(MAKE) --no-print-directory all stability_cases
	@BUILD='$(BUILD)' BIN='$(BIN)' FLAVOUR='$(FLAVOUR)' tests/stability/run

##  make bench        measure speed: all cases of tests/bench, on one core and two, and elements (CASE=name: one case)
bench:
	@config/setup test
	@$(MAKE) --no-print-directory all
	@BIN='$(BIN)' tests/bench/run
	@[ -n "$(CASE)" ] || $(MAKE) --no-print-directory bench-walls bench-elements

##  make bench-peers  measure speed beside LIGGGHTS and LAMMPS (CASE=name ROUNDS=5 ISA=v3)
bench-peers:
	@config/setup test peers
	@$(MAKE) --no-print-directory all
	@BIN='$(BIN)' tests/bench/run --peers

##  make bench-walls     measure what walls that deform cost: a hopper of shells beside one that is rigid (ROUNDS=3)
bench-walls:
	@config/setup test
	@$(MAKE) --no-print-directory all
	@BIN='$(BIN)' tests/bench/run --walls

##  make bench-elements  measure what finite elements cost on one core, for each instruction set
bench-elements:
	@config/setup run
	@$(MAKE) --no-print-directory $(BUILD)/tests/elements
	@$(BUILD)/tests/elements

##  make charts-quick measure speed against accuracy: tables and charts of charts/, some ten minutes
charts-quick:
	@config/setup test
	@$(MAKE) --no-print-directory all $(BUILD)/charts/impacts
	@BIN='$(BIN)' BUILD='$(BUILD)' charts/run

##  make lint         check the code's form and look for mistakes with clang-tidy and cppcheck
lint:
	@config/setup lint
	@$(MAKE) --no-print-directory all
	@CC='$(CC)' CPPFLAGS='$(CPPFLAGS)' config/lint/run $(FILES)

##  make install      install programs, material library and jobs below PREFIX (PREFIX=/usr/local)
install: all
	install -d $(DESTDIR)$(PREFIX)/bin $(DESTDIR)$(PREFIX)/share/tremie/config \
	    $(DESTDIR)$(PREFIX)/share/tremie/jobs/batch
	install -m 755 $(programs) $(DESTDIR)$(PREFIX)/bin
	install -m 644 $(wildcard config/*.yaml) $(DESTDIR)$(PREFIX)/share/tremie/config
	install -m 644 $(wildcard jobs/*.yaml jobs/*.csv jobs/*.msh jobs/*.stl jobs/*.md) $(DESTDIR)$(PREFIX)/share/tremie/jobs
	install -m 755 $(wildcard jobs/batch/*.sh) $(DESTDIR)$(PREFIX)/share/tremie/jobs/batch
	install -m 644 jobs/batch/README.md $(DESTDIR)$(PREFIX)/share/tremie/jobs/batch

##  make clean        remove everything that was built (runs/ stays)
clean:
	rm -rf build bin

##  make help         this list
help:
	@sed -n 's/^##  //p' $(firstword $(MAKEFILE_LIST))
	@echo
	@echo 'FLAVOUR=release|debug|sanitize chooses how to compile, CC=gcc|clang with what;'
	@echo 'WERROR=1 makes warnings errors; BUILD= and BIN= name other folders to build into; V=1 shows the'
	@echo 'commands.'

unit_tests: $(unit_tests)

verification_cases: $(verification_cases)

stability_cases: $(stability_cases)

# --------------------------------------------------------------------------------------------- rules

$(library_objects) $(tool_shared) $(main:%.c=$(BUILD)/%.o) $(tool_sources:%.c=$(BUILD)/%.o) \
$(unit_sources:%.c=$(BUILD)/%.o) $(case_sources:%.c=$(BUILD)/%.o) $(case_shared) \
$(limit_sources:%.c=$(BUILD)/%.o) $(limit_shared) $(chart_objects) $(fuzz_objects) $(element_bench): \
$(BUILD)/%.o: %.c $(rules)
	@mkdir -p $(@D)
	$(call say,compile,$<)$(CC) $(CPPFLAGS) $(CFLAGS) $(march) -MMD -MP -c -o $@ $<

# The kernels, for each instruction set; the program chooses one when it starts.
define kernel_rule
$$(kernels:%.c=$$(BUILD)/%_$(1).o): $$(BUILD)/%_$(1).o: %.c $$(rules)
	@mkdir -p $$(@D)
	$$(call say,compile,$$< ($(1)))$$(CC) $$(CPPFLAGS) $$(CFLAGS) $$(kernel_flags_$(1)) -MMD -MP -c -o $$@ $$<
endef
$(foreach isa,$(kernel_isas),$(eval $(call kernel_rule,$(isa))))

# What a flavour links in is not ours to check.
$(flavour_objects): $(BUILD)/%.o: %.c $(rules)
	@mkdir -p $(@D)
	$(call say,compile,$<)$(CC) -O1 -g -c -o $@ $<

# Made anew each time, so that objects of deleted files do not linger.
$(library): $(library_objects) $(kernel_objects)
	@rm -f $@
	$(call say,archive,$@)$(AR) rcs $@ $^

$(BIN)/tremie: $(main:%.c=$(BUILD)/%.o) $(flavour_objects) $(library)
	@mkdir -p $(@D)
	$(call say,link,$@)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(LDLIBS)

define tool_rule
$$(BIN)/$(subst _,-,$(1)): $$(BUILD)/postproc/$(1).o $$(tool_shared) $$(flavour_objects) $$(library)
	@mkdir -p $$(@D)
	$$(call say,link,$$@)$$(CC) $$(CFLAGS) $$(LDFLAGS) -o $$@ $$^ $$(LDLIBS)
endef
$(foreach source,$(tool_sources),$(eval $(call tool_rule,$(basename $(notdir $(source))))))

# Tests of what tools share.
$(filter $(BUILD)/tests/test_postproc%,$(unit_tests)): $(tool_shared)
$(unit_tests): $(BUILD)/tests/%: $(BUILD)/tests/unit/%.o $(flavour_objects) $(library)
	@mkdir -p $(@D)
	$(call say,link,$@)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $(filter %.o,$^) $(library) $(LDLIBS)

# It reads tables that tools write.
$(BUILD)/tests/case_silo_wall: $(tool_shared)
$(verification_cases): $(BUILD)/tests/%: $(BUILD)/tests/verification/%.o $(case_shared) \
    $(flavour_objects) $(library)
	@mkdir -p $(@D)
	$(call say,link,$@)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $(filter %.o,$^) $(library) $(LDLIBS)

$(BUILD)/charts/impacts: $(chart_objects) $(case_shared) $(flavour_objects) $(library)
	@mkdir -p $(@D)
	$(call say,link,$@)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(LDLIBS)

$(BUILD)/tests/elements: $(element_bench) $(flavour_objects) $(library)
	@mkdir -p $(@D)
	$(call say,link,$@)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(LDLIBS)

$(stability_cases): $(BUILD)/tests/%: $(BUILD)/tests/stability/%.o $(limit_shared) \
    $(case_shared) $(flavour_objects) $(library)
	@mkdir -p $(@D)
	$(call say,link,$@)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $(filter %.o,$^) $(library) $(LDLIBS)

# A bug that the program reports of itself is a finding; edits of checkpoints get past our checksums.
fuzz_wraps = -Wl,--wrap=report_bug,--wrap=report_no_memory$(if $(findstring checkpoint,$@),$(comma)--wrap=crc32_of)
comma := ,
$(fuzzers): $(BUILD)/fuzz_%: $(BUILD)/tests/fuzz/fuzz_%.o $(BUILD)/tests/fuzz/fuzz.o $(library)
	$(call say,link,$@)$(CC) $(CFLAGS) -fsanitize=fuzzer $(fuzz_wraps) -o $@ $^ $(LDLIBS)

-include $(all_objects:.o=.d)
