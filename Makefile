# Everything a user types: `make help`. Each target makes what it needs, the environment included; Python 3.11 and make
# suffice. The environment is .venv, made from the hash-pinned environment.lock, and made again when that file's content
# changes; inside it (`. .venv/bin/activate`) snakemake, rocking and pytest work as usual.

MAKEFLAGS += --no-print-directory
.DEFAULT_GOAL := help
.PHONY: help reproduce verify test browser serve bench stress fuzz mutants lock environment FORCE

HOST ?= 127.0.0.1
PORT ?= 8000

# The lock is resolved for Python 3.11; a newer one is the second choice.
PYTHON ?= $(shell for p in python3.11 python3; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)
export PATH := $(CURDIR)/.venv/bin:$(PATH)
# Another active environment must not leak into this one.
unexport VIRTUAL_ENV PYTHONPATH PYTHONHOME
export PIP_DISABLE_PIP_VERSION_CHECK := 1

# A run ends with the make that began it.
RUN := ROCKING_RUN=$$PPID python -m workflow.run

help: ## show this list
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/make \1\t\2/p' Makefile | expand -t 18

reproduce: .venv/project ## data sets, figures and claims of the paper into results/ (CONFIG=FILE for another configuration)
	$(RUN) $(if $(CONFIG),--configfile $(CONFIG))

verify: .venv/project ## read every product in results/ again and name what differs from the manifest
	python -m workflow.verify

test: .venv/project browser ## format, lint, types and all tests, among them a small real run of the workflow
	ruff format --check .
	ruff check .
	mypy
	snakefmt --check Snakefile workflow
	pytest --numprocesses auto --dist loadfile

browser: .venv/project ## a Chromium for the tests of the page, fetched if there is none (ROCKING_NO_BROWSER=1: without)
	@test -n '$(ROCKING_NO_BROWSER)' || python -m tests.api.explorer.chromium

serve: .venv/project | results/manifest.json ## the HTTP service over results/, made first if missing (HOST=, PORT=)
	rocking serve --host $(HOST) --port $(PORT) --results results

bench: .venv/project ## time and error beside other integrators, cost, interpolation: results/benchmarks/; ten minutes
	$(RUN) $(if $(CONFIG),--configfile $(CONFIG) --) bench

stress: .venv/project ## 3,800 hard cases against 192-bit answers: fates, digits, symmetries, times; a minute or two
	python -m stress

fuzz: .venv/project ## ask the service 5,000 questions that a machine makes up; three minutes (SEED= for others)
	FUZZ_CASES=5500 FUZZ_SEED=$(or $(SEED),1) pytest -q tests/api/test_api_fuzz.py

mutants: .venv/project ## change single operators and constants, and see whether the tests notice; hours (COUNT=, SEED=)
	python -m stress.mutations --count $(or $(COUNT),32) --seed $(or $(SEED),1)

lock: ## resolve pyproject.toml anew into environment.lock (UPGRADE=--upgrade for the newest versions)
	@test -x '$(UV)' || { $(PYTHON) -m venv --clear build/uv && build/uv/bin/pip install --quiet uv; }
	$(UV) pip compile pyproject.toml --all-extras --python $(PYTHON) \
	    --generate-hashes --no-header --no-annotate --quiet $(UPGRADE) --output-file environment.lock

environment: .venv/project ## the environment .venv alone
	@:

UV := $(or $(shell command -v uv),build/uv/bin/uv)

results/manifest.json: | .venv/project
	$(MAKE) reproduce

# No isolation: the build tool is installed first, pinned like the rest, and builds what has no wheel; pip would fetch
# another one for that, unpinned.
INSTALL := .venv/bin/python -m pip install --quiet --require-hashes --no-build-isolation --use-pep517

# The copy of the lock inside .venv is written last: it tells which lock the environment was made from, and that it is
# complete. Its content decides, not a time stamp: a fresh checkout of the same lock costs nothing.
.venv/environment.lock: $(shell cmp -s environment.lock .venv/environment.lock || echo FORCE)
	@test -n '$(PYTHON)' || { echo 'No Python 3.11 or newer found; name one: make PYTHON=/path/to/python3.11' >&2; exit 1; }
	@echo 'Making .venv from environment.lock (about a minute) ...'
	@$(PYTHON) -m venv --clear .venv || { \
	    echo 'python3 -m venv needs ensurepip: on Debian, apt-get install python3-venv, then make again' >&2; exit 1; }
	@sed -n '/^setuptools==/,/[^\\]$$/p' environment.lock >.venv/build-tool.lock
	@$(INSTALL) -r .venv/build-tool.lock && $(INSTALL) -r environment.lock
	@cp environment.lock $@

# The project itself, as an editable install: the lock holds its build tool, so nothing is fetched.
.venv/project: .venv/environment.lock pyproject.toml
	@.venv/bin/python -m pip install --quiet --no-deps --no-build-isolation --editable .
	@echo 'Compiling the kernels (once, up to a minute) ...'
	@.venv/bin/python -m rocking.precompile
	@touch $@
