rule tabulate_failures:
    """Run methods with settings at which they fail."""
    input:
        methods=PAPERS / "methods/methods.csv",
    output:
        failure_curves="results/tables/failure_curves.csv",
    log:
        "results/logs/tabulate_failures.log",
    resources:
        seconds=3,
    params:
        code=digest("tabulate_failures"),
    script:
        "tabulate_failures.py"


rule draw_failures:
    """Draw six ways in which methods fail."""
    input:
        curves="results/tables/failure_curves.csv",
        panels=PAPERS / "studies/failures/failure_gallery.csv",
    output:
        report(
            "results/figures/failure_gallery.svg",
            caption="caption.rst",
            category="Accuracy",
            labels={"figure": "failure_gallery: six ways in which methods fail"},
        ),
        collect("results/figures/failure_gallery.{kind}", kind=MORE_FORMATS),
    log:
        "results/logs/draw_failures.log",
    localrule: True
    params:
        code=digest("draw_failures"),
    script:
        "draw_failures.py"


rule failures:
    """Six ways in which methods fail."""
    input:
        rules.tabulate_failures.output,
        rules.draw_failures.output,
    localrule: True


RESULTS.append(rules.failures.input)  # files that `all` makes
