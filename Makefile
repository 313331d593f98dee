# `make all` reproduces the paper, `make test` tests it; both build .venv first, from requirements.lock with its hashes.
# What only tests and developers need is in requirements-dev.lock, and added when it is first asked for.
CORES ?= 2
PYTHON ?= python3
BIN := .venv/bin
READY := .venv/ready
DEV := .venv/dev
LOCK := pyproject.toml --universal --python-version 3.11 --generate-hashes --no-emit-index-url --no-header -q
# Python keeps bytecode, whatever the user does elsewhere: every job would compile its imports again.
unexport PYTHONDONTWRITEBYTECODE
# Caches of uv and Snakemake, which cannot do without, where the home directory cannot be written.
ifeq ($(XDG_CACHE_HOME)$(shell test -w "$$HOME" && echo home),)
export XDG_CACHE_HOME := $(CURDIR)/.snakemake/cache
endif

TARGETS := all test test-cluster results check report golden docs bench article codecheck lock lint clean
.PHONY: $(TARGETS)

all: results
	@$(BIN)/python workflow/scripts/print_reproduction.py results

test: results $(DEV)
	$(BIN)/pytest -n $(CORES) --dist worksteal

# The ensembles as jobs of a real SLURM; Error 77: there is none here, and nothing was tested.
test-cluster: $(DEV)
	@CORES=$(CORES) tests/cluster/run

results: $(READY)
	@$(BIN)/snakemake --quiet rules host -c$(CORES) all || { status=$$?; [ -z "$$(ls .snakemake/locks 2>/dev/null)" ] || \
	  echo "make: another run is at work here, or one was killed. If none is: $(BIN)/snakemake --unlock && make $(MAKECMDGOALS)" >&2; \
	  exit $$status; }

# Checks the existing results without recomputing them.
check: $(READY)
	@$(BIN)/python workflow/scripts/check_claims.py

# Every figure with its caption, the rule that made it and its time, in one file for a browser.
report: results
	$(BIN)/snakemake --report results/report.html --report-stylesheet workflow/report/report.css -- all

# What codecheck.yml lists, made again from nothing and compared with tests/golden.
codecheck: $(READY)
	$(BIN)/snakemake --quiet rules host -c$(CORES) --forceall $$($(BIN)/python workflow/scripts/codecheck.py --list)
	@$(BIN)/python workflow/scripts/codecheck.py
	@# What is made from these files is made again too, so that `make all` has nothing left to do.
	@$(BIN)/snakemake --quiet rules host -c$(CORES) all

golden: results $(DEV)
	PYTHONPATH=tests:workflow/scripts $(BIN)/python -m golden.regenerate

# Pages of the interface, from the docstrings, and of docs/, in results/docs.
docs: $(DEV)
	$(BIN)/pdoc -o results/docs -d numpy precursors precursors.analysis.horizon maegawa2010.methods docs/guide.py

bench: $(READY)
	$(BIN)/python benchmarks/bench.py $(if $(filter-out undefined,$(origin METHOD)),--method "$(METHOD)")

# The long studies that the article shows, TIME with nothing else running: two of them measure seconds.
article: $(READY)
	$(BIN)/snakemake --quiet rules host -c1 --directory full --configfile config.yaml workflow/full.yaml -- article

lint: $(DEV)
	$(BIN)/ruff check . && $(BIN)/ruff format --check . && $(BIN)/snakefmt --check Snakefile workflow && $(BIN)/mypy && $(BIN)/lint-imports

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
	@# Compile what is not in the user's cache, on two cores.
	$(BIN)/python -c "from precursors import Chain, simulate; simulate(Chain.from_slider(), 0.4)" & \
	$(BIN)/python -c "from precursors import Chain; from maegawa2010.methods import METHODS; \
	  from maegawa2010.studies.models.quasistatic import quasistatic_slips; chain = Chain.from_slider(); quasistatic_slips(chain); \
	  [METHODS[name].solve(chain, 0.4, 1e-6, None) for name in ('rk4', 'rk4_located', 'leapfrog', \
	  'moreau_jean_half', 'cvode_adams') if name in METHODS]" & \
	wait
	touch $(READY)

$(DEV): $(READY) requirements-dev.lock
	@# What only tests compile.
	$(BIN)/python -c "from precursors import Chain, audit, simulate; audit(simulate(Chain.from_slider(), 0.4))" & \
	$(BIN)/uv pip install -q -p $(BIN)/python --require-hashes --build-constraints requirements-dev.lock -r requirements-dev.lock && wait
	touch $(DEV)
