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
    options={"uniform": min(SLIDERS, key=lambda scene: abs(SLIDERS[scene]["theta"]))},
    tables=["resolution", "resolution_differences", "counts_by_n"],
    beside=["resolution_members"],
)
TABLES["predictability"] = Table(
    function="maegawa2010.studies.resolution.tables:predictability_table",
    message="finding how long chains of other lengths can be predicted",
    options={
        "sliders": SLIDERS,
        "n_blocks": [
            n
            for n in sorted({*config["resolution"]["n_blocks"], config["chain"]["n_blocks"]})
            if n <= config["resolution"]["predicted_up_to"]
        ],
        "duration": config["duration"],
        "tolerance": config["horizon"]["tolerance"],
    },
    seconds=120 if config["full"] else 1,
)
FIGURES["resolution"] = Figure(
    section="sensitivity",
    function="maegawa2010.studies.resolution.figure:draw",
    shows="events and mu_sapp against the number of blocks",
    tables={
        "table": "results/tables/resolution.csv",
        "predictability": "results/tables/predictability.csv",
    },
    options={"papers_n": config["chain"]["n_blocks"], "mu_k": config["chain"]["mu_k"]},
)
