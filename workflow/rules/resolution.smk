# Convergence with the number of blocks

if len(config["resolution"]["runs"]) != len(config["resolution"]["n_blocks"]):
    raise WorkflowError("configuration: resolution.runs must have one number for each of n_blocks")

ENSEMBLES["resolution_members"] = Ensemble(
    function="maegawa2010.studies.resolution.tables:resolution_study",
    options={"sliders": SLIDERS, "duration": config["duration"], "settings": config["resolution"]},
    seconds=6,
)
TABLES["resolution"] = Table(
    function="maegawa2010.studies.resolution.tables:resolution_tables",
    message="summing up the runs with other numbers of blocks",
    inputs={
        "chunks": chunks_of(study="resolution_members"),
        "noise": "results/tables/noise_members.csv",
        # many runs of the paper's slider with 160 and 320 blocks
        "finer": [] if config["full"] or not IS_PAPERS else [f"{COMMITTED}/resolution_differences_full.csv"],
    },
    tables=["resolution", "resolution_differences"],
    beside=["resolution_members"],
)
FIGURES["resolution"] = Figure(
    section="sensitivity",
    function="maegawa2010.studies.resolution.figure:draw",
    shows="events and mu_sapp against the number of blocks",
    tables={"table": "results/tables/resolution.csv"},
    options={"papers_n": config["chain"]["n_blocks"], "mu_k": config["chain"]["mu_k"]},
)
