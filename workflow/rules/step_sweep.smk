# The paper's counts against the step of a Runge-Kutta method

TABLES["step_sweep"] = Table(
    function="maegawa2010.studies.step_sweep.tables:step_sweep_table",
    message="running the scenes with Runge-Kutta steps of many sizes",
    inputs={"runs": RUNS},
    options={"full": config["full"]},
    also=[f"{PAPERS}/methods/methods.csv"],
    seconds=3,
)
FIGURES["step_sweep"] = Figure(
    section="accuracy",
    function="maegawa2010.studies.step_sweep.figure:draw",
    shows="counts and transitions that are right against the step of a Runge-Kutta method",
    tables={"table": "results/tables/step_sweep.csv"},
)
