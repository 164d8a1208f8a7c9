# Two commands need nothing done before them: `make demo` and `make test`.
SHELL := /bin/sh
JOBS ?= $(shell nproc 2>/dev/null || echo 2)
# For what starts a Blender; the tests read it when they run.
BLENDER ?= blender
export BLENDER
# Debian suites whose Blender runs the add-on's tests in `make test` too: "trixie sid". Needs root or user namespaces.
BLENDERS ?=
# ON: warnings are errors, as in .ci/run. Said each time, so that a build folder follows.
WERROR ?= OFF
# dev: one instruction set, the quickest build; each preset has a folder of its own.
PRESET ?= release
BUILD := $(if $(filter release,$(PRESET)),build,build-$(PRESET))
space := $() $()
# A compiler cache is used where there is one.
LAUNCHER := $(if $(shell command -v ccache 2>/dev/null),-DCMAKE_CXX_COMPILER_LAUNCHER=ccache,)

.PHONY: help deps configure build program install demo test test-addon test-blenders blender-facts blenders-clean fuzz sanitize bench asserts addon bundle deb test-bundle docs bits reproduce speed growth peers farm test-farm farm-costs test-arm format clean
help:
	@echo "make demo       build, render two scenes in Blender, run the methods, make contact sheets and reports"
	@echo "make test       build and run every test"
	@echo "make program    the program, at build/aaresolve; make build: and its tests"
	@echo "make install    the program, the add-on's zip and the pages below PREFIX=/usr/local"
	@echo "make addon      the Blender add-on as one zip for 3.4 to 5.2, at build/aa_resolve.zip"
	@echo "make bundle     the program with its libraries, build/aaresolve-*.tar.gz, and the add-on with it, build/aa_resolve-linux-x64.zip"
	@echo "make deb        Debian packages of the program; docs/install.md says who takes which file"
	@echo "make bench      speed of every method, ns per pixel, and of the exporter, CPU seconds"
	@echo "make speed      every method in every instruction set of this machine: docs/results/speed.json and .md"
	@echo "make growth     time and memory over sizes, frames and threads: docs/results/growth.md; both want a quiet machine,"
	@echo "                keep what is measured, and take PIECES=4: so many measurements now"
	@echo "make peers      SMAA, FLIP and SSIM beside smaa-cpp, NVIDIA's FLIP and scikit-image: SMAA=FOLDER FLIP=FOLDER of their sources"
	@echo "make reproduce  render the study's scenes, run every method on each, hold them against the published"
	@echo "                tables, write docs/results; QUICK=1: a short form, FULL=1: published sizes, ONLY=oliveros-5.8: one table, ONLY=list"
	@echo "make farm       a small study of scenes x frames x methods as a Snakemake workflow, two jobs at once, to"
	@echo "                build/farm; STUDY=study.yaml: yours; PLAN=1: what would be done (docs/farm.md)"
	@echo "make farm-costs what the theses' study costs on 1, 8 and 100 nodes, from costs measured in some ten minutes: docs/farm.md"
	@echo "make test-farm  the same study on one machine and on a Slurm of its own, killed and resumed: same bytes"
	@echo "make test-addon     the add-on's tests in the Blender at BLENDER=/path/to/blender; ONLY=\"light motion\""
	@echo "make test-blenders  the same, scenes and more in the Blenders of Debian 13 and sid; SUITES=\"trixie sid\", ONLY=..."
	@echo "make test-arm       built for 64-bit Arm and run under qemu: unit and property tests, and the bits of x86"
	@echo "make test-bundle    the bundle and the zips in bare systems of Debian 12, 13 and sid"
	@echo "make fuzz       damaged input through the program, then each parser under libFuzzer, FUZZ_SECONDS=300 or"
	@echo "                FUZZ_RUNS=1000000 each; how much of the parsers the corpus reaches; COVERAGE=1: this table alone"
	@echo "make sanitize   unit and property tests under AddressSanitizer and UndefinedBehaviorSanitizer"
	@echo "make asserts    unit tests with asserts on"
	@echo "make deps, docs, bits, format, clean; PRESET=dev: the quickest build, in build-dev/ (CONTRIBUTING.md)"

deps:
	@.ci/bootstrap

