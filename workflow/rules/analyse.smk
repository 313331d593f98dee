# slips, mu_sapp


rule mu_sapp:
    input:
        "results/tables/mu_sapp.csv",
        "results/tables/reproduction.csv",
        collect("results/figures/definitions.{kind}", kind=FORMATS),
    localrule: True


rule tabulate_mu_sapp:
    input:
        slips=collect("results/tables/{scene}_slips.csv", scene=SCENES),
    output:
        table=report("results/tables/mu_sapp.csv", category="Tables"),
    log:
        "results/logs/tabulate_mu_sapp.log",
    localrule: True
    params:
        scenes=SCENES,
        code=digest("tabulate_mu_sapp"),
    script:
        "../scripts/tabulate_mu_sapp.py"


rule tabulate_reproduction:
    input:
        slips=collect("results/tables/{scene}_slips.csv", scene=SCENES),
        mu_sapp="results/tables/mu_sapp.csv",
    output:
        table=report("results/tables/reproduction.csv", category="Tables"),
    log:
        "results/logs/tabulate_reproduction.log",
    localrule: True
    params:
        paper={scene: config["scenes"][scene].get("paper", {}) for scene in SCENES},
        code=digest("tabulate_reproduction"),
    script:
        "../scripts/tabulate_reproduction.py"
