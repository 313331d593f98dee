# other models


rule hierarchy:
    input:
        collect("results/figures/{figure}.{kind}", figure=["model_comparison", "larger"], kind=FORMATS),
        "results/tables/larger.csv",
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


# On demand: the paper shows these tables as they are committed in paper/tables.
rule larger_full:
    input:
        "results/tables/larger_full.csv",
    localrule: True


rule tabulate_larger:
    output:
        medians=report("results/tables/larger{full}.csv", category="Tables"),
        differences="results/tables/larger_differences{full}.csv",
        nucleation="results/tables/larger_nucleation{full}.csv",
    log:
        "results/logs/tabulate_larger{full}.log",
    wildcard_constraints:
        full="(_full)?",
    params:
        slider=config["chain"],
        settings=lambda wildcards: config["hierarchy"][f"larger{wildcards.full}"],
        code=digest("tabulate_larger"),
    script:
        "../scripts/tabulate_larger.py"


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
