# Talus: campaigns of granular-flow simulations. `make help` lists the targets.

CC ?= gcc
PKGS := hdf5 yaml-0.1 libxxhash
BUILD ?= build
BIN ?= bin
LIB ?= libtalus.a
V ?= 0
Q := $(if $(filter 1,$(V)),,@)
WERROR ?= $(if $(CI),-Werror)

# Same bits everywhere: no contraction to fused multiply-add, no -ffast-math, plain x86-64.
# The two -fno- flags change no result: they let sqrt and selections compile to vector instructions.
OPT ?= -O3 -ffp-contract=off -fno-math-errno -fno-trapping-math
WARN := -Wall -Wextra -Wconversion -Wshadow -Wvla -Wstrict-prototypes -Wmissing-prototypes -Wpointer-arith
CFLAGS_ALL = -std=c11 -D_GNU_SOURCE -g $(OPT) $(WARN) $(WERROR) -Iinclude -Isrc $(PKG_CFLAGS) $(CFLAGS)
PKG_CFLAGS = $(shell pkg-config --cflags $(PKGS) | sed 's/-I/-isystem /g')
PKG_LIBS = -lhdf5_hl $(shell pkg-config --libs $(PKGS)) -lm

SOURCES := $(filter-out src/cli/main_%.c,$(wildcard src/*/*.c))
HEADERS := $(wildcard include/talus/*.h src/*/*.h)
OBJECTS := $(SOURCES:%.c=$(BUILD)/%.o)
PROGRAMS := $(BIN)/talus $(BIN)/talus-tables
TEST_SOURCES := $(wildcard tests/*/test_*.c)
TESTS := $(TEST_SOURCES:%.c=$(BUILD)/%)

.DEFAULT_GOAL := all
.PHONY: all lib
.SECONDARY:
.DELETE_ON_ERROR:

## all: bin/talus, bin/talus-tables and libtalus.a
all: $(PROGRAMS) $(LIB)

lib: $(LIB)

$(BUILD)/%.o: %.c $(BUILD)/flags
	@mkdir -p $(@D)
	@echo "CC $<"
	$(Q)$(CC) $(CFLAGS_ALL) -MMD -MP -c -o $@ $<

# Objects depend on the command line that made them.
$(BUILD)/flags: FORCE
	@mkdir -p $(@D)
	@echo '$(CC) $(CFLAGS_ALL)' | cmp -s - $@ || echo '$(CC) $(CFLAGS_ALL)' > $@
FORCE:

# What `talus --version` and every run file say of the build.
REVISION := $(shell git describe --always --dirty --abbrev=12 2>/dev/null || echo unknown)
$(BUILD)/src/base/build.o: private CFLAGS_ALL += -DTALUS_REVISION='"$(REVISION)"' -DTALUS_FLAGS='"$(strip $(OPT) $(CFLAGS))"'
$(BUILD)/src/base/build.o: $(BUILD)/revision
$(BUILD)/revision: FORCE
	@mkdir -p $(@D)
	@echo '$(REVISION)' | cmp -s - $@ || echo '$(REVISION)' > $@

$(LIB): $(OBJECTS)
	@echo "AR $@"
	$(Q)rm -f $@ && ar rcs $@ $^

$(BIN)/talus: $(BUILD)/src/cli/main_talus.o $(LIB)
	@mkdir -p $(@D)
	@echo "LD $@"
	$(Q)$(CC) $(OPT) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(PKG_LIBS)

$(BIN)/talus-tables: $(BUILD)/src/cli/main_talus_tables.o $(LIB)
	@mkdir -p $(@D)
	@echo "LD $@"
	$(Q)$(CC) $(OPT) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(PKG_LIBS)

$(BUILD)/tests/%: $(BUILD)/tests/%.o $(LIB)
	@echo "LD $@"
	$(Q)$(CC) $(OPT) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(shell pkg-config --libs cmocka) $(PKG_LIBS)

-include $(OBJECTS:.o=.d) $(TESTS:=.d) $(BUILD)/src/cli/main_talus.d $(BUILD)/src/cli/main_talus_tables.d
