from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.utils import min_version

from precursors.config import check_config, check_directory, scene_names

min_version("9.20")


configfile: "config.yaml"


try:
    check_config(config, Path(workflow.basedir) / "workflow/schemas/config.schema.yaml")
    check_directory("results")
except ValueError as error:
    raise WorkflowError(str(error)) from None


rule all:
    input:
        collect(
            "results/figures/{figure}.{kind}",
            figure=["fig09", *scene_names(config), "fig13"],
            kind=["png", "svg"],
        ),
        collect("results/tables/{table}.csv", table=["mu_sapp", "reproduction", "eq15"]),


include: "workflow/rules/common.smk"
include: "workflow/rules/simulate.smk"
include: "workflow/rules/analyse.smk"
include: "workflow/rules/check.smk"
include: "workflow/rules/draw.smk"
include: "workflow/rules/certify.smk"
