# mu_sapp over any two values of the chain

from maegawa2010.studies.grid.axes import RATIO, check_axes

check_axes(config["chain"], config["grid"])

ENSEMBLES["grid"] = Ensemble(
    function="maegawa2010.studies.grid.tables:grid_study",
    options={"slider": config["chain"], "axes": config["grid"]},
)
TABLES["grid"] = Table(
    function="maegawa2010.studies.members:gather",
    message="gathering the runs of the grid",
    inputs={"chunks": chunks_of(study="grid")},
    tables=[],
    beside=["grid"],
)
FIGURES["grid"] = Figure(
    section="sensitivity",
    function="maegawa2010.studies.grid.figure:draw",
    shows=f"mu_sapp over {' and '.join(axis['key'] for axis in config['grid'])}",
    tables={"table": "results/tables/grid.csv"},
    options={
        "axes": config["grid"],
        "scenes": [
            tuple({**slider, RATIO: slider["mu_k"] / slider["mu_s"]}[axis["key"]] for axis in config["grid"])
            for slider in SLIDERS.values()
        ],
    },
)
