import os
from functools import partial
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.utils import min_version

from maegawa2010 import printed
from maegawa2010.config import check_config, check_file, read_numbers
from maegawa2010.scenes import (
    scene_additions,
    scene_duration,
    scene_slider,
    scenes_with,
    scenes_with_theta,
)
from maegawa2010.support.digest import digest_code

min_version("9.20")

# As seen from the working directory; `workflow.basedir` would be another workflow's that uses this one as a module.
ROOT = Path(os.path.relpath(workflow.current_basedir.get_path_or_uri(secret_free=True)))
PAPERS = ROOT / "src/maegawa2010"
# What a script computes: its rule has it as a parameter, and its jobs run again when it changes.
digest = partial(digest_code, ROOT)


if not workflow.modifier.skip_configfile:
    try:
        for path in ["config.yaml", *workflow.overwrite_configfiles]:
            if os.path.exists(path):  # else Snakemake says that it is missing
                check_file(path)
    except ValueError as error:
        raise WorkflowError(str(error)) from None


configfile: "config.yaml"


report: "workflow/report/workflow.rst"


if "chain" in config:
    config["chain"] = read_numbers(config["chain"])
try:
    check_config(config, ROOT / "workflow/schemas/config.schema.yaml")
    if config["figure"]:
        from precursors.figures.style import Look  # slow

        Look(**config["figure"])
except ValueError as error:
    raise WorkflowError(str(error)) from None
if not os.access("results" if os.path.exists("results") else ".", os.W_OK | os.X_OK):
    raise WorkflowError("results must be a directory that can be written to")

SCENES = scenes_with(config, "run")
ASKED = scenes_with(config, "answers")
# Formats of the figures; the paper and the report show SVG.
FORMATS = ["svg", *[name for name in config["figure_formats"] if name != "svg"]]
SLIDERS = {scene: scene_slider(config, scene) for scene in config["fig13"]}
RUNS = {scene: f"results/runs/{scene}.h5" for scene in config["fig13"]}
PAPER_PRINTS = {scene: printed.SCENES.get(scene, {}) for scene in SCENES}
TABLES = {}  # of all rooms: see tables.smk
# What reads a file, by its ending.
READERS = {
    ".csv": "precursors.support.files:read_table",
    ".h5": "precursors.solver.run:Run.load",
    ".gz": "precursors.proof.certificate:Certificate.load",
}


wildcard_constraints:
    scene="|".join(SCENES),


include: "workflow/rules/simulate.smk"
include: "workflow/rules/analyse.smk"
include: "workflow/rules/derivation.smk"
include: "workflow/rules/accuracy.smk"
include: "workflow/rules/hierarchy.smk"
include: "workflow/rules/ensembles.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/paper.smk"
include: "workflow/rules/tables.smk"


rule all:
    default_target: True
    input:
        RESULTS,
        "results/provenance.json",
    localrule: True


others = {name for name, figure in FIGURES.items() if not figure["module"].endswith(".scene")}
for scene in {*(rule.name for rule in workflow.rules), *others} & set(config["scenes"]):
    raise WorkflowError(
        f"configuration: scenes.{scene} has the name of a target or figure: give it another one"
    )
