# `make help` lists the targets. Each target makes what it needs, including the environment; only Python 3.11 and make are
# required. The environment .venv is made from the hash-pinned environment.lock, again whenever that file's content
# changes; when it is active (`. .venv/bin/activate`), snakemake, rocking and pytest work as usual.

MAKEFLAGS += --no-print-directory
.DEFAULT_GOAL := help
.PHONY: help reproduce atlas atlas-small verify deposit test test-core test-all browser serve docs bench stress slurm mutants oldest newest wheel lock environment FORCE

HOST ?= 127.0.0.1
PORT ?= 8000
RESULTS ?= results

# A blank separates prerequisites unless it is escaped.
EMPTY :=
MANIFEST = $(subst $(EMPTY) ,\ ,$(RESULTS))/manifest.json

# The lock is resolved for Python 3.11; a newer version is used only if there is no 3.11.
PYTHON ?= $(shell for p in python3.11 python3; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)
export PATH := $(CURDIR)/.venv/bin:$(PATH)
# uv installs the lock with a sixth of pip's processor time.
UV := $(or $(shell command -v uv),build/uv/bin/uv)
# Another active environment must not affect this one.
unexport VIRTUAL_ENV PYTHONPATH PYTHONHOME PYTHONDONTWRITEBYTECODE
export PIP_DISABLE_PIP_VERSION_CHECK := 1

# One run at a time, by a lock of a file. The system releases it when the run ends, also when it is killed; Snakemake's own
# lock, which is used where there is no flock (util-linux), would stay.
FLOCK := $(shell command -v flock)
run = $(if $(FLOCK),flock $(1) snakemake --nolock,snakemake)

help: ## list the targets
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/make \1\t\2/p' Makefile | expand -t 18

reproduce: .venv/project ## make data sets, figures and claims of the paper in results/ (CONFIG=FILE: another configuration)
	$(call run,Snakefile) $(if $(CONFIG),--configfile '$(CONFIG)')

# Data sets of all pulses lie in folders of their own: `make serve RESULTS=atlas-small/results`.
atlas-small atlas: .venv/project
	$(call run,workflow/config/$@.yaml) --directory $@ --configfile workflow/config/$@.yaml

atlas-small: ## make data sets of all nine pulses in atlas-small/results, ten minutes
atlas: ## the same on a fine grid, 27 restitutions and 10 angles, in atlas/results, some hours; it may be interrupted

verify: .venv/project ## compare every file in results/ with the manifest and list differences (RESULTS=: others; AGAINST=: other manifest)
	python -m workflow.verify "$$(dirname '$(RESULTS)')" $(if $(AGAINST),--against '$(AGAINST)')

deposit: .venv/project | $(MANIFEST) ## archive the data sets for a data repository in build/rocking-data.zip (RESULTS=: others)
	python -m workflow.deposit "$$(dirname '$(RESULTS)')"

test: .venv/project browser ## run format, lint and type checks and all tests, including a small run of the workflow
	ruff format --check .
	ruff check .
	snakefmt --check Snakefile workflow
	@echo 'of long tests and enumerations a part is run: make test-all runs all'
	$(PYTEST)

# The locked packages without those that only the extra `assessment` has.
test-core: $(UV) ## run the tests of the core where the extra `assessment` is not installed
	$(UV) venv --quiet --clear --seed --python $(PYTHON) build/core
	$(UV) pip install --quiet --python build/core --require-hashes --requirement environment.lock
	$(UV) pip uninstall --quiet --python build/core trimesh
	$(UV) pip install --quiet --python build/core --no-deps --no-build-isolation --editable .
	PATH=$(CURDIR)/build/core/bin:$$PATH NUMBA_CACHE_DIR=$(CURDIR)/build/core/kernels ROCKING_NO_BROWSER=1 $(PYTEST)

build/clients/bin/openapi-python-client: | .venv/project
	$(PYTHON) -m venv build/clients && build/clients/bin/pip install --quiet openapi-python-client datamodel-code-generator

test-all: .venv/project browser build/clients/bin/openapi-python-client ## run all tests, with all of what `make test` tries a sample (SEED= for other random requests)
	FUZZ_ALL=1 FUZZ_SEED=$(or $(SEED),1) $(PYTEST)

PYTEST := pytest --numprocesses auto --dist loadfile --no-loadscope-reorder --max-worker-restart 0

