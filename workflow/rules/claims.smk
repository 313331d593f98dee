from precursors.reproduction.ledger.claims import read_claims, scenes_needed, tables_needed

PAPERS_SCENES = config["fig13"]
CLAIMS_FILE = os.path.normpath(f"{ROOT}/paper/claims.yaml")

try:
    CLAIMS = read_claims(CLAIMS_FILE)
except ValueError as error:
    raise WorkflowError(str(error)) from None

# The claims are about the paper's three scenes; a configuration without them has no ledger.
LEDGER = ["results/tables/claims.csv"] if set(scenes_needed(CLAIMS)) <= set(PAPERS_SCENES) else []


rule tabulate_definitions:
    input:
        code=code_of("tabulate_definitions"),
    output:
        table="results/tables/definitions.csv",
    log:
        "results/logs/tabulate_definitions.log",
    benchmark:
        "results/benchmarks/tabulate_definitions.tsv"
    threads: 1
    params:
        slider=config["chain"],
        duration=config["duration"],
        degrees=config["definitions"]["theta"],
        load_drops=config["definitions"]["load_drop"],
        paper=[config["scenes"][scene].get("paper", {}) for scene in PAPERS_SCENES],
    script:
        "../scripts/tabulate_definitions.py"


rule draw_definitions:
    input:
        table="results/tables/definitions.csv",
        code=code_of("draw_definitions"),
    output:
        png="results/figures/definitions.png",
        svg=report(
            "results/figures/definitions.svg",
            caption="../report/definitions.rst",
            category="Reproduction",
            labels={"figure": "definitions: what every reading gives"},
        ),
    log:
        "results/logs/draw_definitions.log",
    benchmark:
        "results/benchmarks/draw_definitions.tsv"
    threads: 1
    script:
        "../scripts/draw_definitions.py"


rule tabulate_measures:
    input:
        runs=collect("results/runs/{scene}.h5", scene=PAPERS_SCENES),
        code=code_of("tabulate_measures"),
    output:
        table="results/tables/measures.csv",
    log:
        "results/logs/tabulate_measures.log",
    benchmark:
        "results/benchmarks/tabulate_measures.tsv"
    threads: 1
    params:
        scenes=PAPERS_SCENES,
    script:
        "../scripts/tabulate_measures.py"


rule tabulate_erratum:
    input:
        runs=collect("results/runs/{scene}.h5", scene=PAPERS_SCENES),
        code=code_of("tabulate_erratum"),
    output:
        table="results/tables/erratum.csv",
    log:
        "results/logs/tabulate_erratum.log",
    benchmark:
        "results/benchmarks/tabulate_erratum.tsv"
    threads: 1
    params:
        scenes=PAPERS_SCENES,
    script:
        "../scripts/tabulate_erratum.py"


rule judge_claims:
    input:
        tables=collect("results/tables/{table}.csv", table=tables_needed(CLAIMS)),
        claims=CLAIMS_FILE,
        code=code_of("judge_claims"),
    output:
        table="results/tables/claims.csv",
    log:
        "results/logs/judge_claims.log",
    benchmark:
        "results/benchmarks/judge_claims.tsv"
    threads: 1
    script:
        "../scripts/judge_claims.py"
