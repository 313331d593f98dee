# other models

TABLES |= {
    "model_comparison": {
        "function": "hierarchy.compare_models:model_comparison",
        "options": {"sliders": SLIDERS},
        "seconds": 3,
    },
    "larger": {
        "function": "hierarchy.larger_study:larger_tables",
        "options": {"slider": config["chain"], "settings": config["hierarchy"]["larger"]},
        "beside": ["larger_differences", "larger_nucleation"],
        "seconds": 600 if config["full"] else 10,
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
