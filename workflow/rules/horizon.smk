from precursors.accuracy.proof.proved import certificate_path, chain_duration, exact_chain

CHAINS = config["horizon"]["chains"]
COMMITTED = os.path.normpath(f"{ROOT}/workflow/certificates")


wildcard_constraints:
    chain="|".join(CHAINS),


rule take_certificates:
    input:
        committed=[path for chain in CHAINS for path in certificate_path(COMMITTED, chain)],
        code=code_of("take_certificates"),
    output:
        certificates=collect("results/certificates/chains/{chain}.json.gz", chain=CHAINS),
    log:
        "results/logs/take_certificates.log",
    benchmark:
        "results/benchmarks/take_certificates.tsv"
    threads: 1
    params:
        chains=[exact_chain(values).as_text() for values in CHAINS.values()],
        durations=[chain_duration(values) for values in CHAINS.values()],
    script:
        "../scripts/take_certificates.py"


rule prove_again:
    input:
        certificate="results/certificates/chains/{chain}.json.gz",
        code=code_of("prove_again"),
    output:
        table="results/tables/proved/{chain}.csv",
    log:
        "results/logs/prove_again/{chain}.log",
    benchmark:
        "results/benchmarks/prove_again/{chain}.tsv"
    threads: 1
    script:
        "../scripts/prove_again.py"


rule prove_scenes:
    input:
        collect("results/tables/proved/{chain}.csv", chain=CHAINS),


rule tabulate_certificates:
    input:
        certificates=collect("results/certificates/chains/{chain}.json.gz", chain=CHAINS),
        effort=f"{COMMITTED}/effort.csv",
        code=code_of("tabulate_certificates"),
    output:
        table="results/tables/certificates.csv",
    log:
        "results/logs/tabulate_certificates.log",
    benchmark:
        "results/benchmarks/tabulate_certificates.tsv"
    threads: 1
    params:
        chains=list(CHAINS),
    script:
        "../scripts/tabulate_certificates.py"


rule tabulate_horizon:
    input:
        certificates=collect("results/certificates/chains/{chain}.json.gz", chain=CHAINS),
        code=code_of("tabulate_horizon"),
    output:
        horizon="results/tables/horizon.csv",
        summary="results/tables/solver_vs_proof.csv",
    log:
        "results/logs/tabulate_horizon.log",
    benchmark:
        "results/benchmarks/tabulate_horizon.tsv"
    threads: 1
    params:
        chains=list(CHAINS),
        tolerance=config["horizon"]["tolerance"],
    script:
        "../scripts/tabulate_horizon.py"


rule tabulate_lyapunov:
    input:
        code=code_of("tabulate_lyapunov"),
    output:
        table="results/tables/lyapunov.csv",
    log:
        "results/logs/tabulate_lyapunov.log",
    benchmark:
        "results/benchmarks/tabulate_lyapunov.tsv"
    threads: 1
    params:
        sliders={scene: scene_slider(config, scene) for scene in config["fig13"]},
        duration=config["horizon"]["lyapunov_duration"],
    script:
        "../scripts/tabulate_lyapunov.py"


rule draw_horizon:
    input:
        horizon="results/tables/horizon.csv",
        summary="results/tables/solver_vs_proof.csv",
        lyapunov="results/tables/lyapunov.csv",
        code=code_of("draw_horizon"),
    output:
        png="results/figures/horizon.png",
        svg=report(
            "results/figures/horizon.svg",
            caption="../report/horizon.rst",
            category="Proof and horizon",
            labels={"figure": "horizon: predicted and actual error"},
        ),
    log:
        "results/logs/draw_horizon.log",
    benchmark:
        "results/benchmarks/draw_horizon.tsv"
    threads: 1
    params:
        chains=CHAINS,
        thetas={scene: scene_slider(config, scene)["theta"] for scene in config["fig13"]},
        tolerance=config["horizon"]["tolerance"],
    script:
        "../scripts/draw_horizon.py"
