from snakemake.utils import min_version

min_version("9.20")


report: "workflow/report/workflow.rst"


include: "workflow/common.smk"  # config.yaml, its scenes and their chains, digests of code


# Each is a file of workflow/rules and, as the last rule in it, a target.
PARTS = [
    # The paper
    "scenes",  # every transition, slips, mu_sapp, Figs. 10-13
    "paper",  # Eq. 15, claims, Fig. 9, paper.pdf
    # Studies on which claims rest, or other studies
    "noise",  # noise in the normal loads
    "printed_digits",  # sliders with the same printed inputs
    "resolution",  # the number of blocks
    "horizon",  # proofs, and how errors grow
    "models",  # smaller models, and which answers which question
    # Studies on which no claim rests
    "grid",  # mu_sapp over any two values of the chain
    "larger",  # chains with a length
    "benchmark",  # transitions of other solvers, scored
    "failures",  # where methods fail
    "step_sweep",  # counts against the step of a Runge-Kutta method
    "work_precision",  # accuracy against computing time
    # All of it in a browser
    "explorer",
]

for part in PARTS:

    include: f"workflow/rules/{part}.smk"


RESULTS = [getattr(rules, part).input for part in PARTS]


rule all:
    """Everything but what is made on demand."""
    default_target: True
    input:
        RESULTS,
        "results/provenance.json",
    localrule: True


rule accuracy:
    """Until when a run is right, and what that costs."""
    input:
        [getattr(rules, part).input for part in ("horizon", "failures", "step_sweep", "work_precision")],
    localrule: True


include: "workflow/rules/mean_load.smk"  # the time mean of F_X, on demand
include: "workflow/rules/provenance.smk"  # where the results come from; names that scenes may not have
