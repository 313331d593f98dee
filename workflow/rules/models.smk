# Smaller models, and which of them answers which question


rule tabulate_models:
    """Ask every model every question."""
    output:
        model_comparison=report("results/tables/model_comparison.csv", category="Tables"),
    log:
        "results/logs/tabulate_models.log",
    resources:
        seconds=3,
    params:
        sliders=SLIDERS,
        code=digest("tabulate_models"),
    message:
        "asking every model every question"
    script:
        "../scripts/tabulate_models.py"


rule answer_scene:
    """Ask a smaller model about a scene that names it."""
    output:
        answers=report("results/tables/{scene}_answers.csv", category="Tables"),
    log:
        "results/logs/answer_scene/{scene}.log",
    wildcard_constraints:
        scene="|".join(ASKED),
    localrule: True
    params:
        slider=lambda wildcards: scene_slider(config, wildcards.scene),
        model=lambda wildcards: config["scenes"][wildcards.scene]["model"],
        code=digest("answer_scene"),
    message:
        "{wildcards.scene}: asking a smaller model"
    script:
        "../scripts/answer_scene.py"


rule models:
    """Smaller models, and which of them answers which question."""
    input:
        rules.tabulate_models.output,
        collect("results/tables/{scene}_answers.csv", scene=ASKED),
    localrule: True


RESULTS.append(rules.models.input)
