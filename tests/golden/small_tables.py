"""Small tables of the full study of larger chains, which `make all` does not make."""

from __future__ import annotations

import pandas as pd
from settings import CONFIG

from maegawa2010.studies.larger.cycles import (
    run_settled,
    settled_study,
    settled_table,
)
from maegawa2010.studies.larger.first_slips import larger_tables

# Of a chain with a length.
STUDY = {"even_length": [0.3], "relaxation_time": [2e-4], "theta": ["-5/6"]}


def small_larger_tables() -> dict[str, pd.DataFrame]:
    """The tables of the larger chain for a few blocks."""
    first = CONFIG["larger"]["first_slips"] | {
        "nucleation": STUDY | {"n_blocks": [20]},
        "studies": {
            "counts": STUDY | {"n_blocks": [6], "runs": 3},
            "height": STUDY
            | {"even_length": [0], "relaxation_time": [0], "push_height": [0.005]}
            | {"n_blocks": [4], "runs": 3, "step": 0.01},
        },
    }
    pasts = {"pasts": [[0.1, 0], [0, 0.5]], "step": 0.5}
    settled = CONFIG["larger"]["settled"] | {
        "studies": {"map": STUDY | pasts | {"n_blocks": [14]}},
        "drawn": [],
    }
    members = run_settled(settled_study(CONFIG["chain"], settled))
    chunk = members.rename_axis("member").reset_index()
    return larger_tables(CONFIG["chain"], first) | {
        "larger_settled": settled_table([chunk], CONFIG["chain"])
    }
