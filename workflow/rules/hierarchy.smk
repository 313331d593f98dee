# other models


rule hierarchy:
    input:
        collect("results/figures/model_comparison.{kind}", kind=FORMATS),
        collect("results/tables/{scene}_answers.csv", scene=ASKED),
    localrule: True


rule compare_models:
    output:
        table=report("results/tables/model_comparison.csv", category="Tables"),
    log:
        "results/logs/compare_models.log",
    params:
        sliders=SLIDERS,
        tolerances=config["hierarchy"]["tolerances"],
        repetitions=config["hierarchy"]["repetitions"],
        code=digest("compare_models"),
    script:
        "../scripts/compare_models.py"


rule answer_scene:
    output:
        table=report("results/tables/{scene}_answers.csv", category="Tables"),
    log:
        "results/logs/answer_scene/{scene}.log",
    wildcard_constraints:
        scene="|".join(ASKED) or "(?!)",
    localrule: True
    params:
        slider=lambda wildcards: scene_slider(config, wildcards.scene),
        model=lambda wildcards: scene_model(config, wildcards.scene),
        code=digest("answer_scene"),
    script:
        "../scripts/answer_scene.py"
