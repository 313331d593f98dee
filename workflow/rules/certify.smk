from precursors.accuracy.proof import scene_exact_chain


rule certify_scene:
    input:
        code=code_of("certify_scene"),
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
