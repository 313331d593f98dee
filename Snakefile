import os
import shlex
import sys
from copy import deepcopy
from dataclasses import asdict
from functools import partial
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.utils import min_version, update_config

from maegawa2010.support.installed import check_installed

# As seen from the working directory; `workflow.basedir` would be another workflow's that uses this one as a module.
ROOT = Path(os.path.relpath(workflow.current_basedir.get_path_or_uri(secret_free=True)))
try:
    check_installed(ROOT / "src")
except ValueError as error:
    raise WorkflowError(str(error)) from None

from maegawa2010 import printed
from maegawa2010.config import check_config, check_sections, place_weights, read_file, read_numbers
from maegawa2010.entries import Ensemble, Entries, Figure, Table
from maegawa2010.paper.inputs import SCENES as PAPERS_SCENES
from maegawa2010.scenes import (
    scene_additions,
    scene_duration,
    scene_slider,
    scenes_with,
    scenes_with_theta,
)
from maegawa2010.support.digest import digest_code
from precursors.model.chain import SLIDER, parse_theta

min_version("9.20")

PAPERS = ROOT / "src/maegawa2010"
PROOFS = ROOT / "workflow/certificates"  # committed
COMMITTED = ROOT / "paper/tables"  # of long studies of the paper's slider
# What a script computes: its rule has it as a parameter, and its jobs run again when it changes.
digest = partial(digest_code, ROOT)

# Files of the configuration, from the least to the most important one.
settings = [str(ROOT / "workflow/studies.yaml")]
if not workflow.modifier.skip_configfile:
    settings += [path for path in ["config.yaml", *workflow.overwrite_configfiles] if os.path.exists(path)]
try:
    settings = {path: read_file(path) for path in settings}
except ValueError as error:
    raise WorkflowError(str(error)) from None


configfile: "config.yaml"


report: "workflow/report/workflow.rst"


for path, content in reversed(settings.items()):
    place_weights(config, path, content)
if "chain" in config:
    config["chain"] = read_numbers(config["chain"])
try:
    studies = deepcopy(next(iter(settings.values())))  # those of studies.yaml
    check_sections(config, studies)
    update_config(studies, config)
    config.update(studies)
    check_config(config, ROOT / "workflow/schemas/config.schema.yaml", settings)
    if config["figure"]:
        from precursors.figures.style import Look  # slow

        Look(**config["figure"])
except ValueError as error:
    raise WorkflowError(str(error)) from None
if not os.access("results" if os.path.exists("results") else ".", os.W_OK | os.X_OK):
    raise WorkflowError("results must be a directory that can be written to")
if not workflow.modifier.skip_configfile:
    # Snakemake's records of the jobs lie beside the results, so that both are copied together: what fits the code of
    # another clone is not made again there.
    os.makedirs("results/records", exist_ok=True)
    os.makedirs(".snakemake", exist_ok=True)
    if not os.path.lexists(".snakemake/metadata"):
        os.symlink("../results/records", ".snakemake/metadata")
if os.path.exists(sys.executable):  # and not yet in quotes
    sys.executable = shlex.quote(sys.executable)  # Snakemake's commands have it as it is

SCENES = scenes_with(config, "run")
ASKED = scenes_with(config, "answers")
FIG13 = config["fig13"]
# Formats of the figures; the paper and the report show SVG.
FORMATS = ["svg", *[name for name in config["figure_formats"] if name != "svg"]]
SLIDERS = {scene: scene_slider(config, scene) for scene in FIG13}
PAPERS_SLIDERS = {
    scene: SLIDER | {"theta": theta} for scene, theta in zip(PAPERS_SCENES, (-5 / 6, 0.0, 5 / 6), strict=True)
}
IS_PAPERS = PAPERS_SLIDERS == {scene: {"weights": None} | SLIDERS.get(scene, {}) for scene in PAPERS_SCENES}
RUNS = {scene: f"results/runs/{scene}.h5" for scene in FIG13}
CERTIFICATES = {
    chain: f"results/certificates/chains/{chain}.json.gz" for chain in config["horizon"]["proved"]
}
PAPER_PRINTS = {scene: printed.SCENES.get(scene, {}) for scene in SCENES}
# What reads a file, by its ending.
READERS = {
    ".csv": "precursors.support.files:read_table",
    ".h5": "precursors.solver.run:Run.load",
    ".gz": "precursors.proof.certificate:Certificate.load",
}


wildcard_constraints:
    scene="|".join(SCENES),


# Every file of rules adds its entries, and to RESULTS what `all` makes beside them. Their order does not matter.
TABLES, FIGURES, ENSEMBLES = Entries(), Entries(), Entries()
RESULTS = []
CHUNKS = [f"{i}of{config['chunks']}" for i in range(1, config["chunks"] + 1)]
chunks_of = partial(collect, "results/ensembles/{study}/{chunk}.csv", chunk=CHUNKS)
parts = {}  # entries and results of each file

for file in sorted((ROOT / "workflow/rules").glob("*.smk")):
    known = {*TABLES, *FIGURES, *ENSEMBLES}
    so_far = len(RESULTS)

    include: f"workflow/rules/{file.name}"

    parts[file.stem] = ({*TABLES, *FIGURES, *ENSEMBLES} - known, RESULTS[so_far:])


include: "workflow/entries.smk"


rule all:
    default_target: True
    input:
        RESULTS,
        "results/provenance.json",
    localrule: True
