# Uses the rules of this repository in another workflow: adds a scene, and takes its first slip. Results are written into the
# working directory.
from pathlib import Path

import yaml

# Rules read other files of the checkout.
CHECKOUT = Path(workflow.basedir).parents[1]

mine = yaml.safe_load((CHECKOUT / "config.yaml").read_text())
mine["scenes"]["soft"] = {"title": "a soft drive", "theta": 0, "drive_stiffness": 0.1e6, "duration": 5.0}


module precursors:
    snakefile:
        str(CHECKOUT / "Snakefile")
    config:
        mine


use rule * from precursors as precursors_*


rule first_slip:
    default_target: True
    input:
        "results/tables/soft_slips.csv",
    output:
        "first_slip.txt",
    shell:
        "sed -n 2p {input} > {output}"
