# What those call who develop selas: tests, checks and studies. Included by the Makefile; `make help-checks` lists it.

# Every C program of this folder is one file, linked with the library: NAME.c in one of these folders gives $(BUILD)/test/NAME
# (and a target of the fuzzing $(BUILD)/fuzz/NAME and $(BUILD)/replay/NAME).
vpath %.c regress/unit regress/hardening/relations regress/hardening/stops regress/hardening/fuzz regress/studies/bench \
    regress/studies/canyon regress/studies/lamb regress/studies/quiet regress/studies/stability
TESTS    = $(patsubst regress/unit/%.c,$(BUILD)/test/%,$(wildcard regress/unit/test_*.c))
FUZZED   = $(patsubst regress/hardening/fuzz/%.c,%,$(wildcard regress/hardening/fuzz/fuzz_*.c))

# EXTRA: further options; EXTRA_LIBS: further libraries. The compiler tells on which headers a program of one source depends;
# those of several are made anew with any header of their folder.
define program
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(CC) $(ALL_C) -Iregress/unit $(EXTRA) $(if $(word 2,$(filter %.c,$^)),,-MMD -MP) $(LDFLAGS) -o $@ $(filter %.c,$^) $(filter %.o %.a,$^) $(LIBS) $(EXTRA_LIBS)
endef
$(BUILD)/test/%: %.c $(BUILD)/libselas.a
	$(program)
$(BUILD)/fuzz/%: %.c $(BUILD)/libselas.a
	$(program)
$(BUILD)/replay/%: %.c regress/hardening/fuzz/replay.c $(BUILD)/libselas.a
	$(program)

$(TESTS): private EXTRA_LIBS = -lcmocka
# The bench's own loops are compiled as kernels are
$(BUILD)/test/bench: $(KINDS:%=$(BUILD)/obj/%/peak.o)
$(BUILD)/obj/%/peak.o: peak.c
	$(compile)
