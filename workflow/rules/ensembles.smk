# noise, printed digits, N, map

from precursors.ensembles.studies import MAP, PREDICTED_UP_TO, STUDIES, study_arguments

NUMBER_OF_CHUNKS = config["ensembles"]["chunks"]
CHUNKS = [f"{i}of{NUMBER_OF_CHUNKS}" for i in range(1, NUMBER_OF_CHUNKS + 1)]
chunks_of = partial(collect, "results/ensembles/{study}/{chunk}.csv", chunk=CHUNKS)


wildcard_constraints:
    study="|".join(STUDIES),
    chunk="[0-9]+of[0-9]+",


rule ensembles:
    input:
        collect(
            "results/figures/{figure}.svg",
            figure=["noise", "theta_window", "resolution", "event_law", "map_theta_friction_ratio"],
        ),
        "results/tables/digits.csv",
        "results/tables/theta_window.csv",
    localrule: True


rule run_chunk:
    output:
        chunk="results/ensembles/{study}/{chunk}.csv",
    log:
        "results/logs/run_chunk/{study}_{chunk}.log",
    params:
        arguments=lambda wildcards: study_arguments(config, wildcards.study),
        code=digest("run_chunk", *(f"ensembles.{study.split('.')[0]}" for study in STUDIES.values())),
    script:
        "../scripts/run_chunk.py"


rule gather_map:
    input:
        chunks=chunks_of(study=MAP),
    output:
        members=f"results/tables/{MAP}.csv",
    log:
        "results/logs/gather_map.log",
    localrule: True
    params:
        code=digest("gather_members"),
    script:
        "../scripts/gather_members.py"


rule tabulate_noise:
    input:
        chunks=chunks_of(study="noise_members"),
    output:
        members="results/tables/noise_members.csv",
        table=report("results/tables/noise.csv", category="Tables"),
        differences=report("results/tables/noise_differences.csv", category="Tables"),
    log:
        "results/logs/tabulate_noise.log",
    localrule: True
    params:
        code=digest("tabulate_noise"),
    script:
        "../scripts/tabulate_noise.py"


rule tabulate_theta_window:
    input:
        chunks=chunks_of(study="theta_window_members"),
    output:
        members="results/tables/theta_window_members.csv",
        table=report("results/tables/theta_window.csv", category="Tables"),
    log:
        "results/logs/tabulate_theta_window.log",
    localrule: True
    params:
        code=digest("tabulate_theta_window"),
    script:
        "../scripts/tabulate_theta_window.py"


rule tabulate_resolution:
    input:
        chunks=chunks_of(study="resolution_members"),
        noise="results/tables/noise_members.csv",
    output:
        members="results/tables/resolution_members.csv",
        table=report("results/tables/resolution.csv", category="Tables"),
        counts=report("results/tables/counts_by_n.csv", category="Tables"),
        limits=report("results/tables/resolution_limits.csv", category="Tables"),
        exponents=report("results/tables/resolution_exponents.csv", category="Tables"),
    log:
        "results/logs/tabulate_resolution.log",
    localrule: True
    params:
        slider=config["chain"],
        uniform=min(SLIDERS, key=lambda scene: abs(SLIDERS[scene]["theta"])),
        extrapolate_from=config["ensembles"]["resolution"]["extrapolate_from"],
        code=digest("tabulate_resolution"),
    script:
        "../scripts/tabulate_resolution.py"


rule tabulate_predictability:
    output:
        table=report("results/tables/predictability.csv", category="Tables"),
    log:
        "results/logs/tabulate_predictability.log",
    params:
        sliders=SLIDERS,
        n_blocks=[
            n
            for n in sorted({*config["ensembles"]["resolution"]["n_blocks"], config["chain"]["n_blocks"]})
            if n <= PREDICTED_UP_TO or config["full"]
        ],
        duration=config["duration"],
        tolerance=config["accuracy"]["tolerance"],
        code=digest("tabulate_predictability"),
    script:
        "../scripts/tabulate_predictability.py"


rule tabulate_digits:
    input:
        chunks=chunks_of(study="digits_members"),
    output:
        members="results/tables/digits_members.csv",
        table=report("results/tables/digits.csv", category="Tables"),
    log:
        "results/logs/tabulate_digits.log",
    localrule: True
    params:
        paper={scene: config["scenes"][scene].get("paper", {}) for scene in config["fig13"]},
        code=digest("tabulate_digits"),
    script:
        "../scripts/tabulate_digits.py"


rule tabulate_event_law:
    input:
        chunks=chunks_of(study="event_law_members"),
    output:
        members="results/tables/event_law_members.csv",
        table=report("results/tables/event_law.csv", category="Tables"),
    log:
        "results/logs/tabulate_event_law.log",
    localrule: True
    params:
        slider=config["chain"],
        code=digest("tabulate_event_law"),
    script:
        "../scripts/tabulate_event_law.py"
