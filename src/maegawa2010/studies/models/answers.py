"""The models, from the smallest to the largest, and the quantities that each predicts."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from maegawa2010.studies.models import rigid, statics
from maegawa2010.studies.models.quasistatic import (
    ENERGY_CONSERVED,
    OVERDAMPED,
    quasistatic_slips,
)
from precursors.analysis.slips import slip_rows
from precursors.analysis.summary import summary_of
from precursors.model.chain import Chain
from precursors.model.statics import longest_run
from precursors.solver.simulate import simulate

Model = Callable[[Chain], dict[str, Any]]
PAPERS_MODEL = "chain"
# Quantities of a chain up to and including its first global slip, and their units.
UNITS = {
    "load_bound": "N",  # largest load of any state of rest (Eq. 14)
    "first_load": "N",  # load at the onset of the first event
    "events_counted": "1",  # number of events counted in Fig. 13
    "mu_sapp": "1",  # apparent static friction coefficient (Eq. 1)
    "front_loads": "N",  # load at which the front first reaches each block 1..N
    "slip_duration": "s",  # of the first global slip
}


def exact_answers(chain: Chain) -> dict[str, Any]:
    """Answers of the paper's chain, simulated to the end of its first global slip."""
    run = simulate(chain, longest_run(chain), until="global slip")
    slips = slip_rows(run)
    last = slips[-1]
    duration = last["end_s"] - last["onset_s"] if last["is_global"] else np.nan
    return loading_answers(chain, slips) | {"slip_duration": duration}


def cascade_answers(chain: Chain, overshoot: float) -> dict[str, Any]:
    """Answers of a quasi-static chain up to its first global slip."""
    return loading_answers(chain, quasistatic_slips(chain, overshoot))


def loading_answers(chain: Chain, slips: NDArray[np.void]) -> dict[str, Any]:
    """Answers from the slip events of a model up to its first global slip; without one,
    answers that need it are NaN."""
    summary = summary_of(slips)
    blocks = np.arange(1, chain.n_blocks + 1)
    reached = np.searchsorted(np.maximum.accumulate(slips["front"]), blocks)
    return {
        "first_load": slips["load_before_N"][0],
        "events_counted": summary.events_counted if summary.reached else np.nan,
        "mu_sapp": summary.mu_sapp,
        "front_loads": np.append(slips["load_before_N"], np.nan)[reached],
    }


# Models from the smallest to the largest; each gives answers for a chain by quantity.
MODELS: dict[str, Model] = {
    "statics": statics.answers,
    "front_law": statics.front_law_answers,
    "rigid": rigid.answers,
    "overdamped": partial(cascade_answers, overshoot=OVERDAMPED),
    "quasistatic": partial(cascade_answers, overshoot=ENERGY_CONSERVED),
    PAPERS_MODEL: exact_answers,
}
