from precursors.proof import scene_exact_chain


rule certify_scene:
    input:
        code=collect(
            "{library}/{module}.py",
            library=LIBRARY,
            module=[
                "proof/certificate",
                "proof/exact_chain",
                "proof/first_root",
                "proof/motion",
                "proof/tube",
                "chain",
                "storage",
            ],
        ),
    output:
        certificate="results/certificates/{scene}.json.gz",
    log:
        "results/logs/certify_scene/{scene}.log",
    benchmark:
        "results/benchmarks/certify_scene/{scene}.tsv"
    threads: 1
    params:
        chain=lambda wildcards: scene_exact_chain(config, wildcards.scene).as_text(),
        duration=lambda wildcards: scene_duration(config, wildcards.scene),
    script:
        "../scripts/certify_scene.py"
