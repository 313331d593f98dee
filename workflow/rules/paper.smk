from precursors.reproduction.paper import configured, files_shown, is_configured, read_sources, tables_needed

PAPER_SOURCE = Path(ROOT) / "paper"

try:
    PAPERS_NUMBERS = read_sources(PAPER_SOURCE / "numbers.yaml")
except ValueError as error:
    raise WorkflowError(str(error)) from None

# Like the ledger, the paper is about the paper's three scenes, and needs them as the configuration has them here.
PAPER = (
    ["results/paper.pdf", "results/numbers.json"] if LEDGER and is_configured(PAPERS_NUMBERS, config) else []
)
SHOWN = files_shown(PAPER_SOURCE)


rule write_paper:
    input:
        main=PAPER_SOURCE / "main.typ",
        source=sorted(
            [*PAPER_SOURCE.rglob("*.typ"), PAPER_SOURCE / "numbers.yaml", *PAPER_SOURCE.glob("*.bib")]
        ),
        shown=SHOWN,
        tables=collect("results/tables/{table}.csv", table=tables_needed(PAPERS_NUMBERS)),
        code=code_of("write_paper"),
    output:
        pdf="results/paper.pdf",
        numbers="results/numbers.json",
    log:
        "results/logs/write_paper.log",
    benchmark:
        "results/benchmarks/write_paper.tsv"
    threads: 1
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
