# claims, paper.pdf

from precursors.reproduction import claims, numbers
from precursors.reproduction.pages import files_shown
from precursors.reproduction.tables import SCENES as PAPERS_SCENES

PAPER_SOURCE = ROOT / "paper"
FIG13 = config["fig13"]
# Claims and paper are about the paper's three scenes, and the paper names their load cells.
CLAIMS = ["results/tables/claims.csv"] if set(PAPERS_SCENES) <= set(FIG13) else []
HAVE_CELLS = CLAIMS and all("load_cell_a" in config["scenes"][scene] for scene in PAPERS_SCENES)
PAPER = ["results/paper.pdf", "results/numbers.json"] if HAVE_CELLS else []
SHOWN = files_shown(PAPER_SOURCE)


rule paper:
    input:
        CLAIMS,
        PAPER,
    localrule: True


rule tabulate_measures:
    input:
        runs=collect("results/runs/{scene}.h5", scene=FIG13),
    output:
        table="results/tables/measures.csv",
    log:
        "results/logs/tabulate_measures.log",
    localrule: True
    params:
        scenes=FIG13,
        code=digest("tabulate_measures"),
    script:
        "../scripts/tabulate_measures.py"


rule evaluate_claims:
    input:
        tables=collect("results/tables/{table}.csv", table=claims.TABLES),
    output:
        table=report("results/tables/claims.csv", category="Tables"),
    log:
        "results/logs/evaluate_claims.log",
    localrule: True
    params:
        code=digest("evaluate_claims"),
    script:
        "../scripts/evaluate_claims.py"


rule write_paper:
    input:
        tables=collect("results/tables/{table}.csv", table=numbers.TABLES),
        shown=SHOWN,
        main=PAPER_SOURCE / "main.typ",
        source=sorted(path for path in PAPER_SOURCE.rglob("*.*") if path.is_file()),
    output:
        pdf="results/paper.pdf",
        numbers="results/numbers.json",
    log:
        "results/logs/write_paper.log",
    localrule: True
    params:
        config={key: config[key] for key in numbers.KEYS},
        # Captions name the rule that made what they show.
        rules=lambda wildcards: {
            file: made_by.name for file in SHOWN for made_by in workflow.rules if made_by.is_producer(file)
        },
        code=digest("write_paper"),
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
    output:
        json="results/provenance.json",
    log:
        "results/logs/write_provenance.log",
    localrule: True
    params:
        root=str(ROOT),
        config=config,
        code=digest("write_provenance"),
    script:
        "../scripts/write_provenance.py"
