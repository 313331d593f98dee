"""The configuration of the workflow, as Snakemake puts it together."""

from collections import ChainMap

from places import ROOT

from maegawa2010.config import read_file, read_settings
from maegawa2010.scenes import scene_slider

STUDIES = dict(ChainMap(*read_settings(ROOT / "workflow").values()))
FULL = read_file(ROOT / "workflow/full.yaml")
CONFIG = {**STUDIES, **read_file(ROOT / "config.yaml")}
SLIDERS = {scene: scene_slider(CONFIG, scene) for scene in CONFIG["fig13"]}