$(FUZZED:%=$(BUILD)/fuzz/%): private EXTRA = -fsanitize=fuzzer
$(FUZZED:%=$(BUILD)/replay/%): $(wildcard regress/hardening/fuzz/*.h)
# The closed form of the half-space shares nothing with the library's
$(patsubst %,$(BUILD)/test/%,test_lamb test_lamb_fast test_lamb_horizontal lamb_grid): regress/unit/lamb_closed.c \
    regress/unit/lamb_closed_history.c $(wildcard regress/unit/*.h)
# The library's ways to memory go through regress/unit/allocation.c, where they can fail
WRAPPED  = malloc calloc realloc free aligned_alloc strdup strndup open_memstream fftw_malloc fftw_alloc_real \
           fftw_alloc_complex fftw_free
$(BUILD)/test/test_no_memory: regress/unit/allocation.c $(wildcard regress/unit/*.h)
$(BUILD)/test/test_no_memory: private EXTRA = -fno-builtin $(WRAPPED:%=-Wl,--wrap=%)

# The program with what regress/examples/ adds: its files, and its lines in the lists of src/deck/choices.h. What makes tables
# of these lists is compiled anew; all else comes from the library.
EXAMPLES = $(BUILD)/examples
TABLES   = $(shell grep -rlwE 'METHODS|SCHEMES|EXACT_SOLUTIONS|KERNELS' src --include='*.c')
ADDED    = $(TABLES:src/%.c=$(EXAMPLES)/%.o) $(patsubst regress/examples/%.c,$(EXAMPLES)/%.o,$(wildcard regress/examples/*.c))
$(ADDED): private ALL_C := -I$(EXAMPLES)/src $(ALL_C)
$(ADDED): $(EXAMPLES)/src/deck/choices.h
$(EXAMPLES)/src/deck/choices.h: regress/examples/choices.awk regress/examples/lines src/deck/choices.h
	@mkdir -p $(@D)
	@awk -f $^ >$@
$(EXAMPLES)/%.o: src/%.c
	$(compile)
$(EXAMPLES)/%.o: regress/examples/%.c
	$(compile)
$(EXAMPLES)/selas: $(ADDED) $(PROGRAM:src/%.c=$(BUILD)/obj/%.o) $(BUILD)/libselas.a
	$(link)
$(EXAMPLES)/test_kernel: regress/unit/test_kernel.c $(ADDED) $(BUILD)/libselas.a
	$(Q)$(CC) $(ALL_C) -Iregress/unit $(LDFLAGS) -o $@ $^ $(LIBS) -lcmocka

# Scripts that call make begin a make of their own, with as many jobs as this one.
ALONE    = env -u MFLAGS -u MAKELEVEL MAKEFLAGS='$(filter -j%,$(MAKEFLAGS))'

.PHONY: help-checks unit
help-checks: ## this list
	$(call listed,regress/rules.mk)

unit: all $(TESTS) $(BUILD)/examples/selas $(BUILD)/examples/test_kernel $(BUILD)/test/relations $(BUILD)/test/decks fuzz-replay ## run all tests without the set-up
	@$(ALONE) sh regress/run-tests $(BUILD)

.PHONY: test-mpi cases-mpi
$(BUILD)/mpi/blocks: regress/parallel/blocks.c $(BUILD)/mpi/libselas-mpi.a
	$(program)
$(BUILD)/mpi/blocks: private override CC = $(MPICC)
$(BUILD)/mpi/blocks: private PKGS := gsl fftw3 $(MPI_HDF5)
test-mpi: mpi $(BUILD)/mpi/blocks ## small scenes on 1, 2, 3, 4 and 7 ranks against one process: doc/howto/ranks.md (a minute or two)
	@$(ALONE) regress/parallel/check $(BUILD)

cases-mpi: mpi ## all cases on 1, 2, 3, 4 and 7 ranks against one process (an hour)
	@$(ALONE) regress/parallel/cases $(BUILD) '1 2 3 4 7'

# Static checks

.PHONY: check-format check-tidy check-cppcheck
check-format: ## formatting (clang-format)
	clang-format --dry-run -Werror $$(git ls-files '*.c' '*.h')

NODES ?= 75000
check-tidy: ## clang-tidy; as many states of a function as NODES (clang's own 225000 take three times as long)
	printf '%s\n' $(SOURCES) $(PROGRAM) | xargs -P$$(nproc) -n4 sh -c 'clang-tidy --quiet "$$@" -- $(filter-out -fopenmp,$(ALL_C)) \
	    -fopenmp -idirafter $(shell gcc -print-file-name=include) -Xclang -analyzer-config -Xclang max-nodes=$(NODES) 2>/dev/null' tidy

BUILT := -D__GNUC__=12 -D__x86_64__ -D__SSE2__ -DH5_HAVE_PARALLEL
check-cppcheck: ## cppcheck of what is built, not of all that its conditions allow
	cppcheck --quiet --std=c11 --enable=warning,performance,portability --error-exitcode=1 --inline-suppr -Isrc $(BUILT) \
	    -j$$(nproc) src

# The nightly regression and its parts

.PHONY: faults regress-compilers verification same-bits
faults: $(BUILD)/selas ## plant faults in a copy of the source and count that the regression finds each
	@$(ALONE) regress/hardening/faults/run $(BUILD)

regress-compilers: ## one baseline for gcc and clang, -O2 and -O3, 1 and 2 threads (builds four programs)
	@$(ALONE) regress/hardening/compilers

verification: ## write doc/verification/verification.md anew from the cases and their recorded errors
	@regress/studies/verification

same-bits: $(BUILD)/selas ## all results of all cases bit for bit those of the program OLD=...
	@regress/nightly/same-bits "$(OLD)" $(BUILD)/selas

# Hardening

.PHONY: relations stops kills instructions coverage no-memory check-sanitize check-sanitize-mpi check-valgrind check-leaks check-threads fuzz fuzz-build fuzz-replay
relations: $(BUILD)/test/relations ## what every run keeps, on scenes drawn by chance (minutes): doc/developers/robustness.md
	@regress/hardening/relations/run $(BUILD) 1 100

stops: $(BUILD)/test/stops ## restarts from random steps with two threads and one, all methods (minutes): doc/howto/long-runs.md
	@sh regress/hardening/stops/run $(BUILD)

kills: $(BUILD)/selas ## 200 runs killed at random times: each must go on to the same bits (some minutes)
	@regress/hardening/kills $(BUILD)

instructions: $(BUILD)/selas ## instructions of small scenes, kernels for x86-64-v3, against those recorded (some minutes; installs valgrind)
	@sh regress/setup leaks
	@sh regress/hardening/instructions/run $(BUILD)

coverage: ## line coverage of src/ by all tests (gcov), per file in output/coverage.txt
	@$(ALONE) regress/hardening/coverage $(BUILD)/coverage

no-memory: $(BUILD)/test/test_no_memory ## each allocation of small scenes fails in turn, all of them (some minutes)
	SELAS_NO_MEMORY_EVERY=1 $(BUILD)/test/test_no_memory

check-sanitize: ## all unit tests and short scripts under AddressSanitizer, UBSan and LeakSanitizer (half an hour)
	@$(ALONE) regress/hardening/sanitize $(BUILD)/asan

check-sanitize-mpi: ## what test-mpi runs under the same (an hour)
	@$(ALONE) regress/hardening/sanitize-ranks $(BUILD)/asan

check-valgrind: ## all unit tests under valgrind (more than an hour; installs valgrind)
	@sh regress/setup leaks
	@$(ALONE) regress/hardening/valgrind $(BUILD)

check-leaks: ## wrong calls and checkpoints under valgrind (two minutes; installs valgrind)
	@sh regress/setup leaks
	@$(ALONE) regress/hardening/valgrind $(BUILD) test_api_wrong test_api_checkpoint

check-threads: ## all unit tests under ThreadSanitizer (ten minutes; clang, libomp with Archer)
	@$(ALONE) regress/hardening/threads $(BUILD)/threads

# Readers under libFuzzer with AddressSanitizer and UBSan (kernels of one kind without): clang, in a folder of its own
# (doc/developers/robustness.md)
SECONDS     ?= 30
SANITIZED    = -O1 -g -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=undefined
fuzz: ## fuzz the readers of decks, tables, points, checkpoints and results, SECONDS=30 of CPU each (clang)
	@$(MAKE) --no-print-directory fuzz-build CC=clang KINDS=plain KERNEL_FLAGS='-O0 -fno-sanitize=all' BUILD=$(BUILD)/sanitized \
	    CFLAGS='$(SANITIZED) -fsanitize=fuzzer-no-link' LDFLAGS='-fsanitize=address,undefined'
	@regress/hardening/fuzz/run $(BUILD)/sanitized/fuzz $(SECONDS)

fuzz-build: $(FUZZED:%=$(BUILD)/fuzz/%)

fuzz-replay: $(FUZZED:%=$(BUILD)/replay/%) # on the inputs that are kept, with any compiler and no sanitizer

# Studies: tables and figures of the manual

.PHONY: absorption damping quiet paper-figures sph-figures gallery consistent-tables tables stability accuracy bench bench-all bench-sph bench-host lamb-check
absorption: $(BUILD)/selas ## table of doc/verification/tables/absorbing.txt: what comes back from transmitting faces
	@sh regress/studies/absorption $(BUILD)

damping: $(BUILD)/selas ## error against mechanisms and Q: table and plot of doc/theory/damping.md (a minute)
	@sh regress/studies/damping $(BUILD)

quiet: $(BUILD)/test/quiet ## energy beside absorbing faces to t = 1000 (twenty minutes): doc/theory/absorbing-faces.md
	@sh regress/studies/quiet/run $(BUILD)

paper-figures: $(BUILD)/selas ## Figs 2-5 of Ding et al. (2006) with their errors, in output/paper-figures/
	@sh regress/studies/paper-figures $(BUILD)

sph-figures: $(BUILD)/selas ## Figs 4-13 and 15-19 of He & Seaid (2016), in output/sph-figures/ (about a minute)
	@sh regress/studies/sph-figures/run $(BUILD)

gallery: $(BUILD)/selas ## a picture of each kind of scene: doc/gallery.md
	@sh regress/studies/gallery $(BUILD)

consistent-tables: $(BUILD)/selas $(BUILD)/test/test_dispersion ## errors of the consistent method beside those wanted: doc/verification/tables/consistent-tables.txt
	@sh regress/studies/consistent-tables $(BUILD)

tables: ## rerun Tables 1-4 of He & Seaid (2016) into bar.txt, beam.txt, plate.txt of doc/verification/tables (some 20 minutes; installs calculix-ccx)
	@sh regress/setup tables
	@$(MAKE) --no-print-directory all
	@regress/studies/tables/run $(BUILD)

stability: $(BUILD)/selas $(BUILD)/test/stability-energy $(BUILD)/test/stability-spectrum ## hard cases, sweeps and plots: doc/verification/tables/stability.txt (minutes)
	@sh regress/studies/stability/run $(BUILD)

accuracy: $(BUILD)/selas ## speed against error: tables and plots of doc/verification/accuracy.md (some 20 minutes)
	@sh regress/studies/accuracy/run $(BUILD)

bench: $(BUILD)/selas $(BUILD)/test/bench $(BUILD)/test/bench_layers ## speed beside the machine's own, under a minute: output/bench/
	@sh regress/studies/bench/run $(BUILD)

bench-all: $(BUILD)/selas $(BUILD)/test/bench $(BUILD)/test/bench_layers ## the same with large lattices: doc/developers/performance.md (some minutes, 12 GB)
	@sh regress/studies/bench/run $(BUILD) all

bench-sph: $(BUILD)/selas $(BUILD)/test/bench ## what an evaluation of the SPH operators costs: table of doc/developers/performance-sph.md
	@for kind in $$($(BUILD)/test/bench kinds); do SELAS_PROCESSOR=$$kind sh regress/studies/bench/sph $(BUILD) && echo || exit 1; done

bench-host: all ## what stepping one step at a time from Fortran costs on input/halfspace-lysmer.nml
	@mkdir -p $(BUILD)/test
	$(Q)$(FC) $(ALL_F) -I$(BUILD) -o $(BUILD)/test/overhead regress/hosts/overhead.f90 $(BUILD)/libselas_fortran.a $(BUILD)/whole/libselas.a $(LIBS) -fopenmp
	OMP_NUM_THREADS=1 $(BUILD)/test/overhead input/halfspace-lysmer.nml 0.125 40 7

lamb-check: $(BUILD)/test/lamb_grid ## hold the half-space's FFT against its closed form: ten receivers, four Poisson ratios
	$(BUILD)/test/lamb_grid
