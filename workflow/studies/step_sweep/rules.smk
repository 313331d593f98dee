rule tabulate_step_sweep:
    """Simulate the scenes by a Runge-Kutta method with many step sizes."""
    input:
        runs=RUNS,
        methods=PAPERS / "methods/methods.csv",
    output:
        step_sweep=report("results/tables/step_sweep.csv", category="Tables"),
    log:
        "results/logs/tabulate_step_sweep.log",
    resources:
        seconds=3,
    params:
        full=config["full"],
        code=digest("tabulate_step_sweep"),
    script:
        "tabulate_step_sweep.py"


rule draw_step_sweep:
    """Draw the percentage of right transitions against the step size."""
    input:
        table="results/tables/step_sweep.csv",
    output:
        report(
            "results/figures/step_sweep.svg",
            caption="caption.rst",
            category="Accuracy",
            labels={
                "figure": "step_sweep: right counts and transitions against the step of a Runge-Kutta method"
            },
        ),
        collect("results/figures/step_sweep.{kind}", kind=MORE_FORMATS),
    log:
        "results/logs/draw_step_sweep.log",
    localrule: True
    params:
        code=digest("draw_step_sweep"),
    script:
        "draw_step_sweep.py"


rule step_sweep:
    """Counts and transitions against the step of a Runge-Kutta method."""
    input:
        rules.tabulate_step_sweep.output,
        rules.draw_step_sweep.output,
    localrule: True


RESULTS.append(rules.step_sweep.input)  # files that `all` makes
