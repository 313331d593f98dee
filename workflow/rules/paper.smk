from precursors.reproduction.ledger.claims import read_claims, scenes_needed
from precursors.reproduction.ledger.claims import tables_needed as tables_claimed
from precursors.reproduction.paper import configured, files_shown, is_configured, read_sources, tables_needed

PAPER_SOURCE = ROOT / "paper"
CLAIMS_FILE = PAPER_SOURCE / "claims.yaml"
FIG13 = config["fig13"]

try:
    CLAIMS = read_claims(CLAIMS_FILE)
    PAPERS_NUMBERS = read_sources(PAPER_SOURCE / "numbers.yaml")
except ValueError as error:
    raise WorkflowError(str(error)) from None

# Claims and paper are about the paper's three scenes: a configuration without them has neither.
LEDGER = ["results/tables/claims.csv"] if set(scenes_needed(CLAIMS)) <= set(FIG13) else []
PAPER = (
    ["results/paper.pdf", "results/numbers.json"] if LEDGER and is_configured(PAPERS_NUMBERS, config) else []
)
SHOWN = files_shown(PAPER_SOURCE)


rule paper:
    input:
        LEDGER,
        PAPER,
    localrule: True


rule tabulate_measures:
    input:
        runs=collect("results/runs/{scene}.h5", scene=FIG13),
        code=package("model", "solver", "analysis", "reproduction/measures"),
    output:
        table="results/tables/measures.csv",
    log:
        "results/logs/tabulate_measures.log",
    localrule: True
    params:
        scenes=FIG13,
    script:
        "../scripts/tabulate_measures.py"


rule tabulate_erratum:
    input:
        runs=collect("results/runs/{scene}.h5", scene=FIG13),
        code=package("model", "solver", "analysis", "methods", "reproduction/erratum"),
    output:
        table=report("results/tables/erratum.csv", category="Tables"),
    log:
        "results/logs/tabulate_erratum.log",
    localrule: True
    params:
        scenes=FIG13,
    script:
        "../scripts/tabulate_erratum.py"


rule judge_claims:
    input:
        tables=collect("results/tables/{table}.csv", table=tables_claimed(CLAIMS)),
        claims=CLAIMS_FILE,
        code=package("reproduction/ledger"),
    output:
        table=report("results/tables/claims.csv", category="Tables"),
    log:
        "results/logs/judge_claims.log",
    localrule: True
    script:
        "../scripts/judge_claims.py"


rule write_paper:
    input:
        main=PAPER_SOURCE / "main.typ",
        source=sorted(
            [*PAPER_SOURCE.rglob("*.typ"), PAPER_SOURCE / "numbers.yaml", *PAPER_SOURCE.glob("*.bib")]
        ),
        shown=SHOWN,
        tables=collect("results/tables/{table}.csv", table=tables_needed(PAPERS_NUMBERS)),
        code=package("reproduction/ledger/rules", "reproduction/paper"),
    output:
        pdf="results/paper.pdf",
        numbers="results/numbers.json",
    log:
        "results/logs/write_paper.log",
    localrule: True
    params:
        config=lambda wildcards: configured(PAPERS_NUMBERS, config),
        # Captions name the rule that made what they show, and the modules that drew it.
        makers=lambda wildcards: {
            file: {
                "rule": made_by.name,
                "modules": [
                    Path(module).relative_to(LIBRARY).as_posix()
                    for module in map(str, made_by.input)
                    if Path(module).parent.name == "figures" and Path(module).name != "style.py"
                ],
            }
            for file in SHOWN
            for made_by in workflow.rules
            if made_by.is_producer(file)
        },
    script:
        "../scripts/write_paper.py"


# All results but their provenance, which comes after them.
RESULTS = [
    rules.paper_figures.input,
    rules.mu_sapp.input,
    rules.eq15.input,
    rules.accuracy.input,
    rules.hierarchy.input,
    rules.ensembles.input,
    rules.explorer.input,
    rules.paper.input,
]


rule write_provenance:
    input:
        RESULTS,
        code=package("support"),
    output:
        json="results/provenance.json",
    log:
        "results/logs/write_provenance.log",
    localrule: True
    params:
        root=str(ROOT),
        config=config,
    script:
        "../scripts/write_provenance.py"
