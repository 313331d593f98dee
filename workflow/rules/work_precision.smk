# Accuracy against computing time

proved = {
    chain: abs(parse_theta(config["horizon"]["proved"][chain].get("theta", 0)))
    for chain in config["horizon"]["compared"]
}
EVEN = min(proved, key=proved.get)  # the chain with the most even load

TABLES["work_precision"] = Table(
    function="maegawa2010.studies.work_precision.tables:work_precision_table",
    message="timing all methods on a proved chain",
    inputs={"certificate": CERTIFICATES[EVEN]},
    options={"scene": EVEN, "full": config["full"]},
    also=[f"{PAPERS}/methods/methods.csv"],
    seconds=100 if config["full"] else 4,
)
FIGURES["work_precision"] = Figure(
    section="accuracy",
    function="maegawa2010.studies.work_precision.figure:draw",
    shows="what accuracy costs, measured by this build",
    tables={"table": "results/tables/work_precision.csv"},
)
# Drawn from what is committed, which is about the paper's slider.
if IS_PAPERS:
    FIGURES["speed"] = Figure(
        section="accuracy",
        function="maegawa2010.studies.work_precision.figure:draw",
        shows="what accuracy costs, as published for the paper's slider",
        tables={"table": f"{COMMITTED}/work_precision_full.csv"},
        options={"compared": "heyoka"},
    )
