if len(config["resolution"]["runs"]) != len(config["resolution"]["n_blocks"]):
    raise WorkflowError("configuration: resolution.runs must have one number for each of n_blocks")

if IS_COMMITTED:

    rule check_resolution:
        """Make the beginnings of the long study again, and copy its committed tables if they agree."""
        input:
            tables=[COMMITTED / "resolution.csv", COMMITTED / "resolution_differences.csv"],
            provenance=COMMITTED / "provenance.csv",
            # The study of noise has the scenes' own N. It can be compared unless the configuration changes it.
            noise=(
                []
                if "noise" in GIVEN
                else ["results/tables/noise.csv", "results/tables/noise_differences.csv"]
            ),
        output:
            resolution=report("results/tables/resolution.csv", category="Tables"),
            resolution_differences=report("results/tables/resolution_differences.csv", category="Tables"),
            committed="results/tables/committed_resolution.csv",
        log:
            "results/logs/check_resolution.log",
        localrule: True
        params:
            sliders=SLIDERS,
            duration=config["duration"],
            settings=LONG_SETTINGS["resolution"],
            code=digest("check_resolution"),
        script:
            "check_resolution.py"

else:

    rule run_resolution:
        """Simulate one chunk of the runs with other numbers of blocks."""
        output:
            members="results/ensembles/resolution_members/{chunk}.csv",
        log:
            "results/logs/run_resolution/{chunk}.log",
        resources:
            seconds=70 if config["full"] else 6,
        params:
            sliders=SLIDERS,
            duration=config["duration"],
            settings=config["resolution"],
            code=digest("run_resolution"),
        script:
            "run_resolution.py"

    rule tabulate_resolution:
        """Join the chunks, summarise the runs for each number of blocks, and compare the scenes."""
        input:
            chunks=collect("results/ensembles/resolution_members/{chunk}.csv", chunk=CHUNKS),
            noise="results/tables/noise_members.csv",
        output:
            resolution=report("results/tables/resolution.csv", category="Tables"),
            resolution_differences=report("results/tables/resolution_differences.csv", category="Tables"),
        log:
            "results/logs/tabulate_resolution.log",
        resources:
            seconds=20 if config["full"] else 2,
        params:
            sliders=SLIDERS,
            duration=config["duration"],
            settings=config["resolution"],
            full=config["full"],
            code=digest("tabulate_resolution"),
        script:
            "tabulate_resolution.py"

    PUBLISHED |= dict.fromkeys(
        rules.tabulate_resolution.output,
        ("tabulate_resolution", f"{config['resolution']['seed']}, noise {config['noise']['seed']}"),
    )


rule draw_resolution:
    """Draw events and mu_sapp against the number of blocks."""
    input:
        table="results/tables/resolution.csv",
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
    """How events and mu_sapp depend on the number of blocks."""
    input:
        rules.check_resolution.output if IS_COMMITTED else rules.tabulate_resolution.output,
        rules.draw_resolution.output,
    localrule: True


RESULTS.append(rules.resolution.input)  # files that `all` makes
