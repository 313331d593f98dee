# mu_sapp over theta and mu_k/mu_s

ENSEMBLES["map_theta_friction_ratio"] = Ensemble(
    function="maegawa2010.studies.friction_map.tables:map_study",
    options={"slider": config["chain"], "points": config["friction_map"]["points"]},
)
TABLES["map_theta_friction_ratio"] = Table(
    function="maegawa2010.studies.members:gather",
    message="gathering the runs of the map",
    inputs={"chunks": chunks_of(study="map_theta_friction_ratio")},
    tables=[],
    beside=["map_theta_friction_ratio"],
)
FIGURES["map_theta_friction_ratio"] = Figure(
    section="sensitivity",
    function="maegawa2010.studies.friction_map.figure:draw",
    shows="mu_sapp over theta and mu_k/mu_s",
    tables={"table": "results/tables/map_theta_friction_ratio.csv"},
    options={"scenes": [(slider["theta"], slider["mu_k"] / slider["mu_s"]) for slider in SLIDERS.values()]},
)
