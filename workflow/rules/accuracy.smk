# methods, proofs

from maegawa2010.studies.horizon.chains import chain_duration, exact_chain, scene_exact_chain
from precursors.model.chain import parse_theta

CHAINS = config["accuracy"]["proved"]
THETAS = {chain: parse_theta(CHAINS[chain].get("theta", 0)) for chain in config["accuracy"]["compared"]}
EVEN = min(THETAS, key=lambda chain: abs(THETAS[chain]))
COMMITTED = ROOT / "workflow/certificates"
BENCHMARKS = ROOT / "benchmarks"

CERTIFICATES = {chain: f"results/certificates/chains/{chain}.json.gz" for chain in CHAINS}
TABLES |= {
    "proofs": {
        "function": "maegawa2010.studies.horizon.solver_vs_proof:proof_tables",
        "inputs": {"certificates": CERTIFICATES, "effort": str(COMMITTED / "effort.csv")},
        "options": {"tolerance": config["accuracy"]["tolerance"]},
        "tables": ["certificates", "solver_vs_proof"],
        "beside": ["horizon"],
    },
    "lyapunov": {
        "function": "maegawa2010.studies.horizon.lyapunov:lyapunov_table",
        "options": {"sliders": SLIDERS, "duration": config["accuracy"]["lyapunov_duration"]},
        "seconds": 2,
    },
    "work_precision": {
        "function": "maegawa2010.studies.work_precision.tables:work_precision_table",
        "inputs": {"certificate": CERTIFICATES[EVEN]},
        "options": {"scene": EVEN, "full": config["full"]},
        "seconds": 100 if config["full"] else 4,
    },
    "benchmark": {
        "function": "precursors.benchmark.score:score_table",
        "inputs": {"solvers": str(BENCHMARKS / "solvers.csv")},
        "options": {"folder": str(BENCHMARKS / "results")},
        "also": sorted([*COMMITTED.glob("*.json.gz"), *(BENCHMARKS / "results").glob("*.csv")]),
        "seconds": 2,
    },
    "step_sweep": {
        "function": "maegawa2010.studies.step_sweep.tables:step_sweep_table",
        "inputs": {"runs": RUNS},
        "options": {"full": config["full"]},
        "seconds": 3,
    },
    "failures": {
        "function": "maegawa2010.studies.failures.tables:failure_tables",
        "tables": ["thresholds"],
        "beside": ["failure_curves"],
        "seconds": 3,
    },
}


wildcard_constraints:
    chain="|".join(CHAINS),


rule accuracy:
    input:
        collect(
            "results/figures/{figure}.{kind}",
            figure=[
                "work_precision",
                "speed",
                "step_sweep",
                "failure_gallery",
                "horizon",
            ],
            kind=FORMATS,
        ),
        collect(
            "results/tables/{table}.csv", table=["certificates", "solver_vs_proof", "lyapunov", "benchmark"]
        ),
    localrule: True


rule take_certificates:
    input:
        committed=[path for chain in CHAINS if (path := COMMITTED / f"{chain}.json.gz").is_file()],
    output:
        certificates=collect("results/certificates/chains/{chain}.json.gz", chain=CHAINS),
    log:
        "results/logs/take_certificates.log",
    localrule: True
    params:
        chains=[exact_chain(values).as_text() for values in CHAINS.values()],
        durations=[chain_duration(values) for values in CHAINS.values()],
        code=digest("take_certificates"),
    script:
        "../scripts/take_certificates.py"


# On demand: the reference problems of docs/benchmark.md as plain files, and in one archive.
rule benchmark:
    input:
        certificates=sorted(COMMITTED.glob("*.json.gz")),
        page=ROOT / "docs/benchmark.md",
        licence=ROOT / "LICENSE-text",
    output:
        folder=directory("results/benchmark"),
        archive="results/benchmark.zip",
    log:
        "results/logs/benchmark.log",
    localrule: True
    params:
        code=digest("write_benchmark"),
    script:
        "../scripts/write_benchmark.py"


# On demand: `prove_scenes` makes every proof again.
rule prove_scenes:
    input:
        collect("results/tables/proved/{chain}.csv", chain=CHAINS),
    localrule: True


rule prove_again:
    input:
        certificate="results/certificates/chains/{chain}.json.gz",
    output:
        table="results/tables/proved/{chain}.csv",
    log:
        "results/logs/prove_again/{chain}.log",
    params:
        code=digest("prove_again"),
    script:
        "../scripts/prove_again.py"


# On demand: the proof of one scene of the configuration.
rule certify_scene:
    output:
        certificate="results/certificates/{scene}.json.gz",
    log:
        "results/logs/certify_scene/{scene}.log",
    params:
        chains=lambda wildcards: [scene_exact_chain(config, wildcards.scene).as_text()],
        durations=lambda wildcards: [scene_duration(config, wildcards.scene)],
        code=digest("take_certificates"),
    script:
        "../scripts/take_certificates.py"
