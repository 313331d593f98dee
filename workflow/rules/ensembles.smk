from precursors.ensembles.catalogue import STUDIES, chunk_names, make_study


wildcard_constraints:
    study="|".join(STUDIES),
    chunk="[0-9]+-[0-9]+",


rule run_chunk:
    input:
        code=code_of("run_chunk"),
    output:
        chunk="results/ensembles/{study}/{chunk}.h5",
    log:
        "results/logs/run_chunk/{study}_{chunk}.log",
    benchmark:
        "results/benchmarks/run_chunk/{study}_{chunk}.tsv"
    threads: 1
    params:
        members=lambda wildcards: make_study(config, wildcards.study).fingerprint,
    script:
        "../scripts/run_chunk.py"


rule gather_members:
    input:
        chunks=lambda wildcards: collect(
            "results/ensembles/{{study}}/{chunk}.h5", chunk=chunk_names(config, wildcards.study)
        ),
        code=code_of("gather_members"),
    output:
        table="results/tables/{study}.csv",
    log:
        "results/logs/gather_members/{study}.log",
    benchmark:
        "results/benchmarks/gather_members/{study}.tsv"
    threads: 1
    script:
        "../scripts/gather_members.py"