configure: deps
	@cmake --preset $(PRESET) $(LAUNCHER) -DAA_WERROR=$(WERROR) "-DAA_BLENDERS=$(subst $(space),;,$(strip $(BLENDERS)))" >$(BUILD).log 2>&1 || { cat $(BUILD).log; rm -f $(BUILD).log; exit 1; }; mv $(BUILD).log $(BUILD)/configure.log

build: configure
	@cmake --build --preset $(PRESET) -j $(JOBS)

program: configure
	@cmake --build --preset $(PRESET) -j $(JOBS) --target aaresolve

PREFIX ?= /usr/local
install: build
	@cmake --install $(BUILD) --prefix $(PREFIX)

demo: program
	@bash scenes/demo.sh $(BUILD)/aaresolve build/demo

test: build
	@python3 tests/run_tests.py --preset $(PRESET) -j $(JOBS)

test-addon:
	@python3 tests/addon/in_blender.py -j $(JOBS) $(ONLY)

# Without the right to install mmdebstrap the script says that it is missing, and skips.
test-blenders: bundle
	@CI_PACKAGES=mmdebstrap .ci/bootstrap || true
	@python3 tests/blenders/run.py $(BUILD)/aaresolve -j $(JOBS) --suites $(SUITES) --only $(ONLY)

# The table of docs/blenders.md: what the exporter rests on, in each Blender.
blender-facts:
	@CI_PACKAGES=mmdebstrap .ci/bootstrap
	@python3 tests/blenders/facts_table.py --suites $(SUITES)

blenders-clean:
	@python3 tests/blenders/debian.py clean

FUZZ_SECONDS ?= 300
SEED ?= 1
fuzz: program
	@$(if $(COVERAGE),,python3 tests/fuzz/fuzz.py $(BUILD)/aaresolve --seconds $(FUZZ_SECONDS) --seed $(SEED) --jobs $(JOBS))
	@CI_PACKAGES="clang llvm" .ci/bootstrap
	@cmake --preset fuzz $(LAUNCHER) >/dev/null
	@cmake --build --preset fuzz -j $(JOBS) --target fuzz_target
	@python3 tests/fuzz/search.py build-fuzz $(BUILD)/aaresolve $(if $(COVERAGE),--coverage,$(if $(FUZZ_RUNS),--runs $(FUZZ_RUNS),--seconds $(FUZZ_SECONDS))) --jobs $(JOBS)

sanitize: deps
	@cmake --preset sanitize $(LAUNCHER) -DAA_WERROR=$(WERROR) >/dev/null
	@cmake --build --preset sanitize -j $(JOBS)
	@ctest --preset sanitize -j $(JOBS)

bench: build
	@$(BUILD)/tests/benchmarks --benchmark_min_time=0.2
	@$(BLENDER) -b --factory-startup --python-exit-code 9 -P tests/bench/exporter_bench.py
	@$(BLENDER) -b --factory-startup --python-exit-code 9 -P tests/bench/exporter_bench.py -- --animated
	@$(BLENDER) -b --factory-startup --python-exit-code 9 -P tests/bench/exporter_stages.py

# For every system; and for Linux with the program in it, where `make bundle` has made that.
BUNDLES = $(wildcard $(BUILD)/bundle/aaresolve-*)
addon:
	@mkdir -p $(BUILD)
	@python3 blender_addon/make_zip.py $(BUILD)/aa_resolve.zip
	@$(if $(BUNDLES),python3 blender_addon/make_zip.py $(BUILD)/aa_resolve-linux-x64.zip --program $(BUNDLES))

bundle: configure
	@cmake --build --preset $(PRESET) -j $(JOBS) --target aaresolve bundle_parts
	@python3 packaging/bundle.py $(BUILD)
	@$(MAKE) --no-print-directory addon

