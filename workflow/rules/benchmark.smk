# Lists of transitions of other solvers, scored; the problems as plain files

BENCHMARKS = ROOT / "benchmarks"


rule tabulate_benchmark:
    """Score the lists of transitions of other solvers."""
    input:
        solvers=BENCHMARKS / "solvers.csv",
        results=sorted((BENCHMARKS / "results").glob("*.csv")),
        certificates=sorted(PROOFS.glob("*.json.gz")),
    output:
        benchmark=report("results/tables/benchmark.csv", category="Tables"),
    log:
        "results/logs/tabulate_benchmark.log",
    resources:
        seconds=2,
    params:
        code=digest("tabulate_benchmark"),
    message:
        "scoring the lists of transitions of other solvers"
    script:
        "../scripts/tabulate_benchmark.py"


rule write_benchmark:
    """Write the reference problems of docs/benchmark.md as plain files and in one archive (on demand)."""
    input:
        certificates=sorted(PROOFS.glob("*.json.gz")),
        page=ROOT / "docs/benchmark.md",
        licence=ROOT / "LICENSE-text",
    output:
        folder=directory("results/benchmark"),
        archive="results/benchmark.zip",
    log:
        "results/logs/benchmark.log",
    localrule: True
    params:
        code=digest("write_benchmark"),
    message:
        "writing the reference problems"
    script:
        "../scripts/write_benchmark.py"


rule benchmark:
    """Scores of other solvers."""
    input:
        rules.tabulate_benchmark.output,
    localrule: True


RESULTS.append(rules.benchmark.input)
