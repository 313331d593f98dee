from maegawa2010.paper.inputs import CLAIM_TABLES, POINT_TABLES
from maegawa2010.paper.documents import cited_results

PAPER_SOURCE = ROOT / "paper"
# The article describes the paper's slider, so it is not made for another slider.
PAPER = ["results/paper.pdf", "results/supplement.pdf"] if HAS_LONG else []


rule eq15:
    """Check Eq. 15 by algebra and against the runs."""
    input:
        runs=RUNS,
    output:
        eq15=report("results/tables/eq15.csv", category="Tables"),
    log:
        "results/logs/eq15.log",
    resources:
        seconds=2,
    params:
        duration=config["duration"],
        code=digest("eq15"),
    script:
        "../scripts/eq15.py"


if set(PAPERS_SCENES) <= set(FIG13):

    rule judge_claims:
        """Evaluate the paper's claims from the tables."""
        input:
            tables=collect("results/tables/{table}.csv", table=sorted({*CLAIM_TABLES, *POINT_TABLES})),
            checks=["results/tables/committed_resolution.csv"] if IS_COMMITTED else [],
            texts=[PAPERS / f"paper/{name}.csv" for name in ("claims", "open_points")],
        output:
            claims=report("results/tables/claims.csv", category="Tables"),
            open_points=report("results/tables/open_points.csv", category="Tables"),
        log:
            "results/logs/judge_claims.log",
        localrule: True
        params:
            code=digest("judge_claims"),
        script:
            "../scripts/judge_claims.py"


rule fig09:
    """Draw the model (Fig. 9)."""
    output:
        report(
            "results/figures/fig09.svg",
            caption="../report/fig09.rst",
            category="Reproduction",
            labels={"figure": "fig09: the model: blocks on springs, pushed through a spring"},
        ),
        collect("results/figures/fig09.{kind}", kind=MORE_FORMATS),
    log:
        "results/logs/fig09.log",
    localrule: True
    params:
        code=digest("fig09"),
    script:
        "../scripts/fig09.py"


rule write_paper:
    """Typeset the article or the supplement with the numbers and figures of the results."""
    input:
        # Tables and figures that the text cites. The script refuses a result that no rule makes.
        shown=lambda wildcards: [
            path
            for path in cited_results(PAPER_SOURCE / f"{wildcards.document}.typ")
            if any(rule.is_producer(path) for rule in workflow.rules)
        ],
        main=PAPER_SOURCE / "{document}.typ",
        source=sorted(path for path in PAPER_SOURCE.glob("*.*") if path.suffix != ".pdf"),
        about=ROOT / "CITATION.cff",
    output:
        "results/{document}.pdf",
    log:
        "results/logs/write_{document}.log",
    wildcard_constraints:
        document="paper|supplement",
    localrule: True
    params:
        code=digest("write_paper"),
    script:
        "../scripts/write_paper.py"


rule paper_figures:
    """Figs. 9 to 13, and three slips as a figure and as a film."""
    input:
        rules.fig09.output,
        collect("results/figures/{scene}.{kind}", scene=SCENES, kind=["svg", *MORE_FORMATS]),
        rules.fig13.output,
        rules.draw_slips.output,
    localrule: True


rule paper:
    """Eq. 15, the claims, Fig. 9, the article and its supplement."""
    input:
        rules.eq15.output,
        rules.judge_claims.output if set(PAPERS_SCENES) <= set(FIG13) else [],
        rules.fig09.output,
        PAPER,
    localrule: True


onstart:
    if not HAS_LONG:
        own = "study resolution" if IS_PAPER_SLIDER else "slider"
        print(
            f"paper.pdf is not made: it describes the paper's {own}, but the configuration has another one",
            file=sys.stderr,
        )


RESULTS.append(rules.paper.input)
