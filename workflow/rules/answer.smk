rule answer_scene:
    input:
        code=code_of("answer_scene"),
    output:
        table="results/tables/{scene}_answers.csv",
    log:
        "results/logs/answer_scene/{scene}.log",
    benchmark:
        "results/benchmarks/answer_scene/{scene}.tsv"
    wildcard_constraints:
        scene="|".join(ASKED) or "(?!)",
    threads: 1
    params:
        slider=lambda wildcards: scene_slider(config, wildcards.scene),
        model=lambda wildcards: scene_model(config, wildcards.scene),
        quantities=lambda wildcards: scene_quantities(config, wildcards.scene),
    script:
        "../scripts/answer_scene.py"
