import os

from precursors.config import scene_chain, scene_duration, scene_names, scene_slider

SCENES = scene_names(config)
# The library as seen from the working directory: rules name the modules that they use, so that an edit re-runs them.
LIBRARY = os.path.relpath(f"{workflow.basedir}/src/precursors")


wildcard_constraints:
    scene="|".join(SCENES),
