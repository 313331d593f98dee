from snakemake.utils import min_version

min_version("9.20")


report: "workflow/report/workflow.rst"


include: "workflow/common.smk"  # the configuration, and names that all rules share
# The paper
include: "workflow/rules/scenes.smk"  # every transition, slips, mu_sapp, Figs. 10-13
include: "workflow/rules/paper.smk"  # Eq. 15, claims, Fig. 9, paper.pdf, supplement.pdf
# Studies on which claims or other studies rest; `snakemake --list` describes each of them
include: "workflow/studies/noise/rules.smk"
include: "workflow/studies/printed_digits/rules.smk"
include: "workflow/studies/resolution/rules.smk"
include: "workflow/studies/horizon/rules.smk"
include: "workflow/studies/models/rules.smk"
# Studies on which no claim rests
include: "workflow/studies/balance/rules.smk"
include: "workflow/studies/failures/rules.smk"
include: "workflow/studies/step_sweep/rules.smk"
include: "workflow/studies/work_precision/rules.smk"
# Committed tables of long studies, which a full build makes
include: "workflow/rules/article.smk"
# The interactive page
include: "workflow/rules/explorer.smk"


rule all:
    """All results, except those that are made on demand."""
    default_target: True
    input:
        RESULTS,
        "results/provenance.json",
    localrule: True


rule accuracy:
    """How long a run is accurate, how methods fail, and what accuracy costs."""
    input:
        rules.horizon.input,
        rules.failures.input,
        rules.step_sweep.input,
        rules.work_precision.input,
    localrule: True


include: "workflow/rules/provenance.smk"
