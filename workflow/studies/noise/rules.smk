rule run_noise:
    """Simulate one chunk (such as 1of4) of the runs with noise in the normal loads."""
    output:
        members="results/ensembles/noise_members/{chunk}.csv",
    log:
        "results/logs/run_noise/{chunk}.log",
    resources:
        seconds=2,  # expected computing time
    params:
        sliders=SLIDERS,
        duration=config["duration"],
        settings=config["noise"],
        code=digest("run_noise"),
    script:
        "run_noise.py"


rule tabulate_noise:
    """Join the chunks, summarise the runs of each scene, and compare the scenes."""
    input:
        chunks=collect("results/ensembles/noise_members/{chunk}.csv", chunk=CHUNKS),
    output:
        noise=report("results/tables/noise.csv", category="Tables"),
        noise_differences=report("results/tables/noise_differences.csv", category="Tables"),
        noise_members="results/tables/noise_members.csv",
    log:
        "results/logs/tabulate_noise.log",
    localrule: True
    params:
        code=digest("tabulate_noise"),
    script:
        "tabulate_noise.py"


rule noise:
    """Sensitivity to noise in the normal loads."""
    input:
        rules.tabulate_noise.input,  # so that a deleted chunk is made again
        rules.tabulate_noise.output,
    localrule: True


RESULTS.append(rules.noise.input)  # files that `all` makes
