from precursors.ensembles.catalogue import STUDIES, chunk_names, make_study
from precursors.ensembles.maps import AXES
from precursors.ensembles.questions import QUESTIONS

MAPS = list(AXES)


wildcard_constraints:
    study="|".join(STUDIES),
    chunk="[0-9]+-[0-9]+",
    map="|".join(MAPS),


rule ensembles:
    input:
        collect("results/figures/spread_{question}.svg", question=QUESTIONS),
        collect("results/figures/{map}.svg", map=MAPS),
        collect("results/figures/{figure}.svg", figure=["resolution", "long_runs"]),
        collect("results/tables/{table}.csv", table=["spread", "robustness", "resolution_limits"]),
    localrule: True


rule run_chunk:
    input:
        # Not all of the room: the members of a study are a parameter.
        code=package("model/chain", "solver", "analysis", "ensembles/chunks", "ensembles/study"),
    output:
        chunk="results/ensembles/{study}/{chunk}.h5",
    log:
        "results/logs/run_chunk/{study}_{chunk}.log",
    params:
        members=lambda wildcards: make_study(config, wildcards.study).fingerprint,
    script:
        "../scripts/run_chunk.py"


rule gather_members:
    input:
        chunks=lambda wildcards: collect(
            "results/ensembles/{{study}}/{chunk}.h5", chunk=chunk_names(config, wildcards.study)
        ),
        code=package("ensembles/chunks", "ensembles/study"),
    output:
        table="results/tables/{study}.csv",
    log:
        "results/logs/gather_members/{study}.log",
    localrule: True
    script:
        "../scripts/gather_members.py"


rule tabulate_spread:
    input:
        members="results/tables/spread_members.csv",
        code=package("model", "analysis", "ensembles/questions", "ensembles/spread", "ensembles/study"),
    output:
        spread=report("results/tables/spread.csv", category="Tables"),
        robustness=report("results/tables/robustness.csv", category="Tables"),
    log:
        "results/logs/tabulate_spread.log",
    localrule: True
    script:
        "../scripts/tabulate_spread.py"


rule tabulate_resolution:
    input:
        members="results/tables/resolution_members.csv",
        code=package("model", "analysis", "ensembles/resolution", "ensembles/study"),
    output:
        table=report("results/tables/resolution.csv", category="Tables"),
        limits=report("results/tables/resolution_limits.csv", category="Tables"),
    log:
        "results/logs/tabulate_resolution.log",
    localrule: True
    params:
        slider=config["chain"],
        fit_from=config["ensembles"]["resolution"]["fit_from"],
    script:
        "../scripts/tabulate_resolution.py"


rule tabulate_long_runs:
    input:
        code=package("model/chain", "solver", "analysis", "ensembles/long_runs"),
    output:
        slips="results/tables/long_runs.csv",
        statistics=report("results/tables/long_runs_statistics.csv", category="Tables"),
    log:
        "results/logs/tabulate_long_runs.log",
    params:
        sliders=SLIDERS,
        duration=config["ensembles"]["long_runs"]["duration"],
    script:
        "../scripts/tabulate_long_runs.py"
