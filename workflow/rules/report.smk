# Tables that the report shows, and what each of them shows. Browsers save CSV files instead of showing them, so each
# gets a page; its caption is ../report/tables/{table}.rst, for the slip tables of the scenes slips.rst.
TABLES = {
    "mu_sapp": "apparent static friction, definition by definition",
    "reproduction": "paper and reproduction",
    "eq15": "the derivation of Eq. 15",
    "definitions": "what every reading of the definitions gives",
    "erratum": "misprints and open points of the paper",
    "certificates": "what is proved",
    "solver_vs_proof": "the solver against the proof",
    "lyapunov": "largest Lyapunov exponents",
    "work_precision": "speed and accuracy of every method",
    "step_sweep": "the paper's numbers against the step of RK4",
    "failures": "ways to fail",
    "ladder": "the ladder of models",
    "robustness": "robust, sensitive or fragile",
    "spread": "what small changes make of the numbers",
    "resolution": "numbers against the number of blocks",
    "resolution_limits": "numbers carried on to infinitely many blocks",
    "resolution_models": "numbers against the number of blocks, with viscosity and interface springs",
    "long_runs_statistics": "peak loads of hundreds of global slips",
}
TABLES |= {"claims": "what the paper states, and the verdict"} if LEDGER else {}
SLIPS = {f"{scene}_slips": f"slip events of {scene}" for scene in SCENES}
ANSWERS = {f"{scene}_answers": f"what the model of {scene} answers" for scene in ASKED}
PAGES = TABLES | SLIPS | ANSWERS
TEXTS = {page: page for page in TABLES} | dict.fromkeys(SLIPS, "slips") | dict.fromkeys(ANSWERS, "answers")
CAPTIONS = {page: Path(f"{ROOT}/workflow/report/tables/{text}.rst") for page, text in TEXTS.items()}


wildcard_constraints:
    page="|".join(PAGES),


rule write_table_page:
    input:
        table="results/tables/{page}.csv",
        code=code_of("write_table_page"),
    output:
        page=report(
            "results/pages/{page}.html",
            caption="../report/table.rst",
            category="Tables",
            labels=lambda wildcards: {"table": f"{wildcards.page}: {PAGES[wildcards.page]}"},
        ),
    log:
        "results/logs/write_table_page/{page}.log",
    benchmark:
        "results/benchmarks/write_table_page/{page}.tsv"
    threads: 1
    params:
        caption=lambda wildcards: CAPTIONS[wildcards.page].read_text(encoding="utf-8"),
    script:
        "../scripts/write_table_page.py"


# What `make report` needs besides `all`.
rule table_pages:
    input:
        collect("results/pages/{page}.html", page=PAGES),
