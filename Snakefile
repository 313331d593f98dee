from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.utils import min_version

from precursors.config import check_config, check_directory, scenes_with

min_version("9.20")


configfile: "config.yaml"


report: "workflow/report/workflow.rst"


try:
    check_config(config, workflow.source_path("workflow/schemas/config.schema.yaml"))
    check_directory("results")
except ValueError as error:
    raise WorkflowError(str(error)) from None


# All results but their provenance, which comes after them.
RESULTS = [
    "results/explorer.html",
    collect(
        "results/figures/{figure}.{kind}",
        figure=["fig09", *scenes_with(config, "figure"), "fig13"],
        kind=["png", "svg"],
    ),
    collect("results/tables/{table}.csv", table=["mu_sapp", "reproduction", "eq15"]),
    collect("results/figures/definitions.{kind}", kind=["png", "svg"]),
    lambda wildcards: LEDGER,
    lambda wildcards: PAPER,
    collect(
        "results/figures/{figure}.{kind}",
        figure=["work_precision", "work_precision_evaluations", "growth"],
        kind=["png", "svg"],
    ),
    collect("results/figures/{figure}.{kind}", figure=["step_sweep", "failure_gallery"], kind=["png", "svg"]),
    collect("results/figures/spread_{question}.svg", question=["loads", "theta", "start", "parameters"]),
    collect("results/figures/map_{axis}.svg", axis=["blocks", "friction", "stiffness", "velocity"]),
    collect("results/tables/{scene}_answers.csv", scene=scenes_with(config, "answers")),
    collect("results/figures/{figure}.svg", figure=["resolution", "resolution_models", "long_runs"]),
    collect(
        "results/tables/{table}.csv",
        table=[
            "spread",
            "robustness",
            "resolution",
            "resolution_limits",
            "resolution_models",
            "long_runs_statistics",
        ],
    ),
    collect("results/figures/horizon.{kind}", kind=["png", "svg"]),
    collect("results/tables/{table}.csv", table=["certificates", "solver_vs_proof", "lyapunov"]),
    collect("results/figures/ladder.{kind}", kind=["png", "svg"]),
]


onerror:
    print("What is finished is kept: the same command goes on from there. Each job says why in results/logs.")


rule all:
    input:
        RESULTS,
        "results/provenance.json",


include: "workflow/rules/common.smk"
include: "workflow/rules/simulate.smk"
include: "workflow/rules/analyse.smk"
include: "workflow/rules/answer.smk"
include: "workflow/rules/check.smk"
include: "workflow/rules/draw.smk"
include: "workflow/rules/certify.smk"
include: "workflow/rules/horizon.smk"
include: "workflow/rules/accuracy.smk"
include: "workflow/rules/failures.smk"
include: "workflow/rules/ensembles.smk"
include: "workflow/rules/spread.smk"
include: "workflow/rules/maps.smk"
include: "workflow/rules/claims.smk"
include: "workflow/rules/explore.smk"
include: "workflow/rules/ladder.smk"
include: "workflow/rules/scaling.smk"
include: "workflow/rules/cluster.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/provenance.smk"
include: "workflow/rules/paper.smk"
