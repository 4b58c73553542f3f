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

SOURCES  = $(filter-out src/program/%,$(wildcard src/*.c src/*/*.c))
OBJECTS  = $(SOURCES:src/%.c=$(BUILD)/obj/%.o)
PROGRAM  = $(wildcard src/program/*.c)
TESTS    = $(patsubst regress/unit/%.c,$(BUILD)/test/%,$(wildcard regress/unit/test_*.c))

.DEFAULT_GOAL := all
.PHONY: all setup halfspace paper-figures test unit check-format check-tidy check-cppcheck install clean help

all: $(BUILD)/selas ## build the program build/selas and the library

setup: ## install what is missing with apt (root or sudo)
	@sh regress/setup

halfspace: setup ## set up, build, run input/halfspace.nml and leave its plots in output/halfspace/
	@$(MAKE) --no-print-directory all
	$(BUILD)/selas input/halfspace.nml
	@ls output/halfspace

paper-figures: $(BUILD)/selas ## Figs 2-5 of Ding et al. (2006) with their errors, in output/paper-figures/
	@sh regress/paper-figures $(BUILD)

test: setup ## set up, build and run all tests
	@$(MAKE) --no-print-directory unit

unit: $(BUILD)/selas $(TESTS) ## run the tests without the set-up
	@sh regress/run-tests $(BUILD)

$(BUILD)/selas: $(PROGRAM:src/%.c=$(BUILD)/obj/%.o) $(BUILD)/libselas.a
	$(if $(V),,@echo "  link $@")
	$(Q)$(CC) -fopenmp $(LDFLAGS) -o $@ $^ $(LIBS)

$(BUILD)/libselas.a: $(OBJECTS)
	@rm -f $@
	$(Q)ar rcs $@ $^

$(BUILD)/obj/record/provenance.o: ALL_C += -DSELAS_FLAGS='"$(subst ",,$(CFLAGS))"'

$(BUILD)/obj/%.o: src/%.c
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(CC) $(ALL_C) -MMD -MP -c -o $@ $<

$(BUILD)/test/%: regress/unit/%.c $(BUILD)/libselas.a
	@mkdir -p $(@D)
	$(if $(V),,@echo "  compile $<")
	$(Q)$(CC) $(ALL_C) -Iregress/unit -MMD -MP $(LDFLAGS) -o $@ $< $(BUILD)/libselas.a $(LIBS) -lcmocka

check-format: ## formatting (clang-format)
	clang-format --dry-run -Werror $$(git ls-files '*.c' '*.h')

check-tidy: ## clang-tidy
	printf '%s\n' $(SOURCES) $(PROGRAM) | xargs -P2 -n4 sh -c 'clang-tidy --quiet "$$@" -- $(filter-out -fopenmp,$(ALL_C)) \
	    -fopenmp -idirafter $(shell gcc -print-file-name=include) 2>/dev/null' tidy

check-cppcheck: ## cppcheck
	cppcheck --quiet --std=c11 --enable=warning,performance,portability --error-exitcode=1 --inline-suppr -Isrc -j2 src

install: all ## install the program, the library and the header below PREFIX
	install -D $(BUILD)/selas $(DESTDIR)$(PREFIX)/bin/selas
	install -D -m 644 $(BUILD)/libselas.a $(DESTDIR)$(PREFIX)/lib/libselas.a
	install -D -m 644 src/selas.h $(DESTDIR)$(PREFIX)/include/selas.h

clean: ## remove build/
	rm -rf $(BUILD)

help: ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## (.*)/  make \1@\2/' | column -t -s@

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
