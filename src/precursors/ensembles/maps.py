"""Maps: events kept, mu_sapp and the share of global slips over theta and one parameter more."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from precursors.ensembles.study import Study
from precursors.model.chain import FloatArray
from precursors.model.scenes import Config
from precursors.model.slider import Slider, loading_time, spring_stiffness

# What the values of the second axis make of the arguments of `Chain.from_slider`, map by map.
AXES: dict[str, tuple[str, Callable[[Slider, FloatArray], Slider]]] = {
    "map_blocks": ("n_blocks", lambda slider, n: {"n_blocks": n.astype(int)}),
    "map_friction": ("friction_ratio", lambda slider, ratio: {"mu_k": slider["mu_s"] * ratio}),
    "map_stiffness": (
        "stiffness_ratio",
        lambda slider, ratio: {"drive_stiffness": spring_stiffness(slider) * ratio},
    ),
    "map_velocity": ("drive_velocity", lambda slider, velocity: {"drive_velocity": velocity}),
}
LOGARITHMIC = ("stiffness_ratio", "drive_velocity")


def map_study(config: Config, name: str) -> Study:
    """A grid of about as many chains as `points` says, over theta and the second axis of the map.

    Every run is as long as the drive takes for `loadings` times the travel that brings all springs, one
    after the other, to the load mu_s F_Z: runs go on after the first global slip.
    """
    settings = config["ensembles"]["maps"]
    axis, change = AXES[name]
    side = math.isqrt(settings["points"])
    second = _spaced(axis, settings[axis], side)
    theta = _spaced("theta", settings["theta"], settings["points"] // len(second))
    columns = dict(zip((axis, "theta"), np.meshgrid(second, theta, indexing="ij"), strict=True))
    slider = {**config["chain"], **{name: values.ravel() for name, values in columns.items()}}
    slider |= change(slider, slider[axis])
    duration = settings["loadings"] * loading_time(slider)
    return Study.of_blocks(name, [slider | {"duration": duration}], until=None)


def _spaced(axis: str, limits: Sequence[float], n: int) -> FloatArray:
    """Return n values from the lower to the upper limit, evenly spaced; whole numbers once each."""
    low, high = limits
    if axis in LOGARITHMIC:
        return np.geomspace(low, high, n)
    values = np.linspace(low, high, n)
    return np.unique(values.round()) if axis == "n_blocks" else values
