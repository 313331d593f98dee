# Where methods fail


rule draw_failures:
    """Make every method fail, and draw six ways of it."""
    input:
        methods=PAPERS / "methods/methods.csv",
        panels=PAPERS / "studies/failures/failure_gallery.csv",
    output:
        curves="results/tables/failure_curves.csv",
        figures=[
            report(
                "results/figures/failure_gallery.svg",
                caption="../report/failure_gallery.rst",
                category="Accuracy",
                labels={"figure": "failure_gallery: six ways in which methods fail"},
            ),
            *collect("results/figures/failure_gallery.{kind}", kind=MORE_FORMATS),
        ],
    log:
        "results/logs/draw_failures.log",
    resources:
        seconds=3,
    params:
        code=digest("draw_failures"),
    message:
        "making every method fail, and drawing it"
    script:
        "../scripts/draw_failures.py"


rule failures:
    """Where methods fail."""
    input:
        rules.draw_failures.output,
    localrule: True
