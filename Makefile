# `make all` reproduces the paper, `make test` tests it; both build .venv first, from requirements.lock with its hashes.
CORES ?= 2
PYTHON ?= python3
BIN := .venv/bin
READY := .venv/ready

.PHONY: all test results check golden bench lock lint clean

all: results
	@$(BIN)/python workflow/scripts/print_reproduction.py results/tables/reproduction.csv results/figures

test: results
	$(BIN)/pytest -n $(CORES) --dist loadfile

results: $(READY)
	$(BIN)/snakemake --quiet rules host -c$(CORES) all

# Judges the results as they lie there: nothing is computed anew.
check: $(READY)
	@$(BIN)/python workflow/scripts/check_claims.py paper/claims.yaml results/tables tests/golden/claims.csv

golden: results
	$(BIN)/python tests/golden/regenerate.py

bench: $(READY)
	$(BIN)/python benchmarks/bench.py

lint: $(READY)
	$(BIN)/ruff check . && $(BIN)/ruff format --check . && $(BIN)/snakefmt --check Snakefile workflow && $(BIN)/mypy

lock: $(READY)
	$(BIN)/uv pip compile pyproject.toml --all-extras --universal --python-version 3.11 --generate-hashes --no-emit-index-url --no-header -q -o requirements.lock

clean:
	rm -rf .venv .snakemake results/*/

$(READY): requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and f"Python 3.11 or later is needed, and $(PYTHON) is {sys.version.split()[0]}: set PYTHON=")'
	rm -rf .venv && $(PYTHON) -m venv .venv
	awk '/^[^ #]/ {wanted = /^uv==/} wanted' requirements.lock > .venv/uv.txt
	$(BIN)/python -m pip install -q --no-deps --require-hashes -r .venv/uv.txt
	$(BIN)/uv pip sync -q -p $(BIN)/python --compile-bytecode --require-hashes requirements.lock
	$(BIN)/uv pip install -q -p $(BIN)/python --offline --no-deps --no-build-isolation -e .
	$(BIN)/python -m precursors.warm_up
	touch $(READY)
