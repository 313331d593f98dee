# other models


rule hierarchy:
    input:
        collect("results/figures/model_comparison.{kind}", kind=FORMATS),
        "results/figures/resolution_models.svg",
        collect("results/tables/{scene}_answers.csv", scene=ASKED),
    localrule: True


rule compare_models:
    input:
        code=package("model", "solver", "analysis", "hierarchy"),
    output:
        table=report("results/tables/model_comparison.csv", category="Tables"),
    log:
        "results/logs/compare_models.log",
    params:
        sliders=SLIDERS,
        tolerances=config["hierarchy"]["tolerances"],
        additions=config["hierarchy"]["additions"],
        repetitions=config["hierarchy"]["repetitions"],
    script:
        "../scripts/compare_models.py"


rule run_larger_models:
    input:
        code=package("model", "solver", "analysis", "hierarchy"),
    output:
        table=report("results/tables/resolution_models.csv", category="Tables"),
        runs="results/tables/resolution_models_runs.csv",
    log:
        "results/logs/run_larger_models.log",
    params:
        slider=config["chain"],
        settings=config["hierarchy"]["resolution"],
    script:
        "../scripts/run_larger_models.py"


# On demand: the paper shows the committed table of `models_loadings_full`.
rule tabulate_loadings:
    input:
        code=package("model", "solver", "analysis", "hierarchy"),
    output:
        table=report("results/tables/models_loadings{full}.csv", category="Tables"),
    log:
        "results/logs/tabulate_loadings{full}.log",
    params:
        slider=config["chain"],
        settings=config["hierarchy"]["resolution"],
        loadings=lambda wildcards: config["hierarchy"][f"loadings{wildcards.full}"],
    script:
        "../scripts/tabulate_loadings.py"


rule answer_scene:
    input:
        code=package("model", "solver", "analysis", "hierarchy"),
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
        additions=lambda wildcards: scene_additions(config, wildcards.scene),
    script:
        "../scripts/answer_scene.py"
