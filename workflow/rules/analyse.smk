rule tabulate_slips:
    input:
        run="results/runs/{scene}.h5",
        code=code_of("tabulate_slips"),
    output:
        table="results/tables/{scene}_slips.csv",
    log:
        "results/logs/tabulate_slips/{scene}.log",
    benchmark:
        "results/benchmarks/tabulate_slips/{scene}.tsv"
    threads: 1
    script:
        "../scripts/tabulate_slips.py"


rule tabulate_trace:
    input:
        run="results/runs/{scene}.h5",
        code=code_of("tabulate_trace"),
    output:
        table="results/tables/{scene}_trace.csv",
    log:
        "results/logs/tabulate_trace/{scene}.log",
    benchmark:
        "results/benchmarks/tabulate_trace/{scene}.tsv"
    threads: 1
    script:
        "../scripts/tabulate_trace.py"


rule tabulate_mu_sapp:
    input:
        runs=collect("results/runs/{scene}.h5", scene=SCENES),
        code=code_of("tabulate_mu_sapp"),
    output:
        table="results/tables/mu_sapp.csv",
    log:
        "results/logs/tabulate_mu_sapp.log",
    benchmark:
        "results/benchmarks/tabulate_mu_sapp.tsv"
    threads: 1
    params:
        scenes=SCENES,
    script:
        "../scripts/tabulate_mu_sapp.py"


rule tabulate_reproduction:
    input:
        slips=collect("results/tables/{scene}_slips.csv", scene=SCENES),
        mu_sapp="results/tables/mu_sapp.csv",
        code=code_of("tabulate_reproduction"),
    output:
        table="results/tables/reproduction.csv",
    log:
        "results/logs/tabulate_reproduction.log",
    benchmark:
        "results/benchmarks/tabulate_reproduction.tsv"
    threads: 1
    params:
        paper={scene: config["scenes"][scene].get("paper", {}) for scene in SCENES},
    script:
        "../scripts/tabulate_reproduction.py"
