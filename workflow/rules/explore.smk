rule write_explorer:
    input:
        runs=collect("results/runs/{scene}.h5", scene=SCENES),
        code=code_of("write_explorer"),
        page=collect(
            "{library}/figures/explorer/{file}",
            library=LIBRARY,
            file=["explorer.css", "explorer.js", "page.html"],
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
        code=code_of("draw_film"),
    output:
        film="results/films/{scene}.gif",
    log:
        "results/logs/draw_film/{scene}.log",
    benchmark:
        "results/benchmarks/draw_film/{scene}.tsv"
    threads: 1
    script:
        "../scripts/draw_film.py"
