# every transition


rule simulate_scene:
    output:
        run="results/runs/{scene}.h5",
        slips=report("results/tables/{scene}_slips.csv", category="Tables"),
        trace="results/tables/{scene}_trace.csv",
    log:
        "results/logs/simulate_scene/{scene}.log",
    params:
        slider=lambda wildcards: scene_slider(config, wildcards.scene),
        duration=lambda wildcards: scene_duration(config, wildcards.scene),
        additions=lambda wildcards: scene_additions(config, wildcards.scene),
        code=digest("simulate_scene"),
    script:
        "../scripts/simulate_scene.py"
