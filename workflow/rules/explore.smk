rule write_explorer:
    input:
        runs=collect("results/runs/{scene}.h5", scene=SCENES),
        code=collect(
            "{library}/{file}",
            library=LIBRARY,
            file=[
                "explorer/detail.py",
                "explorer/explorer.css",
                "explorer/explorer.js",
                "explorer/page.html",
                "explorer/page.py",
                "figures/style.py",
                "kernel.py",
                "lanes.py",
                "run.py",
                "slips.py",
                "storage.py",
            ],
        ),
    output:
        page="results/explorer.html",
    log:
        "results/logs/write_explorer.log",
    benchmark:
        "results/benchmarks/write_explorer.tsv"
    threads: 1
    params:
        titles={scene: config["scenes"][scene]["title"] for scene in SCENES},
        thetas={scene: scene_slider(config, scene)["theta"] for scene in SCENES},
    script:
        "../scripts/write_explorer.py"


rule draw_film:
    input:
        run="results/runs/{scene}.h5",
        code=collect(
            "{library}/{module}.py",
            library=LIBRARY,
            module=["figures/film", "figures/style", "kernel", "lanes", "run", "slips", "storage"],
        ),
    output:
        film="results/films/{scene}.gif",
    log:
        "results/logs/draw_film/{scene}.log",
    benchmark:
        "results/benchmarks/draw_film/{scene}.tsv"
    threads: 1
    script:
        "../scripts/draw_film.py"
