from precursors.model.chain import parse_theta

COMPARED = config["accuracy"]["chains"]
THETAS = {name: parse_theta(config["horizon"]["chains"][name].get("theta", 0)) for name in COMPARED}


rule measure_methods:
    input:
        certificates=collect("results/certificates/chains/{chain}.json.gz", chain=COMPARED),
        code=code_of("measure_methods"),
    output:
        table="results/tables/work_precision.csv",
    log:
        "results/logs/measure_methods.log",
    benchmark:
        "results/benchmarks/measure_methods.tsv"
    threads: 1
    params:
        thetas=THETAS,
        size=config["accuracy"]["default"],
    script:
        "../scripts/measure_methods.py"


rule measure_methods_fully:
    input:
        certificates=collect("results/certificates/chains/{chain}.json.gz", chain=COMPARED),
        code=code_of("measure_methods"),
    output:
        table="results/tables/work_precision_full.csv",
    log:
        "results/logs/measure_methods_fully.log",
    benchmark:
        "results/benchmarks/measure_methods_fully.tsv"
    threads: 1
    params:
        thetas=THETAS,
        size=config["accuracy"]["full"],
    script:
        "../scripts/measure_methods.py"


rule draw_work_precision:
    input:
        table="results/tables/work_precision.csv",
        code=code_of("draw_work_precision"),
    output:
        time_png="results/figures/work_precision.png",
        time_svg=report(
            "results/figures/work_precision.svg",
            caption="../report/work_precision.rst",
            category="Speed and accuracy",
            labels={"figure": "work_precision: errors against time"},
        ),
        evaluations_png="results/figures/work_precision_evaluations.png",
        evaluations_svg=report(
            "results/figures/work_precision_evaluations.svg",
            caption="../report/work_precision_evaluations.rst",
            category="Speed and accuracy",
            labels={"figure": "work_precision_evaluations: errors against evaluations"},
        ),
    log:
        "results/logs/draw_work_precision.log",
    benchmark:
        "results/benchmarks/draw_work_precision.tsv"
    threads: 1
    script:
        "../scripts/draw_work_precision.py"


rule accuracy_full:
    input:
        collect(
            "results/figures/{figure}.svg",
            figure=["work_precision_full", "work_precision_evaluations_full", "step_sweep_full"],
        ),


rule draw_work_precision_full:
    input:
        table="results/tables/work_precision_full.csv",
        code=code_of("draw_work_precision"),
    output:
        time_png="results/figures/work_precision_full.png",
        time_svg=report(
            "results/figures/work_precision_full.svg",
            caption="../report/work_precision.rst",
            category="Speed and accuracy",
            labels={"figure": "work_precision_full: errors against time, all methods"},
        ),
        evaluations_png="results/figures/work_precision_evaluations_full.png",
        evaluations_svg=report(
            "results/figures/work_precision_evaluations_full.svg",
            caption="../report/work_precision_evaluations.rst",
            category="Speed and accuracy",
            labels={"figure": "work_precision_evaluations_full: errors against evaluations, all methods"},
        ),
    log:
        "results/logs/draw_work_precision_full.log",
    benchmark:
        "results/benchmarks/draw_work_precision_full.tsv"
    threads: 1
    script:
        "../scripts/draw_work_precision.py"


rule measure_growth:
    input:
        code=code_of("measure_growth"),
    output:
        table="results/tables/growth.csv",
    log:
        "results/logs/measure_growth.log",
    benchmark:
        "results/benchmarks/measure_growth.tsv"
    threads: 1
    params:
        size=config["accuracy"]["growth"],
    script:
        "../scripts/measure_growth.py"


rule draw_growth:
    input:
        table="results/tables/growth.csv",
        code=code_of("draw_growth"),
    output:
        png="results/figures/growth.png",
        svg=report(
            "results/figures/growth.svg",
            caption="../report/growth.rst",
            category="Speed and accuracy",
            labels={"figure": "growth: time per transition against N"},
        ),
    log:
        "results/logs/draw_growth.log",
    benchmark:
        "results/benchmarks/draw_growth.tsv"
    threads: 1
    script:
        "../scripts/draw_growth.py"
