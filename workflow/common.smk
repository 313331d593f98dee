import os
import shlex
import sys
from functools import partial
from pathlib import Path

from snakemake.exceptions import WorkflowError

from maegawa2010 import printed
from maegawa2010.config import load_config, long_settings, read_file
from maegawa2010.paper.inputs import SCENES as PAPERS_SCENES
from maegawa2010.scenes import (
    is_paper_slider,
    scene_duration,
    scene_label,
    scene_slider,
    scenes_with_theta,
)
from maegawa2010.support.digest import digest_code
from precursors.model.chain import parse_theta

# The project's directory, relative to the working directory. If a workflow uses this one as a module, `workflow.basedir` is
# the directory of the other.
ROOT = Path(os.path.relpath(workflow.current_basedir.get_path_or_uri(secret_free=True))).parent
PAPERS = ROOT / "src/maegawa2010"
PROOFS = ROOT / "src/precursors/benchmark/certificates"  # committed
COMMITTED = ROOT / "paper/tables"  # tables of long studies of the paper's slider, made by the rule `article`
# A checksum of the script and all imported code is a parameter of each rule, so that its jobs run again if code changes.
digest = partial(digest_code, ROOT)

files = [] if workflow.modifier.skip_configfile else ["config.yaml", *workflow.overwrite_configfiles]
try:
    # Snakemake reads these files, too, but does not say where the error is.
    contents = {path: read_file(path) for path in filter(os.path.exists, files)}
except ValueError as error:
    raise WorkflowError(str(error)) from None


configfile: "config.yaml"


GIVEN = set(config)  # sections that the user gave; default settings are added below
try:
    config.update(load_config(config, contents, ROOT / "workflow"))
except ValueError as error:
    raise WorkflowError(str(error)) from None
if not os.access("results" if os.path.exists("results") else ".", os.W_OK | os.X_OK):
    raise WorkflowError("results must be a directory that can be written to")
os.environ.setdefault("NUMBA_NUM_THREADS", "1")  # a job has one thread
# Snakemake does not quote this path in its commands. Once quoted, it no longer exists, and is not quoted again.
if os.path.exists(sys.executable):
    sys.executable = shlex.quote(sys.executable)

SCENES = list(config["scenes"])
FIG13 = config["fig13"]
MORE_FORMATS = [name for name in config["figure_formats"] if name != "svg"]
SLIDERS = {scene: scene_slider(config, scene) for scene in FIG13}
IS_PAPER_SLIDER = is_paper_slider(config, PAPERS_SCENES)
# Only for the paper's slider are there tables of long studies. A full build makes them. Any other build checks the committed
# tables and copies them, unless the configuration changes the study `resolution`.
HAS_LONG = IS_PAPER_SLIDER and (config["full"] or "resolution" not in GIVEN)
IS_COMMITTED = HAS_LONG and not config["full"]
LONG_SETTINGS = long_settings(ROOT / "workflow")  # with which the committed tables were made
PUBLISHED = {}  # rule and seed of each table that a full build makes for paper/tables
RUNS = collect("results/runs/{scene}.h5", scene=FIG13)
SLIPS = collect("results/tables/{scene}_slips.csv", scene=FIG13)
# Inputs of `all`. Each file of rules adds its own, so `all` and write_provenance must come after the includes.
RESULTS = []
# Each study of many runs is divided into this many jobs.
CHUNKS = [f"{i}of{config['chunks']}" for i in range(1, config["chunks"] + 1)]


wildcard_constraints:
    scene="|".join(SCENES),
    chunk="[0-9]+of[0-9]+",
