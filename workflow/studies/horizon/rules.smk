from maegawa2010.config import check_names
from maegawa2010.studies.horizon.chains import chain_duration, exact_chain, scene_exact_chain

CHAINS = config["horizon"]["proved"]
check_names("horizon.compared", config["horizon"]["compared"], CHAINS)
CERTIFICATES = {chain: f"results/certificates/chains/{chain}.json.gz" for chain in CHAINS}


wildcard_constraints:
    chain="|".join(CHAINS),


rule take_certificates:
    """Copy the committed proofs, and prove chains that have none."""
    input:
        committed=[path for chain in CHAINS if (path := PROOFS / f"{chain}.json.gz").is_file()],
    output:
        certificates=CERTIFICATES.values(),
    log:
        "results/logs/take_certificates.log",
    localrule: True
    params:
        chains=[exact_chain(name, values).as_text() for name, values in CHAINS.items()],
        durations=[chain_duration(values) for values in CHAINS.values()],
        code=digest("take_certificates"),
    script:
        "take_certificates.py"


rule tabulate_horizon:
    """Compare the solver with the proofs, and compute the largest Lyapunov exponents."""
    input:
        certificates=CERTIFICATES.values(),
    output:
        certificates=report("results/tables/certificates.csv", category="Tables"),
        solver_vs_proof=report("results/tables/solver_vs_proof.csv", category="Tables"),
        lyapunov=report("results/tables/lyapunov.csv", category="Tables"),
        horizon="results/tables/horizon.csv",
    log:
        "results/logs/tabulate_horizon.log",
    resources:
        seconds=3,
    params:
        sliders=SLIDERS,
        lyapunov_duration=config["horizon"]["lyapunov_duration"],
        tolerance=config["horizon"]["tolerance"],
        code=digest("tabulate_horizon"),
    script:
        "tabulate_horizon.py"


rule draw_horizon:
    """Draw how errors grow with time."""
    input:
        errors="results/tables/horizon.csv",
    output:
        report(
            "results/figures/horizon.svg",
            caption="caption.rst",
            category="Accuracy",
            labels={"figure": "horizon: how errors grow, predicted and actual"},
        ),
        collect("results/figures/horizon.{kind}", kind=MORE_FORMATS),
    log:
        "results/logs/draw_horizon.log",
    localrule: True
    params:
        thetas={chain: parse_theta(CHAINS[chain].get("theta", 0)) for chain in config["horizon"]["compared"]},
        tolerance=config["horizon"]["tolerance"],
        code=digest("draw_horizon"),
    script:
        "draw_horizon.py"


rule horizon:
    """The proofs of transitions, and how long a run is accurate."""
    input:
        rules.take_certificates.output,
        rules.tabulate_horizon.output,
        rules.draw_horizon.output,
    localrule: True


rule prove_again:
    """Prove every transition of a certificate again."""
    input:
        certificate="results/certificates/chains/{chain}.json.gz",
    output:
        table="results/tables/proved/{chain}.csv",
    log:
        "results/logs/prove_again/{chain}.log",
    resources:
        seconds=30,
    params:
        code=digest("prove_again"),
    script:
        "prove_again.py"


rule prove_scenes:
    """Prove the transitions of all certificates again (on demand)."""
    input:
        collect("results/tables/proved/{chain}.csv", chain=CHAINS),
    localrule: True


rule certify_scene:
    """Prove every transition of a scene of the configuration (on demand)."""
    output:
        certificate="results/certificates/{scene}.json.gz",
    log:
        "results/logs/certify_scene/{scene}.log",
    resources:
        seconds=30,
    params:
        chains=lambda wildcards: [scene_exact_chain(config, wildcards.scene).as_text()],
        durations=lambda wildcards: [scene_duration(config, wildcards.scene)],
        code=digest("take_certificates"),
    script:
        "take_certificates.py"


RESULTS.append(rules.horizon.input)  # files that `all` makes
