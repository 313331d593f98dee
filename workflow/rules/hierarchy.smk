# other models

TABLES |= {
    "model_comparison": {
        "function": "maegawa2010.studies.models.compare_models:compare_models",
        "options": {"sliders": SLIDERS},
        "seconds": 3,
    },
    "larger": {
        "function": "maegawa2010.studies.larger.first_slips:larger_tables",
        "options": {"slider": config["chain"], "settings": config["hierarchy"]["larger"]},
        "beside": ["larger_means", "larger_nucleation"],
        "threads": 4,
        "seconds": 600 if config["full"] else 2,
    },
    "larger_cycles": {
        "function": "maegawa2010.studies.larger.cycles:cycle_tables",
        "options": {"slider": config["chain"], "settings": config["hierarchy"]["cycles"]},
        "beside": ["larger_peaks", "larger_verdicts"],
        "threads": 4,
        "seconds": 3600 if config["full"] else 2,
    },
    **{
        f"{scene}_answers": {
            "function": "maegawa2010.studies.models.models:scene_answers",
            "options": {"slider": scene_slider(config, scene), "model": config["scenes"][scene]["model"]},
        }
        for scene in ASKED
    },
}


rule hierarchy:
    input:
        collect("results/figures/larger.{kind}", kind=FORMATS),
        collect("results/tables/{table}.csv", table=["model_comparison", "larger", "larger_cycles"]),
        collect("results/tables/{scene}_answers.csv", scene=ASKED),
    localrule: True
