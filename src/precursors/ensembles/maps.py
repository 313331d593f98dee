"""Maps: events counted, mu_sapp and the share of global slips over any two parameters."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from precursors.ensembles.study import Study, stack
from precursors.model.chain import FloatArray, neighbour_stiffness

# Arguments of `Chain.from_slider`, each a number or an array.
Slider = Mapping[str, Any]
# Length of a run: how often the drive could load the chain to its strength mu_s F_Z.
LOADINGS = 2.0


@dataclass(frozen=True)
class Parameter:
    """A parameter that a map may vary.

    Attributes
    ----------
    low, high : float
        Range of its values.
    of : callable
        Its value for a slider.
    change : callable
        Arguments of `Chain.from_slider` that give a slider other values of it.
    scale : str
        How values are spaced: evenly, evenly in the logarithm, or whole numbers.
    """

    low: float
    high: float
    of: Callable[[Slider], Any]
    change: Callable[[Slider, FloatArray], Slider]
    scale: Literal["linear", "logarithmic", "whole"] = "linear"

    def values(self, n: int) -> FloatArray:
        """At most n values from the lowest to the highest."""
        if self.scale == "logarithmic":
            return np.geomspace(self.low, self.high, n)
        values = np.linspace(self.low, self.high, n)
        return np.unique(values.round()) if self.scale == "whole" else values


def spring_stiffness(slider: Slider) -> Any:
    """Stiffness k between neighbours [N/m] (Eq. 10)."""
    return neighbour_stiffness(
        slider["n_blocks"], slider["youngs_modulus"], slider["cross_section"], slider["length"]
    )


def loading_time(slider: Slider) -> Any:
    """Time [s] in which the drive travels mu_s F_Z (1/K + (N - 1)/(2 k)).

    That compresses the spring of the drive by mu_s F_Z. A load that all blocks carry evenly compresses the
    other springs by half of this on average.
    """
    compliance = 1.0 / slider["drive_stiffness"] + (slider["n_blocks"] - 1) / (2.0 * spring_stiffness(slider))
    return slider["mu_s"] * slider["normal_load"] * compliance / slider["drive_velocity"]


PARAMETERS = {
    "theta": Parameter(-0.95, 0.95, lambda s: s["theta"], lambda _, theta: {"theta": theta}),
    "friction_ratio": Parameter(
        0.1, 0.95, lambda s: s["mu_k"] / s["mu_s"], lambda s, ratio: {"mu_k": s["mu_s"] * ratio}
    ),
    "n_blocks": Parameter(
        2, 25, lambda s: s["n_blocks"], lambda _, n: {"n_blocks": n.astype(int)}, scale="whole"
    ),
    "stiffness_ratio": Parameter(
        1e-3,
        10.0,
        lambda s: s["drive_stiffness"] / spring_stiffness(s),
        lambda s, ratio: {"drive_stiffness": spring_stiffness(s) * ratio},
        scale="logarithmic",
    ),
    "drive_velocity": Parameter(
        1e-6, 0.1, lambda s: s["drive_velocity"], lambda _, v: {"drive_velocity": v}, scale="logarithmic"
    ),
}


def map_study(slider: Slider, x: str, y: str, points: int) -> Study:
    """A grid of about so many chains over two parameters, keys of PARAMETERS.

    Every run lasts `LOADINGS` times the `loading_time` of its chain, so that it goes on after the first
    global slip.
    """
    rows = PARAMETERS[y].values(math.isqrt(points))
    columns = PARAMETERS[x].values(points // len(rows))
    grid = {
        name: values.ravel()
        for name, values in zip((y, x), np.meshgrid(rows, columns, indexing="ij"), strict=True)
    }
    members = {"theta": 0.0, **slider}
    # The number of blocks decides the stiffness k that K/k refers to.
    for name in sorted(grid, key=lambda name: name != "n_blocks"):
        members |= PARAMETERS[name].change(members, grid[name])
    return Study(stack([grid | members | {"duration": LOADINGS * loading_time(members)}]), until=None)


def places_of(sliders: Iterable[Slider], x: str, y: str) -> list[tuple[float, float]]:
    """Where some sliders are on the map of x and y."""
    return [(float(PARAMETERS[x].of(slider)), float(PARAMETERS[y].of(slider))) for slider in sliders]