browser: .venv/project ## fetch Chromium for the tests of the web page if there is none (ROCKING_NO_BROWSER=1: skip them)
	@test -n '$(ROCKING_NO_BROWSER)' || { python -m tests.api.explorer.chromium && python -m tests.api.explorer.axe; }

serve: .venv/project | $(MANIFEST) ## start the HTTP service over results/, which is made first if missing (HOST=, PORT=, RESULTS=)
	rocking serve --host $(HOST) --port $(PORT) --results '$(RESULTS)'

docs: .venv/project | results/manifest.json ## build the guide in build/docs; its examples read results/, which is made first if missing (GUIDE_URL=: address of the site)
	GUIDE_URL=$(GUIDE_URL) sphinx-build -W --keep-going -q -b html docs build/docs
	@echo 'open build/docs/index.html, or make serve and http://$(HOST):$(PORT)/guide/'

bench: .venv/project ## run the benchmarks: run time, error, first call, records, service; about ten minutes
	$(call run,Snakefile) $(if $(CONFIG),--configfile '$(CONFIG)' --) bench

stress: .venv/project ## compare 3,800 hard cases with 192-bit references; one to two minutes
	python -m stress

slurm: .venv/project ## make data sets through a Slurm cluster of one node and compare all bytes with a local run; needs root
	@.venv/bin/python -m pip install --quiet --no-deps --upgrade --target build/slurm $(SLURM_PLUGIN)
	stress/slurm.sh

# Besides these the plugin needs what is locked; it is not installed into .venv.
SLURM_PLUGIN := snakemake-executor-plugin-slurm==2.8.0 snakemake-executor-plugin-slurm-jobstep==0.6.1

build/cosmic-ray/bin/cosmic-ray: | .venv/project
	$(PYTHON) -m venv build/cosmic-ray && build/cosmic-ray/bin/pip install --quiet cosmic-ray

build/mutants.sqlite: | build/cosmic-ray/bin/cosmic-ray
	rm -rf build/mutants && git clone --quiet . build/mutants
	cd build/mutants && PYTHONPATH=. python -m rocking.precompile
	build/cosmic-ray/bin/cosmic-ray init stress/mutants.toml $@.all
	python -m stress.mutants --session $@.all --count $(or $(COUNT),150) --seed $(or $(SEED),1)
	mv $@.all $@

mutants: build/mutants.sqlite ## mutation test of the last commit: change single operators and constants, run the tests; hours (COUNT=, SEED=)
	git -C build/mutants checkout --quiet .
	build/cosmic-ray/bin/cosmic-ray exec stress/mutants.toml $<
	build/cosmic-ray/bin/cr-report --surviving-only --show-diff $<

oldest: ## run the solver's tests, and one question to each interface, with the lowest versions that pyproject.toml allows (PYTHON=3.12)
newest: ## the same with the newest versions (PRERELEASE=allow: pre-releases, too)

# The environments are made below build/; the tools of the tests are the newest. The last line says what failed.
oldest: RESOLUTION := lowest-direct
# what our requirements require is the newest there, too, and may deprecate what their old versions call
oldest: WARNINGS := -W default::DeprecationWarning
newest: RESOLUTION := highest
# the extras of those who use the package, not of those who work on it
USED := service plot mesh sheets dask workflow
oldest newest: $(UV)
	$(UV) venv --quiet --clear --python $(PYTHON) build/$@
	$(UV) pip compile pyproject.toml $(USED:%=--extra %) --python $(PYTHON) --resolution $(RESOLUTION) \
	    --prerelease $(or $(PRERELEASE),if-necessary-or-explicit) --no-annotate --no-header --quiet --output-file build/$@.txt
	$(UV) pip install --quiet --python build/$@ --requirement build/$@.txt pytest hypothesis mpmath python-flint
	$(UV) pip install --quiet --python build/$@ --no-deps --editable .
	@export VIRTUAL_ENV=build/$@ NUMBA_CACHE_DIR='$(CURDIR)/build/$@/kernels'; \
	$(UV) run --no-project python -m rocking.precompile && \
	$(UV) run --no-project python -m pytest -q $(WARNINGS) tests/interfaces.py tests/solver >build/$@.log 2>&1; status=$$?; \
	echo "$@: $$(tail -n 1 build/$@.log) $$(grep -E '^(FAILED|ERROR) ' build/$@.log | cut -d ' ' -f 2 | tr '\n' ' ')"; \
	exit $$status

