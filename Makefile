# Talus: campaigns of granular-flow simulations. `make help` lists the targets.

ifeq ($(origin CC),default)
CC := gcc
endif
PKGS := hdf5 yaml-0.1 libxxhash gsl
LOADED := lapacke # when it is asked for: linked, it would slow every start
BUILD ?= build
BIN ?= bin
LIB ?= libtalus.a
PREFIX ?= /usr/local
V ?= 0
Q := $(if $(filter 1,$(V)),,@)
WERROR ?= $(if $(CI),-Werror)
JOBS ?= $(shell nproc)
# A make inside make: as many jobs as there are cores, unless -j was given.
SUB = --no-print-directory $(if $(findstring -j,$(MAKEFLAGS)),,-j$(JOBS))

# Same bits everywhere: no contraction to fused multiply-add, no -ffast-math, plain x86-64.
# The two -fno- flags change no result: they let sqrt and selections compile to vector instructions.
OPT ?= -O3 -ffp-contract=off -fno-math-errno -fno-trapping-math
WARN := -Wall -Wextra -Wconversion -Wshadow -Wvla -Wstrict-prototypes -Wmissing-prototypes -Wpointer-arith
CFLAGS_ALL = -std=c11 -D_GNU_SOURCE -fopenmp -g $(OPT) $(WARN) $(WERROR) -Iinclude -Isrc $(PKG_CFLAGS) $(CFLAGS)
# Asked once, when first needed: targets that install the libraries run before they are there.
PKG_CFLAGS = $(eval PKG_CFLAGS := $(patsubst -I%,-isystem %,$(call pkg_config,--cflags,$(PKGS) $(LOADED))))$(PKG_CFLAGS)
PKG_LIBS = $(eval PKG_LIBS := -lhdf5_hl $(call pkg_config,--libs,$(PKGS)) -lm)$(PKG_LIBS)
pkg_config = $(if $(shell pkg-config --exists $2 2>/dev/null && echo yes),$(shell pkg-config $1 $2),$(error \
	missing libraries ($2): run `make deps`))

