# On demand: snakemake -c1 results/tables/scaling.csv; it takes a minute or two with nothing else running.


rule measure_scaling:
    input:
        code=code_of("measure_scaling"),
    output:
        costs="results/tables/scaling.csv",
        maps="results/tables/scaling_maps.csv",
        text="results/tables/scaling.md",
    log:
        "results/logs/measure_scaling.log",
    benchmark:
        "results/benchmarks/measure_scaling.tsv"
    threads: 1
    params:
        **{
            key: config[key]
            for key in ["chain", "duration", "fig13", "maps", "resolution", "scaling", "scenes"]
        },
    script:
        "../scripts/measure_scaling.py"
