from snakemake.utils import min_version

min_version("9.20")


report: "workflow/report/workflow.rst"


include: "workflow/common.smk"  # config.yaml, its scenes and their chains, digests of code
# The paper
include: "workflow/rules/scenes.smk"  # every transition, slips, mu_sapp, Figs. 10-13
include: "workflow/rules/paper.smk"  # Eq. 15, claims, Fig. 9, paper.pdf
# Studies on which claims rest, or other studies
include: "workflow/rules/noise.smk"  # noise in the normal loads
include: "workflow/rules/printed_digits.smk"  # sliders with the same printed inputs
include: "workflow/rules/resolution.smk"  # the number of blocks
include: "workflow/rules/horizon.smk"  # proofs, and how errors grow
include: "workflow/rules/models.smk"  # smaller models, and which answers which question
# Studies on which no claim rests
include: "workflow/rules/balance.smk"  # the distance from kinetic balance, the mean of F_X
include: "workflow/rules/failures.smk"  # where methods fail
include: "workflow/rules/step_sweep.smk"  # counts against the step of a Runge-Kutta method
include: "workflow/rules/work_precision.smk"  # accuracy against computing time
# All of it in a browser
include: "workflow/rules/explorer.smk"


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
        rules.horizon.input,
        rules.failures.input,
        rules.step_sweep.input,
        rules.work_precision.input,
    localrule: True


include: "workflow/rules/provenance.smk"  # where the results come from; names that scenes may not have
