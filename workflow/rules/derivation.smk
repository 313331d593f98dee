# Eq. 15, readings


rule eq15:
    input:
        "results/tables/eq15.csv",
        "results/tables/eq15_speeds.csv",
    localrule: True


rule check_eq15:
    input:
        runs=collect("results/runs/{scene}.h5", scene=config["fig13"]),
    output:
        table=report("results/tables/eq15.csv", category="Tables"),
        speeds=report("results/tables/eq15_speeds.csv", category="Tables"),
    log:
        "results/logs/check_eq15.log",
    params:
        scenes=config["fig13"],
        duration=config["duration"],
        code=digest("check_eq15"),
    script:
        "../scripts/check_eq15.py"


rule tabulate_definitions:
    input:
        runs=collect("results/runs/{scene}.h5", scene=config["fig13"]),
    output:
        table=report("results/tables/definitions.csv", category="Tables"),
    log:
        "results/logs/tabulate_definitions.log",
    localrule: True
    params:
        slider=config["chain"],
        duration=config["duration"],
        degrees=config["reproduction"]["theta"],
        load_drops=config["reproduction"]["load_drop"],
        paper=[config["scenes"][scene].get("paper", {}) for scene in config["fig13"]],
        code=digest("tabulate_definitions"),
    script:
        "../scripts/tabulate_definitions.py"
