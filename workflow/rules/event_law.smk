# The number of events by theory

# Only the full study: the article is made from what is committed of it.
if config["full"]:
    ENSEMBLES["event_law_members"] = Ensemble(
        function="maegawa2010.studies.event_law.tables:event_law_study",
        options={"slider": config["chain"], "settings": config["event_law"]},
    )
    TABLES["event_law"] = Table(
        function="maegawa2010.studies.event_law.tables:event_law_tables",
        message="comparing the number of events with the law",
        inputs={"chunks": chunks_of(study="event_law_members")},
        options={"slider": config["chain"]},
        beside=["event_law_members"],
    )
