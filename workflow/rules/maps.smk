from precursors.ensembles.maps import AXES

MAPS = list(AXES)


wildcard_constraints:
    map="|".join(MAPS),


rule tabulate_resolution:
    input:
        members="results/tables/resolution_members.csv",
        code=code_of("tabulate_resolution"),
    output:
        table="results/tables/resolution.csv",
        limits="results/tables/resolution_limits.csv",
    log:
        "results/logs/tabulate_resolution.log",
    benchmark:
        "results/benchmarks/tabulate_resolution.tsv"
    threads: 1
    params:
        slider=config["chain"],
        fit_from=config["resolution"]["fit_from"],
    script:
        "../scripts/tabulate_resolution.py"


rule draw_resolution:
    input:
        table="results/tables/resolution.csv",
        limits="results/tables/resolution_limits.csv",
        code=code_of("draw_resolution"),
    output:
        png="results/figures/resolution.png",
        svg=report(
            "results/figures/resolution.svg",
            caption="../report/resolution.rst",
            category="Sensitivity",
            labels={"figure": "resolution: what the number of blocks does"},
        ),
    log:
        "results/logs/draw_resolution.log",
    benchmark:
        "results/benchmarks/draw_resolution.tsv"
    threads: 1
    params:
        papers_n=config["chain"]["n_blocks"],
    script:
        "../scripts/draw_resolution.py"


rule tabulate_resolution_models:
    input:
        members="results/tables/{models}_members.csv",
        code=code_of("tabulate_resolution_models"),
    output:
        table="results/tables/{models}.csv",
        runs="results/tables/{models}_runs.csv",
    log:
        "results/logs/tabulate_resolution_models/{models}.log",
    benchmark:
        "results/benchmarks/tabulate_resolution_models/{models}.tsv"
    wildcard_constraints:
        models="resolution_models(_full)?",
    threads: 1
    script:
        "../scripts/tabulate_resolution_models.py"


rule draw_resolution_models:
    input:
        table="results/tables/{models}.csv",
        runs="results/tables/{models}_runs.csv",
        code=code_of("draw_resolution_models"),
    output:
        png="results/figures/{models}.png",
        svg=report(
            "results/figures/{models}.svg",
            caption="../report/resolution_models.rst",
            category="Sensitivity",
            labels={"figure": "{models}: the same with viscosity and interface springs"},
        ),
    log:
        "results/logs/draw_resolution_models/{models}.log",
    benchmark:
        "results/benchmarks/draw_resolution_models/{models}.tsv"
    wildcard_constraints:
        models="resolution_models(_full)?",
    threads: 1
    params:
        papers_n=config["chain"]["n_blocks"],
        longest_run=lambda wildcards: (
            config["resolution_models"]["full"]
            if wildcards.models.endswith("_full")
            else config["resolution_models"]
        )["longest_run"],
    script:
        "../scripts/draw_resolution_models.py"


rule draw_maps:
    input:
        tables=collect("results/tables/{map}.csv", map=MAPS),
        code=code_of("draw_maps"),
    output:
        collect("results/figures/{map}.png", map=MAPS),
        [
            report(
                f"results/figures/{name}.svg",
                caption="../report/maps.rst",
                category="Sensitivity",
                labels={"figure": f"{name}: theta and {axis.replace('_', ' ')}"},
            )
            for name, (axis, _) in AXES.items()
        ],
    log:
        "results/logs/draw_maps.log",
    benchmark:
        "results/benchmarks/draw_maps.tsv"
    threads: 1
    params:
        maps=MAPS,
        sliders=[scene_slider(config, scene) for scene in config["fig13"]],
    script:
        "../scripts/draw_maps.py"


rule tabulate_long_runs:
    input:
        code=code_of("tabulate_long_runs"),
    output:
        slips="results/tables/long_runs.csv",
        statistics="results/tables/long_runs_statistics.csv",
    log:
        "results/logs/tabulate_long_runs.log",
    benchmark:
        "results/benchmarks/tabulate_long_runs.tsv"
    threads: 1
    params:
        sliders={scene: scene_slider(config, scene) for scene in config["fig13"]},
        duration=config["long_runs"]["duration"],
    script:
        "../scripts/tabulate_long_runs.py"


rule draw_long_runs:
    input:
        slips="results/tables/long_runs.csv",
        statistics="results/tables/long_runs_statistics.csv",
        code=code_of("draw_long_runs"),
    output:
        png="results/figures/long_runs.png",
        svg=report(
            "results/figures/long_runs.svg",
            caption="../report/long_runs.rst",
            category="Sensitivity",
            labels={"figure": "long_runs: peak loads of hundreds of global slips"},
        ),
    log:
        "results/logs/draw_long_runs.log",
    benchmark:
        "results/benchmarks/draw_long_runs.tsv"
    threads: 1
    script:
        "../scripts/draw_long_runs.py"
