import shlex
import signal
import sys
import threading
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.utils import min_version

from precursors.model.scenes import scenes_with
from precursors.model.config_check import check_config, check_directory
from precursors.model.config_file import check_config_file

min_version("9.20")

# Snakemake writes it into shell commands as it is, and a path may hold spaces (snakemake/snakemake#2645).
if Path(sys.executable).exists():
    sys.executable = shlex.quote(sys.executable)

GO_ON = "What is finished is kept: the same command goes on from there."

# asyncio takes Ctrl-C over from Python's own handler, and Snakemake may lose it there or take it for an error.
if (
    not workflow.modifier.is_module
    and threading.current_thread() is threading.main_thread()
    and signal.getsignal(signal.SIGINT) is signal.default_int_handler
):
    signal.signal(signal.SIGINT, lambda *_: sys.exit(f"Interrupted. {GO_ON}"))


# Before Snakemake reads it, and evaluates Python in it if it asks for that. Files of the command line are read by now.
if not workflow.modifier.skip_configfile:
    try:
        for path in ["config.yaml", *workflow.overwrite_configfiles]:
            check_config_file(path)
    except ValueError as error:
        raise WorkflowError(str(error)) from None


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
    print(f"{GO_ON} Each job says why in results/logs.")


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
