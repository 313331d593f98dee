rule tabulate_balance:
    """Measure the mean of F_X in six runs, and how slips change the distance R from kinetic balance."""
    output:
        balance=report("results/tables/balance.csv", category="Tables"),
        balance_curves="results/tables/balance_curves.csv",
    log:
        "results/logs/tabulate_balance.log",
    resources:
        seconds=8,
    params:
        sliders=SLIDERS,
        n_blocks=config["balance"]["n_blocks"],
        duration=config["duration"],
        code=digest("tabulate_balance"),
    script:
        "tabulate_balance.py"


rule draw_balance:
    """Draw F_X over time and its mean under three loadings."""
    input:
        table="results/tables/balance.csv",
        curves="results/tables/balance_curves.csv",
    output:
        report(
            "results/figures/mean.svg",
            caption="caption.rst",
            category="Reproduction",
            labels={"figure": "mean: the mean load is the kinetic friction"},
        ),
        collect("results/figures/mean.{kind}", kind=MORE_FORMATS),
    log:
        "results/logs/draw_balance.log",
    localrule: True
    params:
        code=digest("draw_balance"),
    script:
        "draw_balance.py"


if IS_COMMITTED:

    rule check_balance:
        """Make the beginnings of the long runs again, and copy the committed tables if they agree."""
        input:
            tables=collect(COMMITTED / "balance_{name}.csv", name=["runs", "first_slips", "blocks", "loads"]),
            provenance=COMMITTED / "provenance.csv",
        output:
            balance_runs=report("results/tables/balance_runs.csv", category="Tables"),
            balance_first_slips=report("results/tables/balance_first_slips.csv", category="Tables"),
            balance_blocks=report("results/tables/balance_blocks.csv", category="Tables"),
            balance_loads=report("results/tables/balance_loads.csv", category="Tables"),
            committed="results/tables/committed_balance.csv",
        log:
            "results/logs/check_balance.log",
        localrule: True
        params:
            slider=config["chain"],
            sliders=SLIDERS,
            settings=LONG_SETTINGS["balance"],
            code=digest("check_balance"),
        script:
            "check_balance.py"

elif config["full"]:

    rule tabulate_long_balance:
        """Measure the mean of F_X and the distance from kinetic balance in many long runs."""
        output:
            balance_runs=report("results/tables/balance_runs.csv", category="Tables"),
            balance_first_slips=report("results/tables/balance_first_slips.csv", category="Tables"),
            balance_blocks=report("results/tables/balance_blocks.csv", category="Tables"),
            balance_loads=report("results/tables/balance_loads.csv", category="Tables"),
        log:
            "results/logs/tabulate_long_balance.log",
        resources:
            seconds=480,
        params:
            slider=config["chain"],
            sliders=SLIDERS,
            settings=config["balance"],
            code=digest("tabulate_long_balance"),
        script:
            "tabulate_long_balance.py"

    PUBLISHED |= dict.fromkeys(
        rules.tabulate_long_balance.output, ("tabulate_long_balance", config["balance"]["seed"])
    )


rule balance:
    """The mean of F_X, and the distance from kinetic balance."""
    input:
        rules.tabulate_balance.output,
        rules.draw_balance.output,
        rules.check_balance.output if IS_COMMITTED else [],
        rules.tabulate_long_balance.output if config["full"] else [],
    localrule: True


RESULTS.append(rules.balance.input)  # files that `all` makes
