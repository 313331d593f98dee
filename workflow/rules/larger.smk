# Chains with a length

# Only the full study: the figure and the article are made from what is committed of it.
if config["full"]:
    TABLES["larger"] = Table(
        function="maegawa2010.studies.larger.first_slips:larger_tables",
        message="running chains with a length to their first global slip",
        options={"slider": config["chain"], "settings": config["larger"]["first_slips"]},
        beside=["larger_nucleation"],
        threads=4,
        seconds=1200,
    )
    ENSEMBLES["larger_members"] = Ensemble(
        function="maegawa2010.studies.larger.cycles:settled_study",
        run="maegawa2010.studies.larger.cycles:run_settled",
        options={"slider": config["chain"], "settings": config["larger"]["settled"]},
        seconds=1200,
    )
    TABLES["larger_settled"] = Table(
        function="maegawa2010.studies.larger.cycles:settled_table",
        message="gathering the settled runs of chains with a length",
        inputs={"chunks": chunks_of(study="larger_members")},
    )
# Drawn from what is committed, which is about the paper's slider.
if IS_PAPERS:
    FIGURES["larger"] = Figure(
        section="hierarchy",
        function="maegawa2010.studies.larger.figure:draw",
        shows="a chain with a length, cut from the paper's slider",
        tables={
            name: str(ROOT / f"paper/tables/larger_{name}_full.csv") for name in ("nucleation", "settled")
        },
    )
