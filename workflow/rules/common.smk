import os

from precursors.config import (
    scene_chain,
    scene_duration,
    scene_model,
    scene_quantities,
    scene_slider,
    scenes_with,
)

SCENES = scenes_with(config, "run")
ASKED = scenes_with(config, "answers")
# As seen from the working directory; `workflow.basedir` would be another workflow's that uses this one as a module.
ROOT = os.path.relpath(f"{workflow.current_basedir.get_path_or_uri(secret_free=True)}/../..")
# Rules name the modules that they use, so that an edit re-runs them.
LIBRARY = os.path.normpath(f"{ROOT}/src/precursors")


wildcard_constraints:
    scene="|".join(SCENES),
