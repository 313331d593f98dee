# The time mean of F_X. On demand, four minutes: the article reads what is committed of it.


rule tabulate_mean_load:
    """Measure the time mean of F_X under many loadings and drives."""
    output:
        mean_load="results/tables/mean_load.csv",
    log:
        "results/logs/tabulate_mean_load.log",
    resources:
        seconds=240,
    params:
        slider=config["chain"],
        settings=config["mean_load"],
        code=digest("tabulate_mean_load"),
    message:
        "measuring the time mean of F_X"
    script:
        "../scripts/tabulate_mean_load.py"


rule mean_load:
    """The time mean of F_X."""
    input:
        rules.tabulate_mean_load.output,
    localrule: True
