rule climb_ladder:
    input:
        code=code_of("climb_ladder"),
    output:
        table="results/tables/ladder.csv",
    log:
        "results/logs/climb_ladder.log",
    benchmark:
        "results/benchmarks/climb_ladder.tsv"
    threads: 1
    params:
        sliders={scene: scene_slider(config, scene) for scene in config["fig13"]},
        tolerances=config["ladder"]["tolerances"],
        additions=config["ladder"]["additions"],
        repetitions=config["ladder"]["repetitions"],
    script:
        "../scripts/climb_ladder.py"


rule draw_ladder:
    input:
        ladder="results/tables/ladder.csv",
        code=code_of("draw_ladder"),
    output:
        png="results/figures/ladder.png",
        svg=report(
            "results/figures/ladder.svg",
            caption="../report/ladder.rst",
            category="Models",
            labels={"figure": "ladder: which model answers which question"},
        ),
    log:
        "results/logs/draw_ladder.log",
    benchmark:
        "results/benchmarks/draw_ladder.tsv"
    threads: 1
    script:
        "../scripts/draw_ladder.py"
