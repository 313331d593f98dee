proved = {
    chain: abs(parse_theta(config["horizon"]["proved"][chain].get("theta", 0)))
    for chain in config["horizon"]["compared"]
}
EVEN = min(proved, key=proved.get)  # the chain with the most even load


rule tabulate_work_precision:
    """Time all methods on a proved chain."""
    input:
        certificate=f"results/certificates/chains/{EVEN}.json.gz",
        methods=PAPERS / "methods/methods.csv",
    output:
        work_precision=report("results/tables/work_precision.csv", category="Tables"),
    log:
        "results/logs/tabulate_work_precision.log",
    resources:
        seconds=100 if config["full"] else 4,
    params:
        scene=EVEN,
        full=config["full"],
        code=digest("tabulate_work_precision"),
    script:
        "tabulate_work_precision.py"


rule draw_work_precision:
    """Draw errors against computing time, as measured by this build and as published."""
    input:
        measured="results/tables/work_precision.csv",
        # committed, about the paper's slider
        published=[COMMITTED / "work_precision_full.csv"] if IS_PAPERS else [],
    output:
        measured=[
            report(
                "results/figures/work_precision.svg",
                caption="caption.rst",
                category="Accuracy",
                labels={"figure": "work_precision: what accuracy costs, measured by this build"},
            ),
            *collect("results/figures/work_precision.{kind}", kind=MORE_FORMATS),
        ],
        published=(
            [
                report(
                    "results/figures/speed.svg",
                    caption="caption_speed.rst",
                    category="Accuracy",
                    labels={"figure": "speed: what accuracy costs, as published for the paper's slider"},
                ),
                *collect("results/figures/speed.{kind}", kind=MORE_FORMATS),
            ]
            if IS_PAPERS
            else []
        ),
    log:
        "results/logs/draw_work_precision.log",
    localrule: True
    params:
        code=digest("draw_work_precision"),
    script:
        "draw_work_precision.py"


rule work_precision:
    """Accuracy against computing time."""
    input:
        rules.tabulate_work_precision.output,
        rules.draw_work_precision.output,
    localrule: True


RESULTS.append(rules.work_precision.input)
