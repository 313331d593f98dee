rule tabulate_models:
    """Compare simpler models with the exact chain."""
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
    """Simpler models, and which questions each of them answers."""
    input:
        rules.tabulate_models.output,
    localrule: True


RESULTS.append(rules.models.input)  # files that `all` makes
