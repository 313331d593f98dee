# Small changes of theta

ENSEMBLES["theta_window_members"] = Ensemble(
    function="maegawa2010.studies.theta_window.tables:theta_window_study",
    options={"sliders": SLIDERS, "duration": config["duration"], "settings": config["theta_window"]},
)
TABLES["theta_window_members"] = Table(
    function="maegawa2010.studies.members:gather",
    message="gathering the runs with other values of theta",
    inputs={"chunks": chunks_of(study="theta_window_members")},
    tables=[],
    beside=["theta_window_members"],
)
FIGURES["theta_window"] = Figure(
    section="sensitivity",
    function="maegawa2010.studies.theta_window.figure:draw",
    shows="small changes of theta change the numbers",
    tables={"members": "results/tables/theta_window_members.csv"},
)
