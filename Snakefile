from snakemake.utils import min_version

min_version("9.20")


configfile: "config.yaml"


report: "workflow/report/workflow.rst"


include: "workflow/common.smk"  # the configuration, scenes, chains, digests of code
# The paper
include: "workflow/rules/scenes.smk"  # every transition, slips, mu_sapp, Figs. 10-13, the push
include: "workflow/rules/paper.smk"  # Eq. 15, claims, paper.pdf
# Is it right, and until when?
include: "workflow/rules/horizon.smk"  # proofs, and how errors grow
include: "workflow/rules/benchmark.smk"  # transitions of other solvers, scored
include: "workflow/rules/failures.smk"  # where methods fail
include: "workflow/rules/step_sweep.smk"  # counts against the step of a Runge-Kutta method
include: "workflow/rules/work_precision.smk"  # accuracy against computing time
# What do the numbers depend on?
include: "workflow/rules/noise.smk"  # noise in the normal loads
include: "workflow/rules/printed_digits.smk"  # sliders with the same printed inputs
include: "workflow/rules/resolution.smk"  # the number of blocks
include: "workflow/rules/grid.smk"  # any two values of the chain
include: "workflow/rules/mean_load.smk"  # the time mean of F_X
# Other models
include: "workflow/rules/models.smk"  # smaller ones, and which answers which question
include: "workflow/rules/larger.smk"  # chains with a length
# All of it in a browser
include: "workflow/rules/explorer.smk"


RESULTS = [
    rules.scenes.input,
    rules.paper.input,
    rules.horizon.input,
    rules.benchmark.input,
    rules.failures.input,
    rules.step_sweep.input,
    rules.work_precision.input,
    rules.noise.input,
    rules.printed_digits.input,
    rules.resolution.input,
    rules.grid.input,
    rules.models.input,
    rules.larger.input,
    rules.explorer.input,
]


rule all:
    default_target: True
    input:
        RESULTS,
        "results/provenance.json",
    localrule: True


rule accuracy:
    input:
        rules.horizon.input,
        rules.failures.input,
        rules.step_sweep.input,
        rules.work_precision.input,
    localrule: True


include: "workflow/rules/provenance.smk"  # where the results come from; names that scenes may not have
