# selas: smoothed-point elastodynamics. `make help` lists what users call, `make help-checks` the rest (regress/rules.mk).

CC      ?= cc
FC      := $(if $(filter default,$(origin FC)),gfortran,$(FC))
PREFIX  ?= /usr/local
BUILD   ?= build
CFLAGS  ?= -O3 -g
# clang says so of each loop that it cannot make of vectors, as maxima without -ffinite-math-only: that is no fault
WARNINGS = -Wall -Wextra -Wpedantic -Wconversion -Wshadow $(if $(findstring clang,$(CC)),-Wno-pass-failed) $(if $(WERROR),-Werror)
# The serial HDF5, also where `hdf5` is that of MPI.
PKGS    := gsl fftw3 $(shell pkg-config --exists hdf5-serial 2>/dev/null && echo hdf5-serial || echo hdf5)
Q        = $(if $(V),,@)
# errno of libm and floating-point traps are not used: without them loops with sqrt and choices run in vectors
ALL_C    = -std=c17 -D_GNU_SOURCE -Isrc -fopenmp -fPIC -fvisibility=hidden -fno-math-errno -fno-trapping-math \
           $(WARNINGS) $(CFLAGS) $(if $(filter plain,$(KINDS)),-DSELAS_ONE_KIND) \
           $(shell pkg-config --cflags $(PKGS) 2>/dev/null)
LIBS     = $(shell pkg-config --libs $(PKGS) 2>/dev/null) -lm

