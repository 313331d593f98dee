rule tabulate_models:
    """Ask every model every question."""
    output:
        model_comparison=report("results/tables/model_comparison.csv", category="Tables"),
    log:
        "results/logs/tabulate_models.log",
    resources:
        seconds=3,
    params:
        sliders=SLIDERS,
        code=digest("tabulate_models"),
    script:
        "tabulate_models.py"


rule models:
    """Smaller models, and which of them answers which question."""
    input:
        rules.tabulate_models.output,
    localrule: True


RESULTS.append(rules.models.input)
