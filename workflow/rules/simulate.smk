rule simulate_scene:
    input:
        code=code_of("simulate_scene"),
    output:
        run="results/runs/{scene}.h5",
    log:
        "results/logs/simulate_scene/{scene}.log",
    benchmark:
        "results/benchmarks/simulate_scene/{scene}.tsv"
    threads: 1
    params:
        slider=lambda wildcards: scene_slider(config, wildcards.scene),
        duration=lambda wildcards: scene_duration(config, wildcards.scene),
    script:
        "../scripts/simulate_scene.py"
