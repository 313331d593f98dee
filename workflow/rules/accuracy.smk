# methods, proofs

from precursors.accuracy.proof.chains import certificate_path, chain_duration, exact_chain, scene_exact_chain
from precursors.model.chain import parse_theta

CHAINS = config["accuracy"]["proved"]
COMPARED = config["accuracy"]["compared"]
COMMITTED = ROOT / "workflow/certificates"
# As in precursors.accuracy.failures.FAILURE_MODES, which takes seconds to import.
FAILURE_MODES = [
    "unstable",
    "silent_instability",
    "numerical_damping",
    "literal_friction",
    "dead_zone_too_small",
    "dead_zone_too_large",
    "creep",
    "stiffness",
    "missed_roots",
    "restart_on_root",
    "merged_transitions",
    "forward_only",
]


wildcard_constraints:
    chain="|".join(CHAINS),


rule accuracy:
    input:
        collect(
            "results/figures/{figure}.{kind}",
            figure=[
                "work_precision",
                "work_precision_evaluations",
                "speed",
                "step_sweep",
                "failure_gallery",
                "horizon",
            ],
            kind=FORMATS,
        ),
        collect("results/tables/{table}.csv", table=["certificates", "solver_vs_proof", "lyapunov"]),
    localrule: True


rule take_certificates:
    input:
        committed=[path for chain in CHAINS for path in certificate_path(COMMITTED, chain)],
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


rule tabulate_certificates:
    input:
        certificates=collect("results/certificates/chains/{chain}.json.gz", chain=CHAINS),
        effort=COMMITTED / "effort.csv",
    output:
        table=report("results/tables/certificates.csv", category="Tables"),
    log:
        "results/logs/tabulate_certificates.log",
    localrule: True
    params:
        chains=list(CHAINS),
        code=digest("tabulate_certificates"),
    script:
        "../scripts/tabulate_certificates.py"


rule tabulate_horizon:
    input:
        certificates=collect("results/certificates/chains/{chain}.json.gz", chain=CHAINS),
    output:
        horizon="results/tables/horizon.csv",
        summary=report("results/tables/solver_vs_proof.csv", category="Tables"),
    log:
        "results/logs/tabulate_horizon.log",
    localrule: True
    params:
        chains=list(CHAINS),
        tolerance=config["accuracy"]["tolerance"],
        code=digest("tabulate_horizon"),
    script:
        "../scripts/tabulate_horizon.py"


rule tabulate_lyapunov:
    output:
        table=report("results/tables/lyapunov.csv", category="Tables"),
    log:
        "results/logs/tabulate_lyapunov.log",
    params:
        sliders=SLIDERS,
        duration=config["accuracy"]["lyapunov_duration"],
        code=digest("tabulate_lyapunov"),
    script:
        "../scripts/tabulate_lyapunov.py"


rule measure_methods:
    input:
        certificates=collect("results/certificates/chains/{chain}.json.gz", chain=COMPARED),
    output:
        table=report("results/tables/work_precision.csv", category="Tables"),
    log:
        "results/logs/measure_methods.log",
    params:
        thetas={name: parse_theta(CHAINS[name].get("theta", 0)) for name in COMPARED},
        full=config["full"],
        code=digest("measure_methods"),
    script:
        "../scripts/measure_methods.py"


rule tabulate_step_sweep:
    input:
        runs=collect("results/runs/{scene}.h5", scene=config["fig13"]),
    output:
        table=report("results/tables/step_sweep.csv", category="Tables"),
    log:
        "results/logs/tabulate_step_sweep.log",
    params:
        thetas={scene: slider["theta"] for scene, slider in SLIDERS.items()},
        full=config["full"],
        code=digest("tabulate_step_sweep"),
    script:
        "../scripts/tabulate_step_sweep.py"


rule tabulate_failures:
    output:
        numbers=report("results/tables/failures.csv", category="Tables"),
        thresholds=report("results/tables/thresholds.csv", category="Tables"),
        curves=collect("results/tables/failures/{mode}.csv", mode=FAILURE_MODES),
    log:
        "results/logs/tabulate_failures.log",
    params:
        code=digest("tabulate_failures"),
    script:
        "../scripts/tabulate_failures.py"
