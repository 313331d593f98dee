# noise, printed digits, N, map

from maegawa2010.studies.registry import MAP, PREDICTED_UP_TO, STUDIES, study_arguments

NUMBER_OF_CHUNKS = config["ensembles"]["chunks"]
CHUNKS = [f"{i}of{NUMBER_OF_CHUNKS}" for i in range(1, NUMBER_OF_CHUNKS + 1)]
chunks_of = partial(collect, "results/ensembles/{study}/{chunk}.csv", chunk=CHUNKS)

TABLES |= {
    "noise": {
        "function": "maegawa2010.studies.noise.tables:noise_tables",
        "inputs": {"chunks": chunks_of(study="noise_members")},
        "tables": ["noise", "noise_differences", "noise_amplitudes"],
        "beside": ["noise_members"],
    },
    "digits": {
        "function": "maegawa2010.studies.printed_digits.tables:digits_tables",
        "inputs": {"chunks": chunks_of(study="digits_members")},
        "options": {"paper": {scene: PAPER_PRINTS[scene] for scene in config["fig13"]}},
        "beside": ["digits_members"],
    },
    "resolution": {
        "function": "maegawa2010.studies.resolution.tables:resolution_tables",
        "inputs": {
            "chunks": chunks_of(study="resolution_members"),
            "noise": "results/tables/noise_members.csv",
        },
        "options": {
            "slider": config["chain"],
            "uniform": min(SLIDERS, key=lambda scene: abs(SLIDERS[scene]["theta"])),
            "extrapolate_from": config["ensembles"]["resolution"]["extrapolate_from"],
        },
        "tables": ["resolution", "counts_by_n", "resolution_limits"],
        "beside": ["resolution_members"],
    },
    "predictability": {
        "function": "maegawa2010.studies.resolution.tables:predictability_table",
        "options": {
            "sliders": SLIDERS,
            "n_blocks": [
                n
                for n in sorted({*config["ensembles"]["resolution"]["n_blocks"], config["chain"]["n_blocks"]})
                if n <= PREDICTED_UP_TO or config["full"]
            ],
            "duration": config["duration"],
            "tolerance": config["accuracy"]["tolerance"],
        },
        "seconds": 120 if config["full"] else 1,
    },
    "event_law": {
        "function": "maegawa2010.studies.event_law.tables:event_law_tables",
        "inputs": {"chunks": chunks_of(study="event_law_members")},
        "options": {"slider": config["chain"]},
        "beside": ["event_law_members"],
    },
    **{
        study: {
            "function": "maegawa2010.studies.members:gather",
            "inputs": {"chunks": chunks_of(study=study)},
            "tables": [],
            "beside": [study],
        }
        for study in ("theta_window_members", MAP)
    },
}


wildcard_constraints:
    study="|".join(STUDIES),
    chunk="[0-9]+of[0-9]+",


rule ensembles:
    input:
        collect(
            "results/figures/{figure}.svg",
            figure=["hero", "theta_window", "noise", "resolution", "event_law", "map_theta_friction_ratio"],
        ),
        "results/tables/digits.csv",
    localrule: True


rule run_chunk:
    output:
        chunk="results/ensembles/{study}/{chunk}.csv",
    log:
        "results/logs/run_chunk/{study}_{chunk}.log",
    resources:
        seconds=lambda wildcards: 6 if wildcards.study == "resolution_members" else 2,
    params:
        arguments=lambda wildcards: study_arguments(config, wildcards.study),
        code=digest(
            "run_chunk", *(f"maegawa2010.studies.{study.rpartition('.')[0]}" for study in STUDIES.values())
        ),
    script:
        "../scripts/run_chunk.py"
