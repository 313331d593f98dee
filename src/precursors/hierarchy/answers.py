"""What a model answers, as a table."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pandas as pd

from precursors.hierarchy import MODELS, QUANTITIES
from precursors.model.chain import Chain
from precursors.model.scene_models import FRONT_LOADS, WAVEFORM

COLUMNS = ["model", "quantity", "block", "time_s", "value", "unit"]


def answers_table(chain: Chain, model: str, quantities: Iterable[str]) -> pd.DataFrame:
    """Ask a model for some quantities of a chain, up to its first global slip.

    Returns
    -------
    DataFrame
        One row per number: model, quantity, value and its unit; block (1..N) for the load at which the front
        first reaches each block; time_s [s] for the tangential load over time.

    Raises
    ------
    ValueError
        If the model does not answer a quantity, or the chain is none that it applies to.
    """
    found = MODELS[model].answer(chain, quantities)
    rows = [
        {"model": model, "quantity": quantity, **place, "value": value, "unit": QUANTITIES[quantity].unit}
        for quantity, answer in found.items()
        for place, value in _numbers(quantity, answer)
    ]
    return pd.DataFrame(rows, columns=COLUMNS).astype({"block": "Int64"})


def _numbers(quantity: str, answer: Any) -> list[tuple[dict[str, float], float]]:
    """The numbers of an answer, and what each of them is the value at."""
    if quantity == FRONT_LOADS:
        return [({"block": block}, load) for block, load in enumerate(answer, 1)]
    if quantity == WAVEFORM:
        return [({"time_s": time}, load) for time, load in answer]
    return [({}, answer)]
