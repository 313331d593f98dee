# Proofs, and how errors grow

from maegawa2010.config import check_names
from maegawa2010.studies.horizon.chains import chain_duration, exact_chain, scene_exact_chain

CHAINS = config["horizon"]["proved"]
check_names("horizon.compared", config["horizon"]["compared"], CHAINS)

TABLES["proofs"] = Table(
    function="maegawa2010.studies.horizon.tables:proof_tables",
    message="comparing the solver with the proved transitions",
    inputs={"certificates": CERTIFICATES},
    options={"tolerance": config["horizon"]["tolerance"]},
    tables=["certificates", "solver_vs_proof"],
    beside=["horizon"],
)
TABLES["lyapunov"] = Table(
    function="maegawa2010.studies.horizon.lyapunov:lyapunov_table",
    message="measuring how fast neighbouring motions part",
    options={"sliders": SLIDERS, "duration": config["horizon"]["lyapunov_duration"]},
    seconds=2,
)
FIGURES["horizon"] = Figure(
    section="accuracy",
    function="maegawa2010.studies.horizon.figure:draw",
    shows="how errors grow, predicted and actual",
    tables={"errors": "results/tables/horizon.csv", "exponents": "results/tables/lyapunov.csv"},
    options={
        "thetas": {
            chain: parse_theta(CHAINS[chain].get("theta", 0)) for chain in config["horizon"]["compared"]
        },
        "tolerance": config["horizon"]["tolerance"],
    },
)
RESULTS += CERTIFICATES.values()


wildcard_constraints:
    chain="|".join(CHAINS),


rule take_certificates:
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
    message:
        "taking over the committed proofs, and proving what has none"
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
    message:
        "{wildcards.chain}: proving every transition again"
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
    message:
        "{wildcards.scene}: proving every transition"
    script:
        "../scripts/take_certificates.py"
