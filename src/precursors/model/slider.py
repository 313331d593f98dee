"""A slider as the arguments of `Chain.from_slider` describe it, one or many, before a chain is made of it."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Any

from precursors.model.chain import Chain, neighbour_stiffness

# Values of the arguments, or an array of them each.
Slider = Mapping[str, Any]
SLIDER = {name: p.default for name, p in inspect.signature(Chain.from_slider).parameters.items()}


def spring_stiffness(slider: Slider) -> Any:
    """Stiffness k [N/m] between neighbours (Eq. 10)."""
    return neighbour_stiffness(
        slider["n_blocks"], slider["youngs_modulus"], slider["cross_section"], slider["length"]
    )


def loading_time(slider: Slider) -> Any:
    """Time [s] in which the drive travels mu_s F_Z (1/K + (N - 1)/(2 k)).

    That compresses the drive's spring by mu_s F_Z and the others by what a load carried evenly by all blocks
    leaves for each of them, half of it on average.
    """
    compliance = 1.0 / slider["drive_stiffness"] + (slider["n_blocks"] - 1) / (2.0 * spring_stiffness(slider))
    return slider["mu_s"] * slider["normal_load"] * compliance / slider["drive_velocity"]
