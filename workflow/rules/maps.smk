from precursors.ensembles.maps import AXES

MAPS = list(AXES)


wildcard_constraints:
    map="|".join(MAPS),


rule tabulate_resolution:
    input:
        members="results/tables/resolution_members.csv",
        code=collect("{library}/{module}.py", library=LIBRARY, module=["ensembles/resolution", "storage"]),
    output:
        table="results/tables/resolution.csv",
        limits="results/tables/resolution_limits.csv",
    log:
        "results/logs/tabulate_resolution.log",
    benchmark:
        "results/benchmarks/tabulate_resolution.tsv"
    threads: 1
    params:
        length=config["chain"]["length"],
        fit_from=config["resolution"]["fit_from"],
    script:
        "../scripts/tabulate_resolution.py"


rule draw_resolution:
    input:
        table="results/tables/resolution.csv",
        limits="results/tables/resolution_limits.csv",
        code=collect(
            "{library}/{module}.py",
            library=LIBRARY,
            module=["ensembles/resolution", "figures/resolution", "figures/style"],
        ),
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
        slider=config["chain"],
    script:
        "../scripts/draw_resolution.py"


rule tabulate_resolution_models:
    input:
        members="results/tables/resolution_models_members.csv",
        code=collect(
            "{library}/{module}.py",
            library=LIBRARY,
            module=["ensembles/resolution", "ensembles/resolution_models", "storage"],
        ),
    output:
        table="results/tables/resolution_models.csv",
    log:
        "results/logs/tabulate_resolution_models.log",
    benchmark:
        "results/benchmarks/tabulate_resolution_models.tsv"
    threads: 1
    script:
        "../scripts/tabulate_resolution_models.py"


rule draw_resolution_models:
    input:
        table="results/tables/resolution_models.csv",
        code=collect(
            "{library}/{module}.py",
            library=LIBRARY,
            module=["figures/resolution", "figures/resolution_models", "figures/style"],
        ),
    output:
        png="results/figures/resolution_models.png",
        svg=report(
            "results/figures/resolution_models.svg",
            caption="../report/resolution_models.rst",
            category="Sensitivity",
            labels={"figure": "resolution_models: the same with viscosity and interface springs"},
        ),
    log:
        "results/logs/draw_resolution_models.log",
    benchmark:
        "results/benchmarks/draw_resolution_models.tsv"
    threads: 1
    script:
        "../scripts/draw_resolution_models.py"


rule draw_maps:
    input:
        tables=collect("results/tables/{map}.csv", map=MAPS),
        code=collect("{library}/figures/{module}.py", library=LIBRARY, module=["maps", "style"]),
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
    script:
        "../scripts/draw_maps.py"


rule tabulate_long_runs:
    input:
        code=collect(
            "{library}/{module}.py",
            library=LIBRARY,
            module=["chain", "ensembles/long_runs", "exact", "kernel", "lanes", "run", "slips", "storage"],
        ),
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
        code=collect("{library}/figures/{module}.py", library=LIBRARY, module=["long_runs", "style"]),
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
