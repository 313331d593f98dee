# noise, N, maps

from precursors.ensembles.catalogue import MAPS, STUDIES, study_arguments
from precursors.ensembles.maps import places_of
from precursors.ensembles.resolution import PREDICTED_UP_TO
from precursors.ensembles.spread import QUESTIONS

NUMBER_OF_CHUNKS = config["ensembles"]["chunks"]
CHUNKS = [f"{i}of{NUMBER_OF_CHUNKS}" for i in range(1, NUMBER_OF_CHUNKS + 1)]


wildcard_constraints:
    study="|".join(STUDIES),
    map="|".join(MAPS),
    chunk="[0-9]+of[0-9]+",


rule ensembles:
    input:
        collect("results/figures/spread_{question}.svg", question=QUESTIONS),
        [f"results/figures/map_{x}_{y}.svg" for x, y in config["ensembles"]["maps"]["pairs"]],
        collect("results/figures/{figure}.svg", figure=["resolution", "event_law", "long_runs"]),
        collect(
            "results/tables/{table}.csv",
            table=["spread", "robustness", "resolution_limits", "digits"],
        ),
    localrule: True


rule run_chunk:
    output:
        chunk="results/ensembles/{study}/{chunk}.csv",
    log:
        "results/logs/run_chunk/{study}_{chunk}.log",
    params:
        arguments=lambda wildcards: study_arguments(config, wildcards.study),
        code=digest("run_chunk"),
    script:
        "../scripts/run_chunk.py"


rule gather_members:
    input:
        chunks=collect("results/ensembles/{{study}}/{chunk}.csv", chunk=CHUNKS),
    output:
        table="results/tables/{study}.csv",
    log:
        "results/logs/gather_members/{study}.log",
    localrule: True
    params:
        code=digest("gather_members"),
    script:
        "../scripts/gather_members.py"


rule tabulate_spread:
    input:
        members="results/tables/spread_members.csv",
    output:
        spread=report("results/tables/spread.csv", category="Tables"),
        robustness=report("results/tables/robustness.csv", category="Tables"),
    log:
        "results/logs/tabulate_spread.log",
    localrule: True
    params:
        code=digest("tabulate_spread"),
    script:
        "../scripts/tabulate_spread.py"


rule tabulate_resolution:
    input:
        members="results/tables/resolution_members.csv",
    output:
        table=report("results/tables/resolution.csv", category="Tables"),
        readings=report("results/tables/resolution_readings.csv", category="Tables"),
        limits=report("results/tables/resolution_limits.csv", category="Tables"),
        exponents=report("results/tables/resolution_exponents.csv", category="Tables"),
    log:
        "results/logs/tabulate_resolution.log",
    localrule: True
    params:
        slider=config["chain"],
        fit_from=config["ensembles"]["resolution"]["fit_from"],
        code=digest("tabulate_resolution"),
    script:
        "../scripts/tabulate_resolution.py"


rule tabulate_predictability:
    output:
        table=report("results/tables/predictability{full}.csv", category="Tables"),
    log:
        "results/logs/tabulate_predictability{full}.log",
    params:
        sliders=SLIDERS,
        n_blocks=lambda wildcards: [
            n
            for n in config["ensembles"]["resolution"]["n_blocks"]
            if n <= PREDICTED_UP_TO or wildcards.full
        ],
        duration=config["duration"],
        tolerance=config["accuracy"]["tolerance"],
        code=digest("tabulate_predictability"),
    script:
        "../scripts/tabulate_predictability.py"


rule tabulate_digits:
    input:
        members="results/tables/digits_members.csv",
    output:
        table=report("results/tables/digits.csv", category="Tables"),
    log:
        "results/logs/tabulate_digits.log",
    localrule: True
    params:
        code=digest("tabulate_digits"),
    script:
        "../scripts/tabulate_digits.py"


# On demand: the paper shows the committed table of `endless_full`.
rule tabulate_endless:
    input:
        members="results/tables/endless{full}_members.csv",
    output:
        table=report("results/tables/endless{full}.csv", category="Tables"),
    log:
        "results/logs/tabulate_endless{full}.log",
    localrule: True
    params:
        length=config["chain"]["length"],
        code=digest("tabulate_endless"),
    script:
        "../scripts/tabulate_endless.py"


rule tabulate_event_law:
    input:
        members="results/tables/event_law{full}_members.csv",
    output:
        table=report("results/tables/event_law{full}.csv", category="Tables"),
    log:
        "results/logs/tabulate_event_law{full}.log",
    localrule: True
    params:
        slider=config["chain"],
        code=digest("tabulate_event_law"),
    script:
        "../scripts/tabulate_event_law.py"


rule tabulate_long_runs:
    output:
        slips="results/tables/long_runs.csv",
        statistics=report("results/tables/long_runs_statistics.csv", category="Tables"),
    log:
        "results/logs/tabulate_long_runs.log",
    params:
        sliders=SLIDERS,
        duration=config["ensembles"]["long_runs"]["duration"],
        code=digest("tabulate_long_runs"),
    script:
        "../scripts/tabulate_long_runs.py"
