# As in precursors.accuracy.failures.WAYS, which takes seconds to import.
WAYS_TO_FAIL = [
    "rk4_unstable",
    "leapfrog_unstable",
    "numerical_damping",
    "literal_friction",
    "dead_zone_too_small",
    "dead_zone_too_large",
    "creep",
    "stiffness",
    "missed_roots",
    "restart_on_root",
    "merged_transitions",
    "forward_only",
]


rule tabulate_step_sweep:
    input:
        code=code_of("tabulate_step_sweep"),
    output:
        table="results/tables/{sweep}.csv",
    log:
        "results/logs/tabulate_step_sweep/{sweep}.log",
    benchmark:
        "results/benchmarks/tabulate_step_sweep/{sweep}.tsv"
    wildcard_constraints:
        sweep="step_sweep(_full)?",
    threads: 1
    params:
        sliders={scene: scene_slider(config, scene) for scene in config["fig13"]},
        durations={scene: scene_duration(config, scene) for scene in config["fig13"]},
        ranges=lambda wildcards: config["step_sweep"][
            "full" if wildcards.sweep.endswith("_full") else "default"
        ],
    script:
        "../scripts/tabulate_step_sweep.py"


rule draw_step_sweep:
    input:
        table="results/tables/{sweep}.csv",
        code=code_of("draw_step_sweep"),
    output:
        png="results/figures/{sweep}.png",
        svg=report(
            "results/figures/{sweep}.svg",
            caption="../report/step_sweep.rst",
            category="Speed and accuracy",
            labels={"figure": "{sweep}: the paper's numbers against the step"},
        ),
    log:
        "results/logs/draw_step_sweep/{sweep}.log",
    benchmark:
        "results/benchmarks/draw_step_sweep/{sweep}.tsv"
    wildcard_constraints:
        sweep="step_sweep(_full)?",
    threads: 1
    script:
        "../scripts/draw_step_sweep.py"


rule tabulate_failures:
    input:
        code=code_of("tabulate_failures"),
    output:
        table="results/tables/failures.csv",
        curves=collect("results/tables/failures/{way}.csv", way=WAYS_TO_FAIL),
    log:
        "results/logs/tabulate_failures.log",
    benchmark:
        "results/benchmarks/tabulate_failures.tsv"
    threads: 1
    script:
        "../scripts/tabulate_failures.py"


rule draw_failure_gallery:
    input:
        numbers="results/tables/failures.csv",
        curves=collect("results/tables/failures/{way}.csv", way=WAYS_TO_FAIL),
        code=code_of("draw_failure_gallery"),
    output:
        png="results/figures/failure_gallery.png",
        svg=report(
            "results/figures/failure_gallery.svg",
            caption="../report/failure_gallery.rst",
            category="Speed and accuracy",
            labels={"figure": "failure_gallery: how methods fail"},
        ),
    log:
        "results/logs/draw_failure_gallery.log",
    benchmark:
        "results/benchmarks/draw_failure_gallery.tsv"
    threads: 1
    script:
        "../scripts/draw_failure_gallery.py"
