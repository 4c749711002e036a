# gnomon: library, file library, command line tool and tests. GNU make.
#
#   make            libraries and tool in build/
#   make demo       what is missing from the system, then the above, then a picture of every scene in out/
#   make test       the same, then all tests; the last line counts them
#   make gallery    docs/gallery.md with a small picture of every scene
#   make bench      measurements        make check-asan     tests under the address and undefined-behaviour sanitizers
#   make fuzz       FUZZ_SECONDS for each target of random input
#   make faults     memory, files and disks that fail, signals, counted
#   make hostile    sizes that no one means: time, memory and outcome of each
#   make install    PREFIX, DESTDIR     make check-tsan     threaded tests under the thread sanitizer
#   make check-port     the engine with 32 bits and on a big-endian machine, by cross compilers and qemu
#   make coverage   lines and branches of src/ that the tests reach
#   make mutation   lines broken on purpose, and the test that catches each
#   make check-headers  the public headers in every C and C++ they promise

# ---- yours to change, here or on the command line ----------------------------------------------------------------
ifeq ($(origin CC),default)
CC      := gcc
endif
CFLAGS  ?= -O3
CPPFLAGS ?=
LDFLAGS ?=
PREFIX  ?= /usr/local
DESTDIR ?=
BINDIR  ?= $(PREFIX)/bin
LIBDIR  ?= $(PREFIX)/lib
INCLUDEDIR ?= $(PREFIX)/include
MANDIR  ?= $(PREFIX)/share/man
COMPLETIONDIR ?= $(PREFIX)/share/bash-completion/completions
PKGCONFIG ?= pkg-config
BUILD   ?= build
OUT     ?= out
V       ?=# anything: whole commands instead of short lines

# ---- flags the project needs ----------------------------------------------------------------------------------------
# The same input has to give the same bytes with every compiler: no contraction to fused multiply-adds, no -ffast-math,
# no -march.
SANITIZE :=
# What make coverage adds to the files of src/ alone, so that the tests around them stay quick.
COUNTERS :=
LANGUAGE := -std=c11 -ffp-contract=off -pthread -D_POSIX_C_SOURCE=200809L -D_FILE_OFFSET_BITS=64 -Iinclude -Isrc
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wconversion
TEST_WARNINGS := -Wall -Wextra -Wpedantic -Wshadow
# Neither flag changes a result: they let square roots and selections become vector code.
VECTOR := -fno-math-errno -fno-trapping-math
COMPILE = $(CC) $(CPPFLAGS) $(CFLAGS) $(LANGUAGE) $(SANITIZE) $(VECTOR) -fvisibility=hidden -fPIC -MMD -MP
LINK = $(CC) $(CFLAGS) $(SANITIZE) $(filter --coverage,$(COUNTERS)) -pthread $(LDFLAGS)
comma := ,
soname = -Wl,-soname,$(1).so.$(SOMAJOR)

# OpenEXRCore is the C part of OpenEXR; its pkg-config module would link all the C++ libraries too, so only the include
# path is taken from there.
pkg = $(shell $(PKGCONFIG) $(1) 2>/dev/null || echo $(2))
IO_CFLAGS := $(call pkg,--cflags yaml-0.1 assimp libpng libdeflate cairo-pdf,-I/usr/include/libpng16 -I/usr/include/cairo) \
             $(filter -I%,$(call pkg,--cflags OpenEXR,-I/usr/include/OpenEXR -I/usr/include/Imath))
IO_LIBS   := $(call pkg,--libs yaml-0.1 assimp libpng libdeflate cairo-pdf,-lyaml -lassimp -lpng -ldeflate -lcairo) -lOpenEXRCore
TEST_LIBS := $(call pkg,--libs cmocka,-lcmocka)

VERSION := $(shell sed -n 's/^.define GNO_VERSION_[A-Z]* \([0-9]*\)/\1/p' include/gnomon/gnomon.h | paste -sd.)
SOMAJOR := $(firstword $(subst ., ,$(VERSION)))