# The room of ranks has two faces: alone.c, and mpi.c in its place in what `make mpi` makes
MPI_ONLY = src/parallel/mpi.c
SOURCES := $(filter-out src/program/% $(MPI_ONLY),$(shell find src -name "*.c" | sort))
# Kernels are compiled once for each kind of processor (src/base/processor.h)
KERNELS  = $(wildcard $(addprefix src/method/,spline/passes.c consistent/fused/kernels_*.c consistent/general/kernels_*.c consistent/absorbing/pml_kernels_*.c \
           total_lagrangian/*_loops.c updated_lagrangian/block_rates.c updated_lagrangian/artificial_stress.c cloud/solver.c cloud/splines.c))
KINDS   := $(if $(filter x86_64%,$(shell $(CC) -dumpmachine 2>/dev/null)),x86-64 x86-64-v3 x86-64-v4,plain)
OBJECTS  = $(patsubst src/%.c,$(BUILD)/obj/%.o,$(filter-out $(KERNELS),$(SOURCES))) \
           $(foreach kind,$(KINDS),$(KERNELS:src/%.c=$(BUILD)/obj/$(kind)/%.o))
PROGRAM  = $(wildcard src/program/*.c)
VERSION  = $(shell sed -n 's/^\#define SELAS_VERSION "\(.*\)"/\1/p' src/selas.h)
SONAME   = libselas.so.$(firstword $(subst ., ,$(VERSION)))
MPI_SONAME = $(SONAME:libselas%=libselas-mpi%)
FFLAGS  ?= -O2 -g
ALL_F    = -std=f2018 -fPIC -Wall -Wextra -Wno-compare-reals $(if $(WERROR),-Werror) $(FFLAGS)
AR      := $(if $(findstring -flto,$(CFLAGS)),gcc-ar,$(AR))
AT       = $(DESTDIR)$(PREFIX)

# All processors, unless -j says otherwise
ifeq ($(MAKELEVEL)$(filter -j% --jobs%,$(MAKEFLAGS) $(shell printf '%s' "$$MAKEFLAGS")),0)
MAKEFLAGS += -j$(shell nproc 2>/dev/null || echo 2)
endif

# The recipes. EXTRA: further options of a target.
define compile
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(CC) $(ALL_C) -MMD -MP -c -o $@ $<
endef
define compile_fortran
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(FC) $(ALL_F) -J$(BUILD) -c -o $@ $<
endef
define link
	@mkdir -p $(@D)
	$(if $(V),,@echo "  link $@")
	$(Q)$(CC) $(CFLAGS) -fopenmp $(LDFLAGS) $(EXTRA) -o $@ $(filter %.o %.a,$^) $(LIBS)
endef

.DEFAULT_GOAL := all
.PHONY: all setup setup-mpi setup-manual manual mpi halfspace test regress nightly install install-mpi uninstall clean help always

all: $(BUILD)/selas $(BUILD)/$(SONAME) $(BUILD)/whole/libselas.a $(BUILD)/libselas_fortran.a ## build the program build/selas and the libraries

setup: ## install what is missing with apt (root or sudo)
	@sh regress/setup

setup-mpi: setup ## install what `make mpi` needs besides
	@sh regress/setup mpi

setup-manual: ## install what `make manual` needs: pandoc, weasyprint, graphviz
	@sh regress/setup manual

manual: ## the manual as a site and a book: output/manual/html/index.html, output/manual/selas.pdf
	@regress/manual/run

mpi: all $(BUILD)/selas-mpi $(BUILD)/$(MPI_SONAME) ## build build/selas-mpi for mpirun and libselas-mpi for hosts (doc/howto/ranks.md)

halfspace: setup ## set up, build, run input/halfspace.nml and leave its plots in output/halfspace/
	@$(MAKE) --no-print-directory all
	$(BUILD)/selas input/halfspace.nml
	@ls output/halfspace

test: setup ## set up, build and run all tests
	@$(MAKE) --no-print-directory unit

regress: ## the quick half of the nightly regression; page in OUT=output/regress/index.html (a minute or two)
	@$(ALONE) regress/nightly/run -q $(if $(OUT),-o '$(OUT)')

nightly: ## the whole nightly regression: all cases, tests, planted faults, compilers, stability, accuracy
	@$(ALONE) regress/nightly/run $(if $(OUT),-o '$(OUT)')

$(BUILD)/selas: $(PROGRAM:src/%.c=$(BUILD)/obj/%.o) $(BUILD)/libselas.a
	$(link)

$(BUILD)/libselas.a: $(OBJECTS)
	@rm -f $@
	$(Q)$(AR) rcs $@ $^

$(BUILD)/obj/%.o: src/%.c
	$(compile)

# The program for ranks: MPI's own compiler links and makes the objects that know MPI or HDF5, which is that of this MPI
# (pkg-config's hdf5-openmpi, hdf5-mpich, or hdf5 where Debian's names are unknown). Both HDF5 in one program do not go together.
MPICC   ?= mpicc
MPI_HDF5 ?= $(firstword $(shell for one in $(if $(findstring mpich,$(shell $(MPICC) -show 2>&1)),hdf5-mpich,hdf5-openmpi) hdf5; do pkg-config --exists $$one && echo $$one; done))
includers = $(sort $(1) $(shell grep -rlE 'include .($(subst $(empty) ,|,$(patsubst src/%,%,$(1)))).' src))
KNOW_HDF5 := $(filter %.c,$(call includers,$(call includers,$(call includers,hdf5.h))))
for_mpi  = $(patsubst $(BUILD)/obj/%,$(BUILD)/mpi/%,$(filter $(KNOW_HDF5:src/%.c=$(BUILD)/obj/%.o),$(1))) \
           $(filter-out $(KNOW_HDF5:src/%.c=$(BUILD)/obj/%.o),$(1))
MPI_OBJECTS = $(call for_mpi,$(filter-out %/parallel/alone.o,$(OBJECTS))) $(BUILD)/mpi/parallel/mpi.o
$(BUILD)/selas-mpi: $(call for_mpi,$(PROGRAM:src/%.c=$(BUILD)/obj/%.o)) $(BUILD)/mpi/libselas-mpi.a
	$(link)
$(BUILD)/mpi/libselas-mpi.a: $(MPI_OBJECTS)
	@rm -f $@
	$(Q)$(AR) rcs $@ $^
$(BUILD)/$(MPI_SONAME): $(MPI_OBJECTS) $(BUILD)/selas.map
	$(link)
	@ln -sf $(MPI_SONAME) $(BUILD)/libselas-mpi.so
$(BUILD)/$(MPI_SONAME): private EXTRA = -shared -Wl,-soname,$(MPI_SONAME) -Wl,--version-script=$(BUILD)/selas.map
$(BUILD)/mpi/%.o: src/%.c
	$(compile)
$(BUILD)/selas-mpi $(BUILD)/$(MPI_SONAME) $(BUILD)/mpi/%.o: private override CC = $(MPICC)
$(BUILD)/selas-mpi $(BUILD)/$(MPI_SONAME) $(BUILD)/mpi/%.o: private PKGS := gsl fftw3 $(MPI_HDF5)

# the commit that is built, "+" behind it if files were changed; provenance.c is compiled anew when it changes
COMMIT   = $(shell git describe --always --exclude='*' --dirty=+ 2>/dev/null || echo unknown)
$(BUILD)/commit: always
	@mkdir -p $(BUILD)
	@echo '$(COMMIT)' | cmp -s - $@ || echo '$(COMMIT)' >$@
PROVENANCE = $(BUILD)/obj/record/provenance.o $(BUILD)/mpi/record/provenance.o
$(PROVENANCE): $(BUILD)/commit
$(PROVENANCE): ALL_C += -DSELAS_FLAGS='"$(subst ",,$(CFLAGS))"' -DSELAS_COMMIT='"$(COMMIT)"'

# Kernels: a multiplication and an addition in one instruction where the kind has it, but for what is no sum over neighbours
define kernels_of_kind
$(BUILD)/obj/$(1)/%.o: ALL_C += $(2) -ffp-contract=fast $(KERNEL_FLAGS)
$(BUILD)/obj/$(1)/%.o: src/%.c
	$$(compile)
endef
$(eval $(call kernels_of_kind,plain,))
$(eval $(call kernels_of_kind,x86-64,-march=x86-64 -DSELAS_KIND=1))
$(eval $(call kernels_of_kind,x86-64-v3,-march=x86-64-v3 -DSELAS_KIND=3))
$(eval $(call kernels_of_kind,x86-64-v4,-march=x86-64-v4 -mprefer-vector-width=512 -DSELAS_KIND=4))
$(addprefix $(BUILD)/obj/%/method/,cloud/solver.o cloud/splines.o updated_lagrangian/artificial_stress.o): ALL_C += -ffp-contract=off

# What hosts link. Only names that begin with selas_ are seen outside.
$(BUILD)/$(SONAME): $(OBJECTS) $(BUILD)/selas.map
	$(link)
$(BUILD)/$(SONAME): private EXTRA = -shared -Wl,-soname,$(SONAME) -Wl,--version-script=$(BUILD)/selas.map \
    $(if $(findstring -fsanitize,$(CFLAGS) $(LDFLAGS)),,-Wl,--no-undefined)

$(BUILD)/selas.map:
	@mkdir -p $(@D)
	@echo '{ global: selas_*; local: *; };' >$@

$(BUILD)/whole/selas.o: $(OBJECTS)
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(if $(findstring -flto,$(CFLAGS)),-flto-partition=one -flinker-output=nolto-rel) -r -nostdlib -Wl,-d -o $@ $^
	$(Q)objcopy --wildcard --keep-global-symbol='selas_*' $@

$(BUILD)/whole/libselas.a: $(BUILD)/whole/selas.o
	@rm -f $@
	$(Q)$(AR) rcs $@ $^

$(BUILD)/selas.o: src/selas.f90
	$(compile_fortran)

$(BUILD)/selas77.o: src/selas77.f90 $(BUILD)/selas.o
	$(compile_fortran)

$(BUILD)/libselas_fortran.a: $(BUILD)/selas.o $(BUILD)/selas77.o
	@rm -f $@
	$(Q)$(AR) rcs $@ $^

# pkg-config files: selas for C, selas-fortran for the module (which needs selas). A blank in a path is \ there. What static
# libraries need comes last: of HDF5, whose own file does not say it, compression (zlib, szip) and the loading of filters. A static gfortran program that
# has pthreads destroys locks by a name that it refers to only weakly: it has to be asked for.
empty   :=
STATIC   = $(foreach one,sz aec z dl,$(if $(findstring /,$(shell $(CC) -print-file-name=lib$(one).a)),-l$(one)))
PC_PREFIX = $(subst $(empty) ,\ ,$(PREFIX))
define selas_pc
prefix=$(PC_PREFIX)
libdir=$${prefix}/lib
includedir=$${prefix}/include

Name: selas
Description: smoothed-point elastodynamics
Version: $(VERSION)
Libs: -L$${libdir} -lselas
Libs.private: -fopenmp $(shell pkg-config --static --libs $(PKGS)) $(STATIC) -lm
Cflags: -I$${includedir}
endef
define selas_fortran_pc
prefix=$(PC_PREFIX)
libdir=$${prefix}/lib
includedir=$${prefix}/include

Name: selas-fortran
Description: smoothed-point elastodynamics, Fortran module
Version: $(VERSION)
Requires: selas
Libs: -L$${libdir} -lselas_fortran
Libs.private: -Wl,--undefined=pthread_mutex_destroy
Cflags: -I$${includedir}/selas
endef

install: all ## install program, libraries, header, module, manual and decks below PREFIX (DESTDIR)
	$(file >$(BUILD)/selas.pc,$(selas_pc))
	$(file >$(BUILD)/selas-fortran.pc,$(selas_fortran_pc))
	install -D $(BUILD)/selas '$(AT)/bin/selas'
	install -D $(BUILD)/$(SONAME) '$(AT)/lib/libselas.so.$(VERSION)'
	ln -sf libselas.so.$(VERSION) '$(AT)/lib/$(SONAME)'
	ln -sf $(SONAME) '$(AT)/lib/libselas.so'
	install -m 644 $(BUILD)/whole/libselas.a $(BUILD)/libselas_fortran.a '$(AT)/lib'
	install -D -m 644 -t '$(AT)/lib/pkgconfig' $(BUILD)/selas.pc $(BUILD)/selas-fortran.pc
	install -D -m 644 -t '$(AT)/include' src/selas.h
	install -D -m 644 -t '$(AT)/include/selas' $(BUILD)/selas.mod src/selas.f90 src/selas77.f90
	install -D -m 644 -t '$(AT)/share/man/man1' doc/selas.1
	install -D -m 644 -t '$(AT)/share/selas' input/*.nml input/*.txt
	for page in $$(cd doc && find . -name '*.md' -o -name '*.png' -o -name '*.txt'); do \
	    install -D -m 644 "doc/$$page" '$(AT)/share/doc/selas/'"$$page" || exit 1; done

install-mpi: mpi install ## the same and selas-mpi, libselas-mpi and selas_mpi.h
	install -D $(BUILD)/selas-mpi '$(AT)/bin/selas-mpi'
	install -D $(BUILD)/$(MPI_SONAME) '$(AT)/lib/libselas-mpi.so.$(VERSION)'
	ln -sf libselas-mpi.so.$(VERSION) '$(AT)/lib/$(MPI_SONAME)'
	ln -sf $(MPI_SONAME) '$(AT)/lib/libselas-mpi.so'
	install -D -m 644 -t '$(AT)/include' src/selas_mpi.h

uninstall: ## remove what install and install-mpi put there
	rm -f '$(AT)/bin/selas' '$(AT)/bin/selas-mpi' '$(AT)/lib/'libselas.so* '$(AT)/lib/'libselas-mpi.so* '$(AT)/include/selas_mpi.h' '$(AT)/lib/libselas.a' '$(AT)/lib/libselas_fortran.a' \
	    '$(AT)/lib/pkgconfig/selas.pc' '$(AT)/lib/pkgconfig/selas-fortran.pc' '$(AT)/include/selas.h' '$(AT)/share/man/man1/selas.1'
	rm -rf '$(AT)/include/selas' '$(AT)/share/selas' '$(AT)/share/doc/selas'

clean: ## remove build/
	rm -rf $(BUILD)

# `make help` lists the targets of the Makefile that have "##" behind them, `make help-checks` those of regress/rules.mk.
listed = @sed -nE 's/^([a-z-]+):.*\#\# (.*)/  make \1@\2/p' $(1) | column -t -s@
help: ## this list
	$(call listed,Makefile)
	@echo "  (tests, checks and studies of those who develop selas: make help-checks)"

include regress/rules.mk
-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
