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

# Relative to the working directory. `workflow.basedir` is another directory if a workflow uses this one as a module.
ROOT = Path(os.path.relpath(workflow.current_basedir.get_path_or_uri(secret_free=True))).parent
PAPERS = ROOT / "src/maegawa2010"
PROOFS = ROOT / "src/precursors/benchmark/certificates"  # committed
COMMITTED = ROOT / "paper/tables"  # results of long studies of the paper's slider: `article` makes them
# Each rule takes a checksum of its script and all imported code as a parameter, so that its jobs run again if code changes.
digest = partial(digest_code, ROOT)

files = [] if workflow.modifier.skip_configfile else ["config.yaml", *workflow.overwrite_configfiles]
try:
    # Snakemake reads these files, too, but does not report where one is wrong.
    contents = {path: read_file(path) for path in filter(os.path.exists, files)}
except ValueError as error:
    raise WorkflowError(str(error)) from None


configfile: "config.yaml"


GIVEN = set(config)  # sections, before those of the settings
try:
    config.update(load_config(config, contents, ROOT / "workflow"))
except ValueError as error:
    raise WorkflowError(str(error)) from None
if not os.access("results" if os.path.exists("results") else ".", os.W_OK | os.X_OK):
    raise WorkflowError("results must be a directory that can be written to")
os.environ.setdefault("NUMBA_NUM_THREADS", "1")  # a job has one thread
if os.path.exists(sys.executable):  # false once it is quoted
    sys.executable = shlex.quote(sys.executable)  # Snakemake does not quote it in commands

SCENES = list(config["scenes"])
FIG13 = config["fig13"]
MORE_FORMATS = [name for name in config["figure_formats"] if name != "svg"]
SLIDERS = {scene: scene_slider(config, scene) for scene in FIG13}
IS_PAPER_SLIDER = is_paper_slider(config, PAPERS_SCENES)
# Tables of long studies are there for the paper's slider: a full build makes them, another one hands the committed
# ones on and checks them, unless it has a study of resolution of its own.
HAS_LONG = IS_PAPER_SLIDER and (config["full"] or "resolution" not in GIVEN)
IS_COMMITTED = HAS_LONG and not config["full"]
LONG_SETTINGS = long_settings(ROOT / "workflow")  # with which they were made
PUBLISHED = {}  # rule and seed of each of these tables, in a full build
RUNS = collect("results/runs/{scene}.h5", scene=FIG13)
SLIPS = collect("results/tables/{scene}_slips.csv", scene=FIG13)
# Targets of `all`. Each file of rules adds its own, so `all` and write_provenance must come after the includes.
RESULTS = []
# Each study of many runs is divided into this many jobs.
CHUNKS = [f"{i}of{config['chunks']}" for i in range(1, config["chunks"] + 1)]


wildcard_constraints:
    scene="|".join(SCENES),
    chunk="[0-9]+of[0-9]+",