# ---- files -------------------------------------------------------------------------------------------------------------
ENGINE_DIRS := base scene project clip shadow scan shade engine
ENGINE_SRC := $(sort $(foreach d,$(ENGINE_DIRS),$(wildcard src/$(d)/*.c)))
IO_SRC     := $(sort $(wildcard src/io/*.c))
CLI_SRC    := $(sort $(wildcard src/cli/*.c))
SUPPORT_SRC := $(sort $(wildcard tests/support/*.c))
TEST_SRC   := $(sort $(wildcard tests/unit/test_*.c tests/property/test_*.c tests/pictures/test_*.c tests/robustness/test_*.c))
TEST_SCRIPTS := $(sort $(wildcard tests/test_*.sh tests/*/test_*.sh))
SCENES     := $(sort $(wildcard scenes/*.yaml))
HEADERS    := $(sort $(wildcard include/gnomon/*.h))

ENGINE_OBJ := $(ENGINE_SRC:%.c=$(BUILD)/obj/%.o)
IO_OBJ     := $(IO_SRC:%.c=$(BUILD)/obj/%.o)
CLI_OBJ    := $(CLI_SRC:%.c=$(BUILD)/obj/%.o)
SUPPORT_OBJ := $(SUPPORT_SRC:%.c=$(BUILD)/obj/%.o)
TEST_OBJ   := $(patsubst %.c,$(BUILD)/obj/%.o,$(TEST_SRC) $(wildcard tests/fuzz/*.c tests/faults/*.c))
TEST_BIN   := $(TEST_SRC:%.c=$(BUILD)/%)

# Sizes that no one means: one program of its own.
HOSTILE_SRC := $(sort $(wildcard tests/hostile/*.c))
HOSTILE_OBJ := $(HOSTILE_SRC:%.c=$(BUILD)/obj/%.o)
HOSTILE := $(BUILD)/tests/hostile/hostile

# Faults: every public call; and the tool's own objects with the calls of memory and files that they make sent elsewhere.
CALL_FAULTS := $(BUILD)/tests/faults/call_faults
COMMAND_FAULTS := $(BUILD)/tests/faults/command_faults
FAULTY := main malloc calloc realloc fopen64 open64 read write pwrite64 fsync rename close lseek64 mkstemp64 fseek fread ferror fstat64

FUZZ_SRC := $(sort $(wildcard tests/fuzz/fuzz_*.c))
FUZZ_BIN := $(FUZZ_SRC:%.c=$(BUILD)/%)
# What calls a fuzz target: our own driver, or the compiler's library.
FUZZ_DRIVER ?= $(BUILD)/obj/tests/fuzz/driver.o

STATIC := $(BUILD)/libgnomon.a $(BUILD)/libgnomon-io.a
SHARED := $(BUILD)/libgnomon.so $(BUILD)/libgnomon-io.so
TOOL   := $(if $(CLI_SRC),$(BUILD)/gnomon)

.PHONY: watertight all demo demo-pictures test test-run check-asan asan-run check-tsan tsan-run check-port bench install uninstall deps clean check-headers FORCE
.DELETE_ON_ERROR:
.SUFFIXES:

all: $(STATIC) $(SHARED) $(TOOL) $(BUILD)/gnomon.pc $(BUILD)/gnomon-io.pc

# Recipes that start with installing packages build in a make of their own, which then sees what was installed.
JOBS = $(if $(filter -j%,$(MAKEFLAGS)),,-j$(shell nproc 2>/dev/null || echo 1))
SUBMAKE = $(MAKE) --no-print-directory

ifeq ($(strip $(V)),)
run = @printf '  %-5s %s\n' '$(1)' '$@' && $(2)
else
run = $(2)
endif

# ---- building --------------------------------------------------------------------------------------------------------
# Everything compiled depends on this file, which changes only when compiler or flags do.
$(BUILD)/flags: FORCE
	@mkdir -p $(@D)
	@printf '%s\n' '$(COMPILE) $(COUNTERS) | $(LINK) | $(IO_CFLAGS) | $(IO_LIBS)' | cmp -s - $@ || \
	 printf '%s\n' '$(COMPILE) $(COUNTERS) | $(LINK) | $(IO_CFLAGS) | $(IO_LIBS)' > $@

# A list of objects, so that a source file that went away leaves the library as well.
$(BUILD)/engine.list: OBJECTS = $(ENGINE_OBJ)
$(BUILD)/io.list: OBJECTS = $(IO_OBJ)
$(BUILD)/engine.list $(BUILD)/io.list: FORCE
	@mkdir -p $(@D)
	@printf '%s\n' $(OBJECTS) | cmp -s - $@ || printf '%s\n' $(OBJECTS) > $@

$(BUILD)/obj/src/io/%.o: EXTRA = $(IO_CFLAGS)
$(BUILD)/obj/src/%.o: src/%.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(call run,CC,$(COMPILE) $(COUNTERS) $(WARNINGS) $(EXTRA) -c $< -o $@)

$(BUILD)/obj/tests/%.o: tests/%.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(call run,CC,$(COMPILE) $(TEST_WARNINGS) $(IO_CFLAGS) -Itests -c $< -o $@)

$(BUILD)/libgnomon.a: $(ENGINE_OBJ) $(BUILD)/engine.list
	$(call run,AR,rm -f $@ && $(AR) rcs $@ $(ENGINE_OBJ))

$(BUILD)/libgnomon-io.a: $(IO_OBJ) $(BUILD)/io.list
	$(call run,AR,rm -f $@ && $(AR) rcs $@ $(IO_OBJ))

$(BUILD)/libgnomon.so.$(VERSION): $(ENGINE_OBJ) $(BUILD)/engine.list
	$(call run,LINK,$(LINK) -shared $(call soname,libgnomon) $(ENGINE_OBJ) -o $@ -lm)

$(BUILD)/libgnomon-io.so.$(VERSION): $(IO_OBJ) $(BUILD)/io.list $(BUILD)/libgnomon.so
	$(call run,LINK,$(LINK) -shared $(call soname,libgnomon-io) $(IO_OBJ) -o $@ -L$(BUILD) -lgnomon $(IO_LIBS) -lm)

$(SHARED): %.so: %.so.$(VERSION)
	@ln -sf $(<F) $*.so.$(SOMAJOR)
	@ln -sf $(*F).so.$(SOMAJOR) $@

$(BUILD)/gnomon: $(CLI_OBJ) $(STATIC)
	$(call run,LINK,$(LINK) $(CLI_OBJ) $(BUILD)/libgnomon-io.a $(BUILD)/libgnomon.a -o $@ $(IO_LIBS) -lm)

$(TEST_BIN): $(BUILD)/%: $(BUILD)/obj/%.o $(SUPPORT_OBJ) $(STATIC)
	@mkdir -p $(@D)
	$(call run,LINK,$(LINK) $< $(SUPPORT_OBJ) $(BUILD)/libgnomon-io.a $(BUILD)/libgnomon.a -o $@ $(TEST_LIBS) $(IO_LIBS) -lm)

$(HOSTILE): $(HOSTILE_OBJ) $(STATIC)
	@mkdir -p $(@D)
	$(call run,LINK,$(LINK) $(HOSTILE_OBJ) $(BUILD)/libgnomon-io.a $(BUILD)/libgnomon.a -o $@ $(IO_LIBS) -lm)

$(CALL_FAULTS): $(BUILD)/obj/tests/faults/call_faults.o $(BUILD)/obj/tests/faults/calls.o $(SUPPORT_OBJ) $(STATIC)
	@mkdir -p $(@D)
	$(call run,LINK,$(LINK) $(filter %.o,$^) $(BUILD)/libgnomon-io.a $(BUILD)/libgnomon.a -o $@ $(IO_LIBS) -lm)

$(COMMAND_FAULTS): $(BUILD)/obj/tests/faults/command_faults.o $(BUILD)/obj/tests/support/places.o $(CLI_OBJ) $(STATIC)
	@mkdir -p $(@D)
	$(call run,LINK,$(LINK) $(FAULTY:%=-Wl$(comma)--wrap=%) $(filter %.o,$^) $(BUILD)/libgnomon-io.a $(BUILD)/libgnomon.a -o $@ $(IO_LIBS) -lm)

$(FUZZ_BIN): $(BUILD)/%: $(BUILD)/obj/%.o $(BUILD)/obj/tests/fuzz/fuzz.o $(filter %.o,$(FUZZ_DRIVER)) $(STATIC)
	@mkdir -p $(@D)
	$(call run,LINK,$(LINK) $< $(BUILD)/obj/tests/fuzz/fuzz.o $(FUZZ_DRIVER) $(BUILD)/libgnomon-io.a $(BUILD)/libgnomon.a -o $@ $(IO_LIBS) -lm)

$(BUILD)/gnomon.pc: FORCE
	@mkdir -p $(@D)
	@printf '%s\n' 'prefix=$(PREFIX)' 'libdir=$(LIBDIR)' 'includedir=$(INCLUDEDIR)' '' 'Name: gnomon' \
	 'Description: polygon scenes with exact hidden surfaces and exact shadows' 'Version: $(VERSION)' \
	 'Cflags: -I$${includedir}' 'Libs: -L$${libdir} -lgnomon' 'Libs.private: -lm -pthread' > $@

$(BUILD)/gnomon-io.pc: FORCE
	@mkdir -p $(@D)
	@printf '%s\n' 'prefix=$(PREFIX)' 'libdir=$(LIBDIR)' 'includedir=$(INCLUDEDIR)' '' 'Name: gnomon-io' \
	 'Description: scene files in and pictures out for gnomon' 'Version: $(VERSION)' 'Requires: gnomon' \
	 'Requires.private: yaml-0.1 assimp libpng libdeflate cairo-pdf' 'Cflags: -I$${includedir}' 'Libs: -L$${libdir} -lgnomon-io' \
	 'Libs.private: -lOpenEXRCore -lm' > $@

-include $(patsubst %.o,%.d,$(ENGINE_OBJ) $(IO_OBJ) $(CLI_OBJ) $(SUPPORT_OBJ) $(TEST_OBJ) $(HOSTILE_OBJ))

# ---- pictures --------------------------------------------------------------------------------------------------------
demo:
	+@$(SUBMAKE) deps
	+@echo 'Building the libraries and the tool in $(BUILD)/ ...'
	+@$(SUBMAKE) $(JOBS) all
	+@$(SUBMAKE) demo-pictures

demo-pictures: all
	@mkdir -p $(OUT)
	@if [ -z '$(SCENES)' ]; then echo 'There is no scene in scenes/ yet.'; fi
	@set -e; for scene in $(SCENES); do \
	  picture=$(OUT)/$$(basename $$scene .yaml).png; \
	  echo "$(BUILD)/gnomon render $$scene -o $$picture"; \
	  $(BUILD)/gnomon render $$scene -o $$picture; \
	done
	@if [ -n '$(SCENES)' ]; then echo 'The pictures are in $(OUT)/.'; fi

# Every scene small, and a page that shows them all: kept in the tree, so that the page can be read where the sources are.
.PHONY: gallery
gallery: all
	@GNOMON='$(abspath $(BUILD)/gnomon)' sh docs/gallery.sh

# ---- tests -----------------------------------------------------------------------------------------------------------
test:
	+@$(SUBMAKE) deps
	+@$(SUBMAKE) $(JOBS) all tests
	+@$(SUBMAKE) test-run

.PHONY: tests
tests: $(TEST_BIN) $(FUZZ_BIN) $(HOSTILE) $(CALL_FAULTS) $(COMMAND_FAULTS)

test-run: all tests
	@CC='$(CC)' BUILD='$(BUILD)' GNOMON='$(abspath $(BUILD)/gnomon)' \
	 sh tests/run.sh $(BUILD)/logs $(TEST_BIN) $(TEST_SCRIPTS) tests/check-headers.sh

# Closed bodies from outside and from inside: no background and no light through their edges.
VIEWS ?= 10000
watertight: $(BUILD)/tests/property/test_watertight
	@GNOMON_VIEWS=$(VIEWS) $<

# Failing memory, files and disks, signals: every fault of every call and command; then, under the sanitizers and the leak checker, every
# allocation of every call again, and each place in the program where a command allocates or asks for a file.
FAULT_BUILDS = $(CALL_FAULTS) $(COMMAND_FAULTS) $(BUILD)/gnomon $(BUILD)/tests/robustness/test_faults
.PHONY: faults faults-run
faults:
	+@$(SUBMAKE) $(JOBS) FAULTS=full EACH=1 faults-run
	+@$(SUBMAKE) $(JOBS) BUILD=build/asan CFLAGS='-O1 -g -fno-omit-frame-pointer' \
	  SANITIZE='-fsanitize=address,undefined -fno-sanitize-recover=all' FAULTS=places EACH=places faults-run

faults-run: $(FAULT_BUILDS)
	@BUILD='$(BUILD)' bash tests/faults/faults.sh $(FAULTS)
	@GNOMON_FAULTS=$(EACH) $(BUILD)/tests/robustness/test_faults

# Huge counts, coordinates, polygons, piles, lights and pictures: time, peak memory and outcome of each. HOSTILE_CASE: a part of a name.
.PHONY: hostile
hostile: $(HOSTILE) $(BUILD)/gnomon
	@$(HOSTILE) full $(if $(HOSTILE_CASE),'$(HOSTILE_CASE)')

# Random input for the readers, the clipper and the engines, under the sanitizers: by libFuzzer where clang is, else by our own driver.
FUZZ_SECONDS ?= 10
.PHONY: fuzz fuzz-run fuzz-targets
fuzz-targets: $(FUZZ_BIN)
fuzz:
	+@if command -v clang >/dev/null; then \
	  $(SUBMAKE) $(JOBS) CC=clang BUILD=build/fuzz CFLAGS='-O1 -g -fno-omit-frame-pointer' FUZZ_DRIVER=-fsanitize=fuzzer \
	    SANITIZE='-fsanitize=address,undefined,fuzzer-no-link -fno-sanitize-recover=undefined' fuzz-run; \
	else \
	  $(SUBMAKE) $(JOBS) BUILD=build/asan CFLAGS='-O1 -g -fno-omit-frame-pointer' \
	    SANITIZE='-fsanitize=address,undefined -fno-sanitize-recover=all' fuzz-run; fi

fuzz-run: fuzz-targets
	@BUILD='$(BUILD)' bash tests/fuzz/fuzz.sh $(FUZZ_SECONDS) $(FUZZ_SRC)

check-headers: $(BUILD)/libgnomon.so $(BUILD)/libgnomon-io.so
	@CC='$(CC)' BUILD='$(BUILD)' sh tests/check-headers.sh

# Only the cmocka programs: they reach every part of the libraries, and the tool is a thin layer on top.
check-asan:
	+@$(SUBMAKE) $(JOBS) BUILD=build/asan CFLAGS='-O1 -g -fno-omit-frame-pointer' \
	  SANITIZE='-fsanitize=address,undefined -fno-sanitize-recover=all' asan-run

asan-run: tests
	@BUILD='$(BUILD)' ASAN_OPTIONS=allocator_may_return_null=1:$$ASAN_OPTIONS \
	 sh tests/run.sh $(BUILD)/logs $(TEST_BIN)

# What the tests reach of src/, by gcc's counters; not with the scripts that judge names and links of the libraries as shipped.
# Functions made part of each caller, and those made for several processors (base/vector.h), count once, not copy by copy.
COUNT_ALL := -O0 --coverage -Dalways_inline=unused -U__gnu_linux__
COVERAGE_SCRIPTS := $(filter-out %/test_symbols.sh %/test_examples.sh %/test_install.sh,$(TEST_SCRIPTS))
.PHONY: coverage coverage-run
coverage:
	+@$(SUBMAKE) $(JOBS) CC=gcc BUILD=build/coverage CFLAGS=-O2 COUNTERS='$(COUNT_ALL)' all tests
	+@$(SUBMAKE) CC=gcc BUILD=build/coverage CFLAGS=-O2 COUNTERS='$(COUNT_ALL)' coverage-run

coverage-run: all tests
	@find $(BUILD)/obj -name '*.gcda' -exec rm -f {} +
	@BUILD='$(BUILD)' GNOMON='$(abspath $(BUILD)/gnomon)' sh tests/run.sh $(BUILD)/logs $(TEST_BIN) $(COVERAGE_SCRIPTS); \
	 status=$$?; sh tests/coverage.sh $(BUILD) && exit $$status

# Lines of clip, scan and shadow broken on purpose, one at a time, in a copy of the tree: each has to be caught by a test. MUTATION: a
# word of the files' names.
.PHONY: mutation
mutation:
	@CC='$(CC)' bash tests/mutation.sh build/mutation tests/mutations.txt $(MUTATION)

# The programs that work on several threads, under the thread sanitizer.
TSAN_TESTS := $(addprefix $(BUILD)/tests/,unit/test_embedding unit/test_stream unit/test_layers unit/test_threads property/test_determinism)

check-tsan:
	+@$(SUBMAKE) $(JOBS) BUILD=build/tsan CFLAGS='-O1 -g -fno-omit-frame-pointer' SANITIZE='-fsanitize=thread' tsan-run

tsan-run: $(TSAN_TESTS)
	@BUILD='$(BUILD)' sh tests/run.sh $(BUILD)/logs $(TSAN_TESTS)

# Other kinds of machines: 32 bits, big endian. It builds its own objects.
check-port:
	@CC='$(CC)' bash tests/port/run.sh

# BENCH: what to measure; tests/bench/bench.sh tells the words (quick, matrix, a scene, ...)
bench: all
	@GNOMON='$(abspath $(BUILD)/gnomon)' OUT='$(BUILD)/bench' bash tests/bench/bench.sh $(BENCH)

# ---- system packages -----------------------------------------------------------------------------------------------
PACKAGES := $(if $(filter gcc clang,$(CC)),$(CC)) libc6-dev make pkg-config \
            libyaml-dev libassimp-dev libpng-dev libdeflate-dev libopenexr-dev libcairo2-dev libcmocka-dev

deps:
	@if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then \
	  echo 'deps: this is no Debian or Ubuntu; the build needs what they call: $(PACKAGES)'; exit 0; fi; \
	missing=; for package in $(PACKAGES); do \
	  dpkg-query -W -f='$${Status}' $$package 2>/dev/null | grep -q '^install ok installed' || missing="$$missing $$package"; \
	done; \
	if [ -z "$$missing" ]; then echo 'deps: every package the build needs is installed.'; exit 0; fi; \
	echo "deps: installing with apt-get:$$missing"; \
	sudo=; if [ "$$(id -u)" != 0 ]; then \
	  command -v sudo >/dev/null || { echo "deps: not root and no sudo; please install:$$missing" >&2; exit 1; }; \
	  echo 'deps: sudo may ask for your password.'; sudo=sudo; fi; \
	$$sudo apt-get update -q && \
	$$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $$missing

# ---- installing ----------------------------------------------------------------------------------------------------
install: all
	install -d '$(DESTDIR)$(BINDIR)' '$(DESTDIR)$(LIBDIR)/pkgconfig' '$(DESTDIR)$(INCLUDEDIR)/gnomon'
	install -m 755 $(BUILD)/gnomon '$(DESTDIR)$(BINDIR)'
	install -m 644 $(HEADERS) '$(DESTDIR)$(INCLUDEDIR)/gnomon'
	install -m 644 $(STATIC) '$(DESTDIR)$(LIBDIR)'
	install -m 755 $(SHARED:%=%.$(VERSION)) '$(DESTDIR)$(LIBDIR)'
	for lib in libgnomon libgnomon-io; do \
	  ln -sf $$lib.so.$(VERSION) '$(DESTDIR)$(LIBDIR)'/$$lib.so.$(SOMAJOR) && \
	  ln -sf $$lib.so.$(SOMAJOR) '$(DESTDIR)$(LIBDIR)'/$$lib.so || exit 1; done
	install -m 644 $(BUILD)/gnomon.pc $(BUILD)/gnomon-io.pc '$(DESTDIR)$(LIBDIR)/pkgconfig'
	install -d '$(DESTDIR)$(MANDIR)/man1' '$(DESTDIR)$(COMPLETIONDIR)'
	install -m 644 docs/man/gnomon.1 '$(DESTDIR)$(MANDIR)/man1'
	install -m 644 src/cli/completion/gnomon '$(DESTDIR)$(COMPLETIONDIR)'

uninstall:
	rm -f '$(DESTDIR)$(BINDIR)/gnomon' '$(DESTDIR)$(MANDIR)/man1/gnomon.1' '$(DESTDIR)$(COMPLETIONDIR)/gnomon'
	rm -f $(foreach h,$(notdir $(HEADERS)),'$(DESTDIR)$(INCLUDEDIR)/gnomon/$(h)')
	-rmdir '$(DESTDIR)$(INCLUDEDIR)/gnomon'
	for lib in libgnomon libgnomon-io; do \
	  rm -f '$(DESTDIR)$(LIBDIR)'/$$lib.a '$(DESTDIR)$(LIBDIR)'/$$lib.so '$(DESTDIR)$(LIBDIR)'/$$lib.so.$(SOMAJOR) \
	    '$(DESTDIR)$(LIBDIR)'/$$lib.so.$(VERSION) '$(DESTDIR)$(LIBDIR)'/pkgconfig/$${lib#lib}.pc; done

clean:
	rm -rf $(BUILD) $(OUT)