# Debian packages for the system that this is: aaresolve, and aaresolve-formats, which draws in OpenImageIO.
deb: configure
	@cmake --build --preset $(PRESET) -j $(JOBS) --target aaresolve aaresolve_formats addon
	@cd $(BUILD) && cpack -G DEB >cpack.log || { cat cpack.log; exit 1; }
	@ls -sh $(BUILD)/*.deb

test-bundle: bundle
	@CI_PACKAGES=mmdebstrap .ci/bootstrap || true
	@python3 tests/bundle/run.py $(BUILD)

# Only this needs a cross compiler, an emulator and another processor's libraries. What is built is kept, in build-arm/.
test-arm: deps
	@CI_PACKAGES="g++-aarch64-linux-gnu qemu-user-static mmdebstrap" .ci/bootstrap || true
	@python3 tests/arm/run.py -j $(JOBS)

# Generated: the page of methods and the add-on's copy of the registry, the tables of precision, memory and stability; and
# the pages of what was measured, from their files.
docs: program
	@python3 scenes/reproduce/speed.py --page-only docs/results
	@python3 tests/bench/growth.py --page-only docs/results
	@python3 scenes/farm/costs.py --page-only docs/results
	@python3 blender_addon/write_scenes_page.py
	@$(BUILD)/aaresolve list --markdown > docs/methods.md
	@python3 resolver/metrics/write_page.py $(BUILD)/aaresolve docs/metrics.md
	@$(BUILD)/aaresolve list --json > blender_addon/aa_resolve/methods.json
	@$(BUILD)/aaresolve bench -m temporal --markdown --size 480x270 --frames 8 --repeats 1 --threads 1 > docs/precision.md
	@$(BUILD)/aaresolve stability -q --markdown >$(BUILD)/stability.md
	@python3 tests/gpu/keep_columns.py docs/results/stability.md <$(BUILD)/stability.md

# After a change of a method's pixels that was meant: what every build must give from now on.
bits: program
	@python3 tests/e2e/same_bits_test.py $(BUILD)/aaresolve . --update

# Resumable: what build/reproduce holds is kept. ONLY="oliveros-5.8 ...": some tables, to build/reproduce/only;
# ONLY=list shows the names and what is missing.
reproduce: program
	@python3 scenes/reproduce/reproduce.py $(BUILD)/aaresolve build/reproduce docs/results $(if $(QUICK),--quick) $(if $(FULL),--full) $(if $(filter list,$(ONLY)),--list,$(if $(ONLY),--only $(ONLY)))

# What is measured is kept until the program changes.
PIECES ?=
speed: program
	@python3 scenes/reproduce/speed.py $(BUILD)/aaresolve $(BUILD)/speed docs/results $(if $(PIECES),--pieces $(PIECES))

growth: program
	@python3 tests/bench/growth.py $(BUILD)/aaresolve $(BUILD)/growth docs/results $(if $(PIECES),--pieces $(PIECES))

# Sources of others are fetched by hand: github.com/iRi-E/smaa-cpp, github.com/NVlabs/flip.
SMAA ?=
FLIP ?=
peers: build
	@CI_PACKAGES=python3-skimage .ci/bootstrap
	@/usr/bin/python3 tests/bench/peers.py --program $(BUILD)/aaresolve --benchmarks $(BUILD)/tests/benchmarks --out docs/results/peers.md \
	  $(if $(SMAA),--smaa $(SMAA)) $(if $(FLIP),--flip $(FLIP))

# Only these need Snakemake and Slurm. What is finished is kept.
STUDY ?=
farm: program
	@CI_PACKAGES=snakemake .ci/bootstrap
	@AARESOLVE=$(CURDIR)/$(BUILD)/aaresolve snakemake -s scenes/Snakefile --cores $(JOBS) --rerun-incomplete --keep-going \
	  $(if $(PLAN),-n) $(if $(STUDY),--configfile $(STUDY))

farm-costs: program
	@python3 scenes/farm/costs.py $(BUILD)/aaresolve $(BUILD)/farm/costs docs/results $(if $(PIECES),--pieces $(PIECES))

test-farm: program
	@CI_PACKAGES="snakemake slurmctld slurmd slurm-client munge" .ci/bootstrap
	@python3 tests/farm/farm.py $(BUILD)/aaresolve

format:
	@.ci/format

# Unit tests with every assert on, the standard library's too: what release builds leave out. About 7 minutes on two
# cores without a compiler cache, so CI does not wait for it.
asserts: deps
	@cmake --preset asserts $(LAUNCHER) -DAA_WERROR=$(WERROR) >/dev/null
	@cmake --build --preset asserts -j $(JOBS) --target unit_tests
	@build-asserts/tests/unit_tests --gtest_brief=1

clean:
	rm -rf build build-*/
