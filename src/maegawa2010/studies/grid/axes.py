"""The two axes of a grid: `key`, a value of the chain, `from` and `to`, `points`, and
`scale` ("linear" or "log")."""

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np

from precursors.model.chain import Chain, FloatArray

RATIO = "mu_k/mu_s"
Axis = Mapping[str, Any]


def check_axes(slider: Mapping[str, Any], axes: Sequence[Axis]) -> None:
    """Refuse axes that are of one key, or lead to no chain.

    The ValueError is one line.
    """
    keys = [axis["key"] for axis in axes]
    if keys[0] == keys[1]:
        raise ValueError(f"grid must have axes of two keys, but has {keys[0]} twice")
    for corner in product(*([axis["from"], axis["to"]] for axis in axes)):
        values = dict(zip(keys, corner, strict=True))
        try:
            Chain.from_slider(**chain_values({**slider, **values}))
        except (ValueError, OverflowError) as error:
            where = ", ".join(f"{key} = {value:g}" for key, value in values.items())
            raise ValueError(f"grid, {where}: {error}") from None


def chain_values(values: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments of `Chain.from_slider` from values of which one may be mu_k/mu_s."""
    slider = {key: value for key, value in values.items() if key != RATIO}
    if RATIO in values:
        slider["mu_k"] = values["mu_s"] * values[RATIO]
    return slider


def values_on(axes: Sequence[Axis], slider: Mapping[str, Any]) -> tuple[float, ...]:
    """Values of a slider on the axes."""
    values = {**slider, RATIO: slider["mu_k"] / slider["mu_s"]}
    return tuple(values[axis["key"]] for axis in axes)


def points_of(axis: Axis) -> FloatArray:
    """Values of an axis; whole ones of blocks."""
    spaced = np.geomspace if axis.get("scale") == "log" else np.linspace
    points = spaced(axis["from"], axis["to"], axis["points"])
    return (
        np.unique(np.rint(points).astype(int)) if axis["key"] == "n_blocks" else points
    )
