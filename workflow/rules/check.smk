rule check_eq15:
    input:
        code=code_of("check_eq15"),
    output:
        json="results/tables/eq15.json",
        csv="results/tables/eq15.csv",
    log:
        "results/logs/check_eq15.log",
    benchmark:
        "results/benchmarks/check_eq15.tsv"
    threads: 1
    params:
        sliders={scene: scene_slider(config, scene) for scene in config["fig13"]},
        duration=config["duration"],
    script:
        "../scripts/check_eq15.py"
