from precursors.ensembles.questions import QUESTIONS


rule tabulate_spread:
    input:
        members="results/tables/spread_members.csv",
        code=code_of("tabulate_spread"),
    output:
        spread="results/tables/spread.csv",
        robustness="results/tables/robustness.csv",
    log:
        "results/logs/tabulate_spread.log",
    benchmark:
        "results/benchmarks/tabulate_spread.tsv"
    threads: 1
    script:
        "../scripts/tabulate_spread.py"


rule draw_spread:
    input:
        members="results/tables/spread_members.csv",
        spread="results/tables/spread.csv",
        code=code_of("draw_spread"),
    output:
        collect("results/figures/spread_{question}.png", question=QUESTIONS),
        [
            report(
                f"results/figures/spread_{question}.svg",
                caption="../report/spread.rst",
                category="Sensitivity",
                labels={"figure": f"spread_{question}: changes of {question}"},
            )
            for question in QUESTIONS
        ],
    log:
        "results/logs/draw_spread.log",
    benchmark:
        "results/benchmarks/draw_spread.tsv"
    threads: 1
    params:
        questions=[*QUESTIONS, *QUESTIONS],
    script:
        "../scripts/draw_spread.py"
