# Sliders with the same printed inputs

ENSEMBLES["digits_members"] = Ensemble(
    function="maegawa2010.studies.printed_digits.tables:digits_study",
    options={"sliders": SLIDERS, "duration": config["duration"], "settings": config["printed_digits"]},
)
TABLES["digits"] = Table(
    function="maegawa2010.studies.printed_digits.tables:digits_tables",
    message="summing up the sliders with the same printed inputs",
    inputs={"chunks": chunks_of(study="digits_members")},
    options={"paper": {scene: PAPER_PRINTS[scene] for scene in FIG13}},
    beside=["digits_members"],
)
if IS_PAPERS:
    FIGURES["hero"] = Figure(
        section="sensitivity",
        function="maegawa2010.studies.printed_digits.figure:draw",
        shows="the paper's six numbers, and mu_sapp of the sliders with the same printed inputs",
        tables={
            "slips": collect("results/tables/{scene}_slips.csv", scene=FIG13),
            "members": "results/tables/digits_members.csv",
            "shares": "results/tables/digits.csv",
        },
    )
