# Comes after everything else that `all` asks for.
rule write_provenance:
    input:
        RESULTS,
        code=code_of("write_provenance"),
    output:
        json="results/provenance.json",
    log:
        "results/logs/write_provenance.log",
    benchmark:
        "results/benchmarks/write_provenance.tsv"
    threads: 1
    params:
        root=ROOT,
        config=config,
    script:
        "../scripts/write_provenance.py"

