# Noise in the normal loads

ENSEMBLES["noise_members"] = Ensemble(
    function="maegawa2010.studies.noise.tables:noise_study",
    options={"sliders": SLIDERS, "duration": config["duration"], "settings": config["noise"]},
)
TABLES["noise"] = Table(
    function="maegawa2010.studies.noise.tables:noise_tables",
    message="summing up the runs with noise",
    inputs={"chunks": chunks_of(study="noise_members")},
    tables=["noise", "noise_differences"],
    beside=["noise_members"],
)
