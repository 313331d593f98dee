if len(config["resolution"]["runs"]) != len(config["resolution"]["n_blocks"]):
    raise WorkflowError("configuration: resolution.runs must have one number for each of n_blocks")


rule run_resolution:
    """Simulate one chunk of the runs with other numbers of blocks."""
    output:
        chunk="results/ensembles/resolution_members/{chunk}.csv",
    log:
        "results/logs/run_resolution/{chunk}.log",
    resources:
        seconds=6,
    params:
        sliders=SLIDERS,
        duration=config["duration"],
        settings=config["resolution"],
        code=digest("run_resolution"),
    script:
        "run_resolution.py"


rule tabulate_resolution:
    """Summarise the runs with other numbers of blocks."""
    input:
        chunks=collect("results/ensembles/resolution_members/{chunk}.csv", chunk=CHUNKS),
        noise="results/tables/noise_members.csv",
        # many runs of the paper's slider with 160 and 320 blocks
        finer=[] if config["full"] or not IS_PAPERS else [COMMITTED / "resolution_differences_full.csv"],
    output:
        resolution=report("results/tables/resolution.csv", category="Tables"),
        resolution_differences=report("results/tables/resolution_differences.csv", category="Tables"),
        resolution_members="results/tables/resolution_members.csv",
    log:
        "results/logs/tabulate_resolution.log",
    localrule: True
    params:
        code=digest("tabulate_resolution"),
    script:
        "tabulate_resolution.py"


rule draw_resolution:
    """Draw events and mu_sapp against the number of blocks."""
    input:
        table="results/tables/resolution.csv",
        # many runs of the paper's slider, with up to 320 blocks
        finer=[] if config["full"] or not IS_PAPERS else [COMMITTED / "resolution_full.csv"],
    output:
        report(
            "results/figures/resolution.svg",
            caption="caption.rst",
            category="Sensitivity",
            labels={"figure": "resolution: events and mu_sapp against the number of blocks"},
        ),
        collect("results/figures/resolution.{kind}", kind=MORE_FORMATS),
    log:
        "results/logs/draw_resolution.log",
    localrule: True
    params:
        papers_n=config["chain"]["n_blocks"],
        mu_k=config["chain"]["mu_k"],
        code=digest("draw_resolution"),
    script:
        "draw_resolution.py"


rule resolution:
    """Convergence with the number of blocks."""
    input:
        rules.tabulate_resolution.input,
        rules.tabulate_resolution.output,
        rules.draw_resolution.output,
    localrule: True


RESULTS.append(rules.resolution.input)
