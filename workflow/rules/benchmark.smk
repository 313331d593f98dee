# Lists of transitions of other solvers, scored; the problems as plain files

BENCHMARKS = ROOT / "benchmarks"

TABLES["benchmark"] = Table(
    function="precursors.benchmark.score:score_table",
    message="scoring the lists of transitions of other solvers",
    inputs={"solvers": str(BENCHMARKS / "solvers.csv")},
    options={"folder": str(BENCHMARKS / "results")},
    also=sorted([*PROOFS.glob("*.json.gz"), *(BENCHMARKS / "results").glob("*.csv")]),
    seconds=2,
)


# On demand: the reference problems of docs/benchmark.md as plain files, and in one archive.
rule write_benchmark:
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