# The tools of a release, the build tool of the wheel among them, have the hashes of deploy/release.lock.
build/release/release.lock: deploy/release.lock | $(UV)
	$(UV) venv --quiet --clear --python $(PYTHON) build/release
	$(UV) pip install --quiet --python build/release --require-hashes --requirement $<
	cp $< $@

wheel: build/release/release.lock ## build dist/ with an SBOM of the locked service, check its metadata, install the wheel and ask one question
	rm -rf dist
	$(UV) build --quiet --python $(PYTHON) --build-constraints deploy/release.lock --require-hashes --out-dir dist
	build/release/bin/twine check --strict dist/*
	build/release/bin/cyclonedx-py requirements deploy/service.lock --pyproject pyproject.toml --mc-type library \
	    --output-reproducible --output-file dist/rocking.cdx.json
	$(UV) venv --quiet --clear --python $(PYTHON) build/wheel
	$(UV) pip install --quiet --python build/wheel --constraint deploy/service.lock dist/*.whl # checks the hashes, too
	build/wheel/bin/rocking response --pulse sine --width 0.4m --height 1.6m --peak-acceleration 0.6g --period 0.5s

# Extras `seismic` and `slurm` are optional: they are not locked.
LOCKED := service assessment plot sheets dask workflow docs dev

RESOLVE = $(UV) pip compile --python $(PYTHON) --generate-hashes --no-header --no-annotate --quiet

lock: $(UV) ## resolve pyproject.toml into environment.lock (UPGRADE=--upgrade: newest versions) and, from it, the locks of deploy/
	$(RESOLVE) pyproject.toml $(LOCKED:%=--extra %) $(UPGRADE) --output-file environment.lock
	$(RESOLVE) pyproject.toml --extra service --extra assessment --constraint environment.lock --output-file deploy/service.lock
	$(RESOLVE) --group release --constraint environment.lock $(UPGRADE) --output-file deploy/release.lock

environment: .venv/project ## make the environment .venv and compile the kernels
	@:

results/manifest.json: | .venv/project
	$(MAKE) reproduce

atlas/results/manifest.json atlas-small/results/manifest.json: %/results/manifest.json: | .venv/project
	$(MAKE) $*

%/manifest.json:
	@echo 'RESULTS=$* is not allowed: no $@; allowed: results, atlas-small/results, atlas/results, or a folder with data sets and their manifest' >&2; exit 1

build/uv/bin/uv:
	@test -n '$(PYTHON)' || { echo 'No Python 3.11 or newer found; use make PYTHON=/path/to/python3.11' >&2; exit 1; }
	@$(PYTHON) -m venv --clear build/uv || { \
	    echo 'python3 -m venv needs ensurepip: on Debian, apt-get install python3-venv, then make again' >&2; exit 1; }
	@sed -n '/^uv==/,/[^\\]$$/p' deploy/release.lock >build/uv/uv.lock
	@build/uv/bin/pip install --quiet --require-hashes --requirement build/uv/uv.lock

# No isolation: packages without a wheel are built with the pinned build tool, which is installed first; with isolation
# an unpinned one would be fetched.
INSTALL := $(UV) pip install --quiet --python .venv --require-hashes --no-build-isolation

# The copy of the lock in .venv is written last: it records the lock that the environment was made from, and that the
# environment is complete. Contents are compared, not time stamps, so that a new checkout of the same lock needs nothing.
.venv/environment.lock: $(shell cmp -s environment.lock .venv/environment.lock || echo FORCE) | $(UV)
	@echo 'Making .venv from environment.lock ...'
	@$(UV) venv --quiet --clear --seed --python '$(or $(PYTHON),3.11)' .venv
	@sed -n '/^setuptools==/,/[^\\]$$/p' environment.lock >.venv/build-tool.lock
	@$(INSTALL) -r .venv/build-tool.lock && $(INSTALL) -r environment.lock
	@cp environment.lock $@

# The project is an editable install; its build tool is in the lock, so that nothing is fetched.
.venv/project: .venv/environment.lock pyproject.toml | $(UV)
	@$(UV) pip install --quiet --python .venv --no-deps --no-build-isolation --editable .
	@echo 'Compiling the kernels (once, up to a minute) ...'
	@.venv/bin/python -m rocking.precompile
	@touch $@
