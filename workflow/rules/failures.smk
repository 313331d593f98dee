# Where methods fail

TABLES["failures"] = Table(
    function="maegawa2010.studies.failures.tables:failure_curves",
    message="making every method fail",
    also=[f"{PAPERS}/methods/methods.csv"],
    tables=[],
    beside=["failure_curves"],
    seconds=3,
)
FIGURES["failure_gallery"] = Figure(
    section="accuracy",
    function="maegawa2010.studies.failures.figure:draw",
    shows="nine ways in which methods fail",
    tables={
        "curves": "results/tables/failure_curves.csv",
        "panels": f"{PAPERS}/studies/failures/failure_gallery.csv",
    },
)
