# The paper's counts against the step of a Runge-Kutta method


rule draw_step_sweep:
    """Run the scenes with Runge-Kutta steps of many sizes, and draw what is right."""
    input:
        runs=RUNS,
        methods=PAPERS / "methods/methods.csv",
    output:
        table=report("results/tables/step_sweep.csv", category="Tables"),
        figures=[
            report(
                "results/figures/step_sweep.svg",
                caption="../report/step_sweep.rst",
                category="Accuracy",
                labels={
                    "figure": "step_sweep: counts and transitions that are right against the step of a Runge-Kutta method"
                },
            ),
            *collect("results/figures/step_sweep.{kind}", kind=MORE_FORMATS),
        ],
    log:
        "results/logs/draw_step_sweep.log",
    resources:
        seconds=3,
    params:
        full=config["full"],
        code=digest("draw_step_sweep"),
    message:
        "running the scenes with Runge-Kutta steps of many sizes"
    script:
        "../scripts/draw_step_sweep.py"


rule step_sweep:
    """The paper's counts against the step of a Runge-Kutta method."""
    input:
        rules.draw_step_sweep.output,
    localrule: True
