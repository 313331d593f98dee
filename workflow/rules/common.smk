import os

from precursors.model.scenes import (
    scene_chain,
    scene_duration,
    scene_model,
    scene_quantities,
    scene_slider,
    scenes_with,
)
from precursors.support.imports import files_used

SCENES = scenes_with(config, "run")
ASKED = scenes_with(config, "answers")
# As seen from the working directory; `workflow.basedir` would be another workflow's that uses this one as a module.
ROOT = os.path.relpath(f"{workflow.current_basedir.get_path_or_uri(secret_free=True)}/../..")
LIBRARY = os.path.normpath(f"{ROOT}/src/precursors")
# Imports whose edit changes no result, so that nothing is run again for it.
ASIDE = {
    # Members come in by the fingerprint of their study, a parameter of run_chunk.
    "scripts/run_chunk": ["ensembles/catalogue", "support/progress"],
    "scripts/gather_members": ["ensembles/catalogue"],
    "scripts/tabulate_resolution_models": ["ensembles/catalogue"],
    "accuracy/proof/exact_chain": ["model/scenes"],  # the chain of a scene, a parameter of certify_scene
    "solver/run": ["analysis/horizon"],  # what a run tells its user when asked
}


def code_of(script):
    """The modules that a script uses: an edit of one of them runs its rules again."""
    return [
        f"{LIBRARY}/{file}" for file in files_used(f"{ROOT}/workflow/scripts/{script}.py", LIBRARY, ASIDE)
    ]


wildcard_constraints:
    scene="|".join(SCENES),
