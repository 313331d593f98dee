# `make all` reproduces the paper and `make test` runs the tests. Both first build .venv from requirements.lock, with hashes.
# Packages for tests and developers are in requirements-dev.lock and are installed when first needed.
CORES ?= 2
PYTHON ?= python3
BIN := .venv/bin
READY := .venv/ready
DEV := .venv/dev
LOCK := pyproject.toml --universal --python-version 3.11 --generate-hashes --no-emit-index-url --no-header -q
# With this variable every job would compile its imports again.
unexport PYTHONDONTWRITEBYTECODE
# uv and Snakemake need a cache directory, even if the home directory is not writable.
ifeq ($(XDG_CACHE_HOME)$(shell test -w "$$HOME" && echo home),)
export XDG_CACHE_HOME := $(CURDIR)/.snakemake/cache
endif

TARGETS := all test test-cluster results check report golden docs bench article codecheck lock lint clean
.PHONY: $(TARGETS)

all: results
	@$(BIN)/python workflow/scripts/print_reproduction.py results

test: results $(DEV)
	$(BIN)/pytest -n $(CORES) --dist worksteal

# Runs the ensembles as jobs of a real SLURM. Error 77 means that SLURM is missing and nothing was tested.
test-cluster: $(DEV)
	@CORES=$(CORES) tests/cluster/run

results: $(READY)
	@$(BIN)/snakemake --quiet rules host -c$(CORES) all || { status=$$?; [ -z "$$(ls .snakemake/locks 2>/dev/null)" ] || \
	  echo "make: another run is at work here, or a run was killed. If it was killed: $(BIN)/snakemake --unlock && make $(MAKECMDGOALS)" >&2; \
	  exit $$status; }

# Checks the existing results without recomputing them.
check: $(READY)
	@$(BIN)/python workflow/scripts/check_claims.py

# All figures with captions, rules and computing times, in one file for a browser.
report: results
	$(BIN)/snakemake --report results/report.html --report-stylesheet workflow/report/report.css -- all

# Makes all files of codecheck.yml again from the beginning and compares them with tests/golden.
codecheck: $(READY)
	$(BIN)/snakemake --quiet rules host -c$(CORES) --forceall $$($(BIN)/python workflow/scripts/codecheck.py --list)
	@$(BIN)/python workflow/scripts/codecheck.py
	@# Also update the results that depend on these files, so that `make all` has nothing left to do.
	@$(BIN)/snakemake --quiet rules host -c$(CORES) all

golden: results $(DEV)
	PYTHONPATH=tests:workflow/scripts $(BIN)/python -m golden.regenerate

# Writes docs/ and the reference from the docstrings to results/docs.
docs: $(DEV)
	$(BIN)/pdoc -o results/docs -d numpy precursors precursors.analysis.horizon maegawa2010.methods docs/guide.py

bench: $(READY)
	$(BIN)/python benchmarks/bench.py $(if $(filter-out undefined,$(origin METHOD)),--method "$(METHOD)")

# Makes the long studies that the article shows, in half an hour. Two of them measure times, so run nothing else meanwhile.
article: $(READY)
	$(BIN)/snakemake --quiet rules host -c1 --directory full --configfile config.yaml workflow/full.yaml -- article

lint: $(DEV)
	$(BIN)/ruff check . && $(BIN)/ruff format --check . && $(BIN)/snakefmt --check Snakefile workflow docs/examples/*.smk && $(BIN)/mypy && $(BIN)/lint-imports

lock: $(READY)
	$(BIN)/uv pip compile $(LOCK) --extra workflow --extra proof --extra peers --extra paper --extra build -o requirements.lock
	$(BIN)/uv pip compile $(LOCK) --all-extras -c requirements.lock -o requirements-dev.lock

clean:
	rm -rf .venv .snakemake full
	find results -mindepth 1 ! -path results/README.md -delete

$(READY): requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and f"Python 3.11 or later is needed, and $(PYTHON) is {sys.version.split()[0]}: set PYTHON=")'
	rm -rf .venv && $(PYTHON) -m venv .venv
	awk '/^[^ #]/ {wanted = /^uv==/} wanted' requirements.lock > .venv/uv.txt
	$(BIN)/python -m pip install -q --no-deps --require-hashes -r .venv/uv.txt
	$(BIN)/uv pip sync -q -p $(BIN)/python --require-hashes --build-constraints requirements.lock requirements.lock
	$(BIN)/uv pip install -q -p $(BIN)/python --offline --no-deps --no-build-isolation -e .
	@# Compile the solver and the methods if they are not in the user's cache.
	$(BIN)/python -c "from precursors import Chain, simulate; simulate(Chain.from_slider(), 0.4)" & \
	$(BIN)/python -c "from precursors import Chain; from maegawa2010.methods import METHODS; \
	  from maegawa2010.studies.models.quasistatic import quasistatic_slips; chain = Chain.from_slider(); quasistatic_slips(chain); \
	  [METHODS[name].solve(chain, 0.4, 1e-6, None) for name in ('rk4', 'rk4_located', 'leapfrog', \
	  'moreau_jean_half', 'cvode_adams') if name in METHODS]" & \
	wait
	touch $(READY)

$(DEV): $(READY) requirements-dev.lock
	@# Compile the auditor, which the workflow does not use but the tests do.
	$(BIN)/python -c "from precursors import Chain, audit, simulate; audit(simulate(Chain.from_slider(), 0.4))" & \
	$(BIN)/uv pip install -q -p $(BIN)/python --require-hashes --build-constraints requirements-dev.lock -r requirements-dev.lock && wait
	touch $(DEV)
