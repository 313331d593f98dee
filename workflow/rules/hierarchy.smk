# other models

TABLES |= {
    "model_comparison": {
        "function": "hierarchy.compare_models:model_comparison",
        "options": {"sliders": SLIDERS},
        "seconds": 4,
    },
    **{
        f"larger{full}": {
            "function": "hierarchy.larger_study:larger_tables",
            "options": {
                "slider": config["chain"],
                "settings": config["hierarchy"][f"larger{full}"],
                "full": full,
            },
            "tables": [f"larger{full}"],
            "beside": [f"larger_differences{full}", f"larger_nucleation{full}"],
            "seconds": seconds,
        }
        for full, seconds in (("", 20), ("_full", 1000))
    },
    **{
        f"{scene}_answers": {
            "function": "hierarchy.models:scene_answers",
            "options": {"slider": scene_slider(config, scene), "model": scene_model(config, scene)},
        }
        for scene in ASKED
    },
}


rule hierarchy:
    input:
        collect("results/figures/{figure}.{kind}", figure=["model_comparison", "larger"], kind=FORMATS),
        "results/tables/larger.csv",
        collect("results/tables/{scene}_answers.csv", scene=ASKED),
    localrule: True


# On demand: the paper shows these tables as they are committed in paper/tables.
rule larger_full:
    input:
        "results/tables/larger_full.csv",
    localrule: True
