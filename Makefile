# selas: smoothed-point elastodynamics. `make help` lists the targets.

CC      ?= cc
FC       = gfortran
PREFIX  ?= /usr/local
BUILD   ?= build
CFLAGS  ?= -O3 -g
WARNINGS = -Wall -Wextra -Wpedantic -Wconversion -Wshadow $(if $(WERROR),-Werror)
PKGS     = gsl fftw3 hdf5
Q        = $(if $(V),,@)
# errno of libm and floating-point traps are not used: without them loops with sqrt and choices run in vectors
ALL_C    = -std=c17 -D_GNU_SOURCE -Isrc -fopenmp -fPIC -fvisibility=hidden -fno-math-errno -fno-trapping-math \
           $(WARNINGS) $(CFLAGS) \
           $(shell pkg-config --cflags $(PKGS) 2>/dev/null)
LIBS     = $(shell pkg-config --libs $(PKGS) 2>/dev/null) -lm

SOURCES  = $(filter-out src/program/%,$(shell find src -name '*.c' | sort))
OBJECTS  = $(SOURCES:src/%.c=$(BUILD)/obj/%.o)
PROGRAM  = $(wildcard src/program/*.c)
VERSION  = $(shell sed -n 's/^\#define SELAS_VERSION "\(.*\)"/\1/p' src/selas.h)
SONAME   = libselas.so.$(firstword $(subst ., ,$(VERSION)))
FFLAGS  ?= -O2 -g
ALL_F    = -std=f2018 -fPIC -Wall -Wextra -Wno-compare-reals $(if $(WERROR),-Werror) $(FFLAGS)
LIBDIR   = $(PREFIX)/lib
INCLUDE  = $(PREFIX)/include
TESTS    = $(patsubst regress/unit/%.c,$(BUILD)/test/%,$(wildcard regress/unit/test_*.c))

.DEFAULT_GOAL := all
.PHONY: all setup halfspace absorption paper-figures sph-figures consistent-tables tables test unit check-format check-tidy check-cppcheck install uninstall clean help

all: $(BUILD)/selas $(BUILD)/$(SONAME) $(BUILD)/whole/libselas.a $(BUILD)/libselas_fortran.a ## build the program build/selas and the libraries

setup: ## install what is missing with apt (root or sudo)
	@sh regress/setup

halfspace: setup ## set up, build, run input/halfspace.nml and leave its plots in output/halfspace/
	@$(MAKE) --no-print-directory all
	$(BUILD)/selas input/halfspace.nml
	@ls output/halfspace

absorption: $(BUILD)/selas ## table of doc/absorbing-faces.md: what comes back from transmitting faces
	@sh regress/absorption $(BUILD)

.PHONY: quiet
quiet: $(BUILD)/test/quiet ## energy beside absorbing faces to t = 1000 (twenty minutes): doc/absorbing-faces.md
	@sh regress/quiet $(BUILD)

$(BUILD)/test/quiet: regress/quiet.c $(BUILD)/libselas.a
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(CC) $(ALL_C) -MMD -MP $(LDFLAGS) -o $@ $< $(BUILD)/libselas.a $(LIBS)

.PHONY: relations
relations: $(BUILD)/test/relations ## what every run keeps, on scenes drawn by chance (minutes): doc/robustness.md
	@regress/relations $(BUILD) 1 100

$(BUILD)/test/relations: regress/relations.c $(BUILD)/libselas.a
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(CC) $(ALL_C) -MMD -MP $(LDFLAGS) -o $@ $< $(BUILD)/libselas.a $(LIBS)

.PHONY: stops
stops: $(BUILD)/test/stops ## restarts from random steps with two threads and one, all methods (minutes): doc/restart.md
	@sh regress/stops $(BUILD)

$(BUILD)/test/stops: regress/stops.c $(BUILD)/libselas.a
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(CC) $(ALL_C) -MMD -MP $(LDFLAGS) -o $@ $< $(BUILD)/libselas.a $(LIBS)

paper-figures: $(BUILD)/selas ## Figs 2-5 of Ding et al. (2006) with their errors, in output/paper-figures/
	@sh regress/paper-figures $(BUILD)

sph-figures: $(BUILD)/selas ## Figs 4-13 and 15-19 of He & Seaid (2016), in output/sph-figures/ (about a minute)
	@sh regress/sph-figures $(BUILD)

consistent-tables: $(BUILD)/selas $(BUILD)/test/test_dispersion ## errors of the consistent method beside those wanted: doc/consistent-tables.md
	@sh regress/consistent-tables $(BUILD)

.PHONY: stability accuracy
stability: $(BUILD)/selas $(BUILD)/test/stability-energy $(BUILD)/test/stability-spectrum ## hard cases, sweeps and plots of doc/stability.md (minutes)
	@sh regress/stability $(BUILD)

accuracy: $(BUILD)/selas ## speed against error: tables and plots of doc/accuracy.md (some 20 minutes)
	@sh regress/accuracy $(BUILD)

.PHONY: bench bench-all
bench: $(BUILD)/selas $(BUILD)/test/bench ## speed beside the machine's own, under a minute: output/bench/
	@sh regress/bench/run $(BUILD)

bench-all: $(BUILD)/selas $(BUILD)/test/bench ## the same with large lattices: doc/performance.md (some minutes, 12 GB)
	@sh regress/bench/run $(BUILD) all

.PHONY: lamb-check
lamb-check: $(BUILD)/test/lamb_grid ## hold the half-space's FFT against its closed form: ten receivers, four Poisson ratios
	$(BUILD)/test/lamb_grid

.PHONY: regress nightly faults regress-compilers verification
regress: ## the quick half of the nightly regression; page in output/regress/index.html (a minute or two)
	@regress/nightly -q

nightly: ## the whole nightly regression: all cases, tests, planted faults, compilers, stability, accuracy
	@regress/nightly

faults: $(BUILD)/selas ## plant faults in a copy of the source and count that the regression finds each
	@regress/faults $(BUILD)

regress-compilers: ## one baseline for gcc and clang, -O2 and -O3, 1 and 2 threads (builds four programs)
	@regress/compilers

verification: ## write doc/verification.md anew from the cases and their recorded errors
	@regress/verification

test: setup ## set up, build and run all tests
	@$(MAKE) --no-print-directory unit

unit: all $(TESTS) $(BUILD)/test/relations ## run the tests without the set-up
	@sh regress/run-tests $(BUILD)

$(BUILD)/selas: $(PROGRAM:src/%.c=$(BUILD)/obj/%.o) $(BUILD)/libselas.a
	$(if $(V),,@echo "  link $@")
	$(Q)$(CC) -fopenmp $(LDFLAGS) -o $@ $^ $(LIBS)

$(BUILD)/libselas.a: $(OBJECTS)
	@rm -f $@
	$(Q)ar rcs $@ $^

# the commit that is built, "+" behind it if files were changed; provenance.c is compiled anew when it changes
COMMIT   = $(shell git describe --always --exclude='*' --dirty=+ 2>/dev/null || echo unknown)
$(BUILD)/commit: always
	@mkdir -p $(BUILD)
	@echo '$(COMMIT)' | cmp -s - $@ || echo '$(COMMIT)' >$@
.PHONY: always
$(BUILD)/obj/record/provenance.o: $(BUILD)/commit
$(BUILD)/obj/record/provenance.o: ALL_C += -DSELAS_FLAGS='"$(subst ",,$(CFLAGS))"' -DSELAS_COMMIT='"$(COMMIT)"'

# Multiplication and addition of the lattice and SPH operators in one instruction where the machine has it
$(BUILD)/obj/method/consistent/fused/fused_%.o $(BUILD)/obj/method/consistent/absorbing/pml_fast_%.o $(BUILD)/obj/method/spline/passes.o: ALL_C += -ffp-contract=fast
$(BUILD)/obj/method/total_lagrangian/run_loops.o $(BUILD)/obj/method/total_lagrangian/point_loops.o $(BUILD)/obj/method/updated_lagrangian/rate.o: ALL_C += -ffp-contract=fast

$(BUILD)/obj/%.o: src/%.c
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(CC) $(ALL_C) -MMD -MP -c -o $@ $<

$(BUILD)/test/%: regress/unit/%.c $(BUILD)/libselas.a
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(CC) $(ALL_C) -Iregress/unit -MMD -MP $(LDFLAGS) -o $@ $< $(BUILD)/libselas.a $(LIBS) -lcmocka

# The library's ways to memory go through regress/unit/allocation.c, where they can fail
WRAPPED  = malloc calloc realloc free aligned_alloc strdup strndup open_memstream fftw_malloc fftw_alloc_real \
           fftw_alloc_complex fftw_free
$(BUILD)/test/test_no_memory: regress/unit/test_no_memory.c regress/unit/allocation.c $(BUILD)/libselas.a
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(CC) $(ALL_C) -fno-builtin -Iregress/unit $(LDFLAGS) $(WRAPPED:%=-Wl,--wrap=%) -o $@ $(filter %.c,$^) \
	    $(BUILD)/libselas.a $(LIBS) -lcmocka

tables: ## rerun Tables 1-4 of He & Seaid (2016) into doc/tables.md (some 20 minutes; installs calculix-ccx)
	@sh regress/setup tables
	@$(MAKE) --no-print-directory all
	@regress/tables $(BUILD)

$(BUILD)/test/bench: regress/bench/bench.c $(BUILD)/libselas.a
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(CC) $(ALL_C) -ffp-contract=fast -MMD -MP $(LDFLAGS) -o $@ $< $(BUILD)/libselas.a $(LIBS)

$(BUILD)/test/lamb_grid: regress/lamb/lamb_grid.c $(BUILD)/libselas.a
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(CC) $(ALL_C) -MMD -MP $(LDFLAGS) -o $@ $< $(BUILD)/libselas.a $(LIBS)

.PHONY: check-leaks bench-host
check-leaks: ## wrong calls and checkpoints under valgrind (two minutes; installs valgrind)
	@sh regress/setup leaks
	+@regress/valgrind $(BUILD) test_api_wrong test_api_checkpoint

bench-host: all ## what stepping one step at a time from Fortran costs on input/halfspace.nml
	@mkdir -p $(BUILD)/test
	$(Q)$(FC) $(ALL_F) -I$(BUILD) -o $(BUILD)/test/overhead regress/hosts/overhead.f90 $(BUILD)/libselas_fortran.a $(BUILD)/whole/libselas.a $(LIBS) -fopenmp
	OMP_NUM_THREADS=1 $(BUILD)/test/overhead input/halfspace.nml 0.125 40 7

.PHONY: kills
kills: $(BUILD)/selas ## 200 runs killed at random times: each must go on to the same bits (some minutes)
	@regress/kills $(BUILD)

$(BUILD)/test/stability-%: regress/stability.d/%.c $(BUILD)/libselas.a
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(CC) $(ALL_C) -MMD -MP $(LDFLAGS) -o $@ $< $(BUILD)/libselas.a $(LIBS)

.PHONY: bench-sph instructions
bench-sph: $(BUILD)/selas $(BUILD)/test/bench ## what an evaluation of the SPH operators costs: table of doc/performance.md
	@sh regress/bench-sph $(BUILD)

instructions: $(BUILD)/selas ## instructions of three small scenes against those recorded (two minutes; installs valgrind)
	@sh regress/setup leaks
	@sh regress/instructions $(BUILD)

# Readers under libFuzzer with AddressSanitizer and UBSan: clang, in a folder of its own (doc/robustness.md).
SECONDS      ?= 30
SANITIZED     = -O1 -g -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=undefined
FUZZ_TARGETS  = $(patsubst regress/fuzz/%.c,$(BUILD)/fuzz/%,$(wildcard regress/fuzz/fuzz_*.c))
.PHONY: fuzz fuzz-build fuzz-replay check-sanitize check-valgrind check-threads coverage no-memory
fuzz: ## fuzz the readers of decks, tables, points, checkpoints and results, SECONDS=30 of CPU each (clang)
	@$(MAKE) --no-print-directory fuzz-build CC=clang BUILD=$(BUILD)/sanitized \
	    CFLAGS='$(SANITIZED) -fsanitize=fuzzer-no-link' LDFLAGS='-fsanitize=address,undefined'
	@regress/fuzz/run $(BUILD)/sanitized/fuzz $(SECONDS)

fuzz-build: $(FUZZ_TARGETS)

$(BUILD)/fuzz/fuzz_%: regress/fuzz/fuzz_%.c $(BUILD)/libselas.a
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(CC) $(ALL_C) -MMD -MP $(LDFLAGS) -fsanitize=fuzzer -o $@ $< $(BUILD)/libselas.a $(LIBS)

# The same targets on the inputs that are kept, with any compiler and no sanitizer
fuzz-replay: $(patsubst regress/fuzz/%.c,$(BUILD)/replay/%,$(wildcard regress/fuzz/fuzz_*.c))

$(BUILD)/replay/fuzz_%: regress/fuzz/fuzz_%.c regress/fuzz/replay.c $(BUILD)/libselas.a
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(CC) $(ALL_C) $(LDFLAGS) -o $@ $< regress/fuzz/replay.c $(BUILD)/libselas.a $(LIBS)

check-sanitize: ## all unit tests and short scripts under AddressSanitizer, UBSan and LeakSanitizer (half an hour)
	+@regress/sanitize $(BUILD)/asan

check-valgrind: ## all unit tests under valgrind (more than an hour; installs valgrind)
	@sh regress/setup leaks
	+@regress/valgrind $(BUILD)

check-threads: ## all unit tests under ThreadSanitizer (ten minutes; clang, libomp with Archer)
	+@regress/threads $(BUILD)/threads

no-memory: $(BUILD)/test/test_no_memory ## each allocation of small scenes fails in turn, all of them (some minutes)
	SELAS_NO_MEMORY_EVERY=1 $(BUILD)/test/test_no_memory

coverage: ## line coverage of src/ by all tests (gcov), per file in output/coverage.txt
	+@regress/coverage $(BUILD)/coverage

check-format: ## formatting (clang-format)
	clang-format --dry-run -Werror $$(git ls-files '*.c' '*.h')

check-tidy: ## clang-tidy
	printf '%s\n' $(SOURCES) $(PROGRAM) | xargs -P2 -n4 sh -c 'clang-tidy --quiet "$$@" -- $(filter-out -fopenmp,$(ALL_C)) \
	    -fopenmp -idirafter $(shell gcc -print-file-name=include) 2>/dev/null' tidy

check-cppcheck: ## cppcheck
	cppcheck --quiet --std=c11 --enable=warning,performance,portability --error-exitcode=1 --inline-suppr -Isrc -j2 src

# What hosts link. Only names that begin with selas_ are seen outside.
$(BUILD)/$(SONAME): $(OBJECTS)
	$(if $(V),,@echo "  link $@")
	@echo '{ global: selas_*; local: *; };' >$(BUILD)/selas.map
	$(Q)$(CC) -shared -fopenmp $(LDFLAGS) -Wl,-soname,$(SONAME) -Wl,--version-script=$(BUILD)/selas.map -Wl,--no-undefined -o $@ $^ $(LIBS)

$(BUILD)/whole/libselas.a: $(OBJECTS)
	@mkdir -p $(@D)
	@rm -f $@
	$(Q)ld -r -d -o $(@D)/selas.o $^
	$(Q)objcopy --wildcard --keep-global-symbol='selas_*' $(@D)/selas.o
	$(Q)ar rcs $@ $(@D)/selas.o

$(BUILD)/selas.o: src/selas.f90
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(FC) $(ALL_F) -J$(BUILD) -c -o $@ $<

$(BUILD)/selas77.o: src/selas77.f90 $(BUILD)/selas.o
	$(if $(V),,@echo "  compile $<")
	$(Q)$(FC) $(ALL_F) -J$(BUILD) -c -o $@ $<

$(BUILD)/libselas_fortran.a: $(BUILD)/selas.o $(BUILD)/selas77.o
	@rm -f $@
	$(Q)ar rcs $@ $^

# pkg-config files: selas for C, selas-fortran for the module (which needs selas).
$(BUILD)/selas.pc: Makefile src/selas.h
	@mkdir -p $(@D)
	@printf '%s\n' 'prefix=$(PREFIX)' 'libdir=$${prefix}/lib' 'includedir=$${prefix}/include' '' 'Name: selas' \
	    'Description: smoothed-point elastodynamics' 'Version: $(VERSION)' 'Requires.private: $(PKGS)' \
	    'Libs: -L$${libdir} -lselas' 'Libs.private: -fopenmp -lm' 'Cflags: -I$${includedir}' >$@
	@printf '%s\n' 'prefix=$(PREFIX)' 'libdir=$${prefix}/lib' 'includedir=$${prefix}/include' '' 'Name: selas-fortran' \
	    'Description: smoothed-point elastodynamics, Fortran module' 'Version: $(VERSION)' 'Requires: selas' \
	    'Libs: -L$${libdir} -lselas_fortran' 'Cflags: -I$${includedir}/selas' >$(BUILD)/selas-fortran.pc

install: all $(BUILD)/selas.pc ## install program, libraries, header, module and manual page below PREFIX (DESTDIR)
	install -D $(BUILD)/selas $(DESTDIR)$(PREFIX)/bin/selas
	install -D $(BUILD)/$(SONAME) $(DESTDIR)$(LIBDIR)/libselas.so.$(VERSION)
	ln -sf libselas.so.$(VERSION) $(DESTDIR)$(LIBDIR)/$(SONAME)
	ln -sf $(SONAME) $(DESTDIR)$(LIBDIR)/libselas.so
	install -D -m 644 $(BUILD)/whole/libselas.a $(DESTDIR)$(LIBDIR)/libselas.a
	install -D -m 644 $(BUILD)/libselas_fortran.a $(DESTDIR)$(LIBDIR)/libselas_fortran.a
	install -D -m 644 src/selas.h $(DESTDIR)$(INCLUDE)/selas.h
	install -D -m 644 $(BUILD)/selas.mod $(DESTDIR)$(INCLUDE)/selas/selas.mod
	install -D -m 644 src/selas.f90 $(DESTDIR)$(INCLUDE)/selas/selas.f90
	install -D -m 644 src/selas77.f90 $(DESTDIR)$(INCLUDE)/selas/selas77.f90
	sed 's|^prefix=.*|prefix=$(PREFIX)|' $(BUILD)/selas.pc >$(BUILD)/selas.pc.installed
	install -D -m 644 $(BUILD)/selas.pc.installed $(DESTDIR)$(LIBDIR)/pkgconfig/selas.pc
	sed 's|^prefix=.*|prefix=$(PREFIX)|' $(BUILD)/selas-fortran.pc >$(BUILD)/selas.pc.installed
	install -D -m 644 $(BUILD)/selas.pc.installed $(DESTDIR)$(LIBDIR)/pkgconfig/selas-fortran.pc
	install -D -m 644 doc/selas.1 $(DESTDIR)$(PREFIX)/share/man/man1/selas.1

uninstall: ## remove what install put there
	rm -f $(DESTDIR)$(PREFIX)/bin/selas $(DESTDIR)$(LIBDIR)/libselas.so $(DESTDIR)$(LIBDIR)/$(SONAME) \
	    $(DESTDIR)$(LIBDIR)/libselas.so.$(VERSION) $(DESTDIR)$(LIBDIR)/libselas.a $(DESTDIR)$(LIBDIR)/libselas_fortran.a \
	    $(DESTDIR)$(INCLUDE)/selas.h $(DESTDIR)$(INCLUDE)/selas/selas.mod $(DESTDIR)$(INCLUDE)/selas/selas.f90 \
	    $(DESTDIR)$(INCLUDE)/selas/selas77.f90 $(DESTDIR)$(LIBDIR)/pkgconfig/selas.pc \
	    $(DESTDIR)$(LIBDIR)/pkgconfig/selas-fortran.pc $(DESTDIR)$(PREFIX)/share/man/man1/selas.1
	-rmdir $(DESTDIR)$(INCLUDE)/selas 2>/dev/null

clean: ## remove build/
	rm -rf $(BUILD)

help: ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## (.*)/  make \1@\2/' | column -t -s@

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
