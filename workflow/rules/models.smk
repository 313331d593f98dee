# Smaller models, and which of them answers which question

TABLES["model_comparison"] = Table(
    function="maegawa2010.studies.models.tables:compare_models",
    message="asking every model every question",
    options={"sliders": SLIDERS},
    seconds=3,
)
for scene in ASKED:
    TABLES[f"{scene}_answers"] = Table(
        function="maegawa2010.studies.models.models:scene_answers",
        message=f"{scene}: asking a smaller model",
        options={"slider": scene_slider(config, scene), "model": config["scenes"][scene]["model"]},
    )