SOURCES := $(filter-out src/cli/main_%.c,$(wildcard src/*/*.c))
HEADERS := $(wildcard include/talus/*.h src/*/*.h)
OBJECTS := $(SOURCES:%.c=$(BUILD)/%.o)
PROGRAMS := $(BIN)/talus $(BIN)/talus-tables
TEST_SOURCES := $(wildcard tests/*/test_*.c)
TEST_PROGRAMS := $(TEST_SOURCES:%.c=$(BUILD)/%)
CLI_CASES := $(wildcard tests/cli/*.sh)
comma := ,
BENCHES := $(patsubst %.c,$(BUILD)/%,$(wildcard tests/bench/bench_*.c))
EXPERIMENTS := $(patsubst experiments/%.yaml,%,$(wildcard experiments/*.yaml))
C_FILES := $(wildcard src/*/*.c tests/*/*.c)
# The tests whose path contains a word of TESTS; all without it.
SELECTED = $(if $(TESTS),$(sort $(foreach word,$(TESTS),$(foreach test,$1,$(if $(findstring $(word),$(test)),$(test))))),$1)

.DEFAULT_GOAL := all
.PHONY: all lib programs deps quickstart check test asan ubsan widths valgrind coverage clang tidy format \
	format-check symbols bench soak faults-long fuzz slurm-check tables figures paper install clean distclean \
	help $(EXPERIMENTS)
.SECONDARY:
.DELETE_ON_ERROR:

## all: bin/talus, bin/talus-tables and libtalus.a
all: $(PROGRAMS) $(LIB)
	@:

## lib: libtalus.a alone
lib: $(LIB)

## programs: all, and the programs of tests and benches
programs: all $(TEST_PROGRAMS) $(BENCHES)
	@:

$(BUILD)/%.o: %.c $(BUILD)/flags
	@mkdir -p $(@D)
	@echo "CC $<"
	$(Q)$(CC) $(CFLAGS_ALL) $(DEFINES) -MMD -MP -c -o $@ $<

# Objects depend on the command line that made them.
$(BUILD)/flags: FORCE
	@mkdir -p $(@D)
	@echo '$(CC) $(CFLAGS_ALL)' | cmp -s - $@ || echo '$(CC) $(CFLAGS_ALL)' > $@
.PHONY: FORCE

# What a run file says about its build. Only this object is made again when the revision changes.
$(BUILD)/src/base/build.o: private DEFINES = -DTALUS_REVISION='"$(REVISION)"' -DTALUS_FLAGS='"$(strip $(OPT) $(CFLAGS))"'
$(BUILD)/src/base/build.o: $(BUILD)/revision
# what `make paper` writes into results/ does not make the program another
REVISION = $(eval REVISION := $(shell git describe --always --abbrev=12 2>/dev/null || echo unknown)$(shell \
	git diff --quiet HEAD -- . ':!results' 2>/dev/null; [ $$? != 1 ] || echo -dirty))$(REVISION)
$(BUILD)/revision: FORCE
	@mkdir -p $(@D)
	@echo '$(REVISION)' | cmp -s - $@ || echo '$(REVISION)' > $@

$(LIB): $(OBJECTS)
	@mkdir -p $(@D)
	@echo "AR $@"
	$(Q)rm -f $@ && ar rcs $@ $^

$(BIN)/talus: $(BUILD)/src/cli/main_talus.o $(LIB)
	@mkdir -p $(@D)
	@echo "LD $@"
	$(Q)$(CC) -fopenmp $(OPT) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(PKG_LIBS)

$(BIN)/talus-tables: $(BUILD)/src/cli/main_talus_tables.o $(LIB)
	@mkdir -p $(@D)
	@echo "LD $@"
	$(Q)$(CC) -fopenmp $(OPT) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(PKG_LIBS)

$(BUILD)/tests/%: $(BUILD)/tests/%.o $(LIB)
	@echo "LD $@"
	$(Q)$(CC) -fopenmp $(OPT) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(call pkg_config,--libs,cmocka) $(PKG_LIBS)

# To be preloaded by tests; plain C, whatever the build is.
$(BUILD)/tests/%.so: tests/%.c
	@mkdir -p $(@D)
	@echo "LD $@"
	$(Q)$(CC) -std=c11 -D_GNU_SOURCE -O1 $(WARN) -fPIC -shared -o $@ $< -ldl
$(BUILD)/tests/faults/fail_alloc.so: tests/faults/fail_alloc.h

# The program with the allocations of our own code going through the test's.
$(BUILD)/tests/faults/talus-failing: $(BUILD)/src/cli/main_talus.o $(BUILD)/tests/faults/fail_alloc_linked.o $(LIB)
	@echo "LD $@"
	$(Q)$(CC) -fopenmp $(OPT) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(PKG_LIBS) $(patsubst %,-Wl$(comma)--wrap=%,\
		malloc calloc realloc strdup strndup asprintf tsearch scandir)
$(BUILD)/tests/faults/test_allocations: | $(BUILD)/tests/faults/fail_alloc.so $(BUILD)/tests/faults/talus-failing

# Packages first, then everything that asks about them in a make of its own.

## deps: install the Debian packages that building and testing need, where missing
deps:
	@scripts/deps build check

## quickstart: install what is missing, build, run a small campaign and print its table
quickstart: CAMPAIGN_FLAGS = -j $(JOBS)
quickstart $(filter-out quickstart,$(EXPERIMENTS)):
	@scripts/deps build $(if $(shell grep -s '^plots:' experiments/$@.yaml),plot)
	$(Q)$(MAKE) $(SUB) all
	$(Q)failed=0; $(BIN)/talus campaign run experiments/$@.yaml $(CAMPAIGN_FLAGS) || failed=$$?; \
	[ $$failed -le 1 ] && \
	{ ! grep -q '^tables:' experiments/$@.yaml || $(BIN)/talus-tables experiments/$@.yaml; } && \
	{ ! grep -q '^plots:' experiments/$@.yaml || $(BIN)/talus plot experiments/$@.yaml; } && \
	echo "run files: results/$@/*/run.h5" && exit $$failed

## tables: every experiment that has tables: run what is not finished, print the tables (and draw its plots)
## figures: every experiment that has plots: run what is not finished, draw the figures
tables figures:
	$(Q)for name in $(patsubst experiments/%.yaml,%,$(shell \
		grep -ls '^$(if $(filter figures,$@),plots,tables):' experiments/*.yaml)); do \
		$(MAKE) $(SUB) $$name || exit; done

# What results/paper/ holds; its README.md walks through it.
PAPER := $(filter-out quickstart observations-example solvers,$(EXPERIMENTS))

## paper: make the tables and figures in results/paper/ again (PAPER=names of experiments)
paper:
	@scripts/deps build plot
	$(Q)$(MAKE) $(SUB) all
	$(Q)for name in $(PAPER); do \
		file=experiments/$$name.yaml; \
		$(BIN)/talus campaign run $$file $(CAMPAIGN_FLAGS) || exit; \
		! grep -q '^tables:' $$file || $(BIN)/talus-tables -f markdown $$file >results/paper/$$name.md || exit; \
		! grep -q '^plots:' $$file || $(BIN)/talus plot -f png -o results/paper $$file || exit; done

## check: install what is missing, build and run every test (TESTS=word: those with the word in the path)
check:
	@scripts/deps build check
	$(Q)$(MAKE) $(SUB) test

## test: check without installing anything
test: programs
	$(Q)BIN=$(BIN) tests/run-all -j $(JOBS) $(TEST_FLAGS) $(call SELECTED,$(TEST_PROGRAMS) $(CLI_CASES))


# Builds of another kind live in folders of their own: $(call variant,NAME,GOAL,FLAGS).
variant = $(MAKE) $(SUB) $2 BUILD=$(BUILD)/$1 BIN=$(BUILD)/$1/bin LIB=$(BUILD)/$1/libtalus.a \
	CFLAGS='$(CFLAGS) $3' TEST_FLAGS='-l $1'
sanitized = SANITIZER=$@ TEST_TIMEOUT=600 $(call variant,$@,test,-fno-omit-frame-pointer $1) \
	OPT='-O1 $(filter-out -O%,$(OPT))'

## asan: every test under the address and leak sanitizers
asan:
	@scripts/deps build check
	+$(Q)ASAN_OPTIONS=exitcode=99:detect_leaks=1:verify_asan_link_order=0 \
		$(call sanitized,-fsanitize=address)

## ubsan: every test under the undefined-behaviour sanitizer
ubsan:
	@scripts/deps build check
	+$(Q)UBSAN_OPTIONS=exitcode=99:print_stacktrace=1 \
		$(call sanitized,-fsanitize=undefined -fno-sanitize-recover=all)

## widths: runs have the same bits with vectors of every width that this machine has, and with threads
WIDTHS = x86-64 x86-64-v3 $(if $(shell grep -m 1 -w avx512vl /proc/cpuinfo),x86-64-v4)
widths:
	@scripts/deps build
	$(Q)$(MAKE) $(SUB) all
	+$(Q)$(foreach width,$(WIDTHS),$(call variant,$(width),all,-DTALUS_PLAIN_KERNELS -march=$(width)) &&) true
	$(Q)TALUS_ROOT=$(CURDIR) PATH=$(abspath $(BIN)):$$PATH tests/widths/widths.sh \
		$(WIDTHS:%=$(abspath $(BUILD))/%/bin/talus)

## valgrind: the unit tests under valgrind
valgrind:
	@scripts/deps build check valgrind
	$(Q)TEST_TIMEOUT=1800 $(MAKE) $(SUB) test CLI_CASES= TEST_FLAGS='-l valgrind \
		-w "valgrind -q --error-exitcode=99 --leak-check=full --errors-for-leak-kinds=definite"'

## coverage: lines and branches of src/ that the tests reach
coverage:
	@scripts/deps build check coverage
	+$(Q)find $(BUILD)/coverage -name '*.gcda' -delete 2>/dev/null; \
		$(call variant,coverage,test,--coverage) OPT='-O0 $(filter-out -O%,$(OPT))'
	$(Q)gcovr --root . --filter src/ --print-summary $(BUILD)/coverage

## clang: everything built with clang, warnings as errors
clang:
	@scripts/deps build check clang
	+$(Q)$(call variant,clang,programs) CC=clang WERROR=-Werror

## tidy: clang-tidy on every source that changed since it last passed
tidy:
	@scripts/deps build check tidy
	$(Q)$(MAKE) $(SUB) -k $(C_FILES:%.c=$(BUILD)/tidy/%.log)

$(BUILD)/tidy/%.log: %.c $(HEADERS) .clang-tidy
	@mkdir -p $(@D)
	@echo "TIDY $<"
	$(Q)clang-tidy --quiet $< -- $(CFLAGS_ALL) > $@ 2>&1 || { cat $@; exit 1; }

## format: clang-format on every source
format:
	@scripts/deps format
	$(Q)clang-format -i $(C_FILES) $(HEADERS) $(wildcard tests/*/*.h)

## format-check: fail where `make format` would change something
format-check:
	@scripts/deps format
	$(Q)clang-format --dry-run -Werror $(C_FILES) $(HEADERS) $(wildcard tests/*/*.h)

## symbols: every name that a source exports begins with the noun of its file, its folder or a header there
symbols: $(OBJECTS)
	$(Q)nm -A -g --defined-only $^ | awk -v headers='$(HEADERS)' ' \
		function noun(name) { sub(/[_.].*/, "", name); return name } \
		function alike(a, b) { return index(a, b) == 1 || index(b, a) == 1 } \
		BEGIN { \
			for (i = split(headers, header, " "); i > 0; i--) { \
				n = split(header[i], part, "/"); known[part[n - 1] "/" noun(part[n])] } } \
		{ n = split($$1, part, "/"); file = noun(part[n]); folder = part[n - 1]; mine = noun($$3) } \
		!(alike(file, mine) || alike(folder, mine) || folder == "cli" && mine == "command" || \
			(folder "/" mine) in known || ("talus/" mine) in known) { \
			bad = 1; sub(/\.o:.*/, ".c", part[n]); print "src/" folder "/" part[n] ": " $$3 } \
		END { exit bad }'

## bench: time of a checkpoint, and the pressure solvers compared into results/paper/solvers.md
bench:
	@scripts/deps build check
	$(Q)$(MAKE) $(SUB) programs
	$(Q)mkdir -p $(BUILD)/bench && cd $(BUILD)/bench && \
		export TALUS_ROOT=$(CURDIR) PATH=$(abspath $(BIN)):$(abspath $(BUILD)/tests/bench):$$PATH && \
		for bench in $(abspath $(BENCHES)) $(abspath $(wildcard tests/bench/*.sh)); do $$bench || exit; done

## soak: 1,000 kills over a campaign, and the same bits at its end (SOAK=count); then crowds of commands
SOAK ?= 1000
soak:
	@scripts/deps build check
	$(Q)$(MAKE) $(SUB) all
	$(Q)export TALUS_ROOT=$(CURDIR) PATH=$(abspath $(BIN)):$$PATH; tests/soak/soak.sh $(SOAK) && \
		tests/soak/crowd.sh 2 $$(($(SOAK) / 20)) && tests/soak/crowd.sh 8 $$(($(SOAK) / 20))

## faults-long: every allocation of every command fails once (hours; `make check` tries some of each)
faults-long: FAILING = $(abspath $(BUILD))/tests/faults/test_allocations
faults-long:
	@scripts/deps build check
	$(Q)$(MAKE) $(SUB) programs
	$(Q)$(FAILING) list | PATH=$(abspath $(BIN)):$$PATH xargs -P $(JOBS) -L 1 env TALUS_EVERY_ALLOCATION=1

FUZZ_SECONDS ?= 60
FUZZ_TARGETS := config experiment run_file
fuzzed = $(call variant,$1,lib,$3) CC=$2 OPT='-O1 -ffp-contract=off' WERROR= && for name in $(FUZZ_TARGETS); do \
	$2 $(CFLAGS_ALL) $3 $4 -DTARGET=fuzz_$$name -o $(BUILD)/$1/fuzz_$$name tests/fuzz/fuzz.c \
		$(BUILD)/$1/libtalus.a $(PKG_LIBS) || exit; done

## fuzz: libFuzzer and AFL++ on configs, experiments and run files (FUZZ_SECONDS=60 for each)
fuzz:
	@scripts/deps build fuzz
	+$(Q)$(call fuzzed,libfuzzer,clang,-fsanitize=fuzzer-no-link$(comma)address$(comma)undefined,-fsanitize=fuzzer)
	+$(Q)$(call fuzzed,afl,afl-clang-fast,,-fsanitize=fuzzer)
	$(Q)tests/fuzz/fuzz.sh $(BUILD) $(FUZZ_SECONDS) $(FUZZ_TARGETS)

## slurm-check: campaigns on a real Slurm, started and stopped by the test
slurm-check:
	@scripts/deps build check slurm
	$(Q)$(MAKE) $(SUB) all
	$(Q)PATH=$(abspath $(BIN)):$$PATH tests/slurm/slurm.sh

## install: programs, library and headers below PREFIX (/usr/local)
install: all
	install -d $(DESTDIR)$(PREFIX)/bin $(DESTDIR)$(PREFIX)/lib $(DESTDIR)$(PREFIX)/include/talus
	install $(PROGRAMS) $(DESTDIR)$(PREFIX)/bin
	install -m 644 $(LIB) $(DESTDIR)$(PREFIX)/lib
	install -m 644 include/talus/*.h $(DESTDIR)$(PREFIX)/include/talus

## clean: remove what the build made
clean:
	rm -rf $(BUILD) $(BIN) $(LIB)

## distclean: clean, and remove what tools left behind; results stay
distclean: clean
	rm -rf compile_commands.json .cache

## help: this list
help:
	@sed -n 's/^## \([a-z0-9-]*\): /\1\t/p' $(firstword $(MAKEFILE_LIST)) | \
		awk -F '\t' '{ printf "  %-20s %s\n", $$1, $$2 }'
	@echo; echo "An experiment runs by its name, which finishes what is not finished, prints its tables and draws its plots:"
	@for name in $(EXPERIMENTS); do \
		printf '  %-20s %s\n' $$name "$$(sed -n 's/^title: *//p' experiments/$$name.yaml)"; done
	@echo; echo "Variables: V=1 shows commands, CC, CFLAGS, OPT, BUILD, BIN, LIB, PREFIX, JOBS, CAMPAIGN_FLAGS"

-include $(OBJECTS:.o=.d) $(TEST_PROGRAMS:=.d) $(BENCHES:=.d)
-include $(BUILD)/src/cli/main_talus.d $(BUILD)/src/cli/main_talus_tables.d
