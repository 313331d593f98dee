"""Distances of colours as readers see them, including readers with colour blindness."""

import math
from collections.abc import Mapping
from itertools import combinations

import numpy as np
from colorspacious import cspace_convert
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

# Least distance in CIELAB of colours that must be distinguished; a trained eye just sees 2.
DISTINCT = 20.0
SIGHTS = (None, "protanomaly", "deuteranomaly")


def in_cielab(
    colors: Mapping[str, str], sight: str | None = None
) -> dict[str, NDArray[np.float64]]:
    """Positions of named colours in CIELAB, as seen by an observer."""
    seen = np.array([to_rgb(color) for color in colors.values()])
    if sight:
        space = {"name": "sRGB1+CVD", "cvd_type": sight, "severity": 100}
        seen = np.clip(cspace_convert(seen, space, "sRGB1"), 0.0, 1.0)
    return dict(zip(colors, cspace_convert(seen, "sRGB1", "CIELab"), strict=True))


def alike(colors: Mapping[str, str], sight: str | None = None) -> list[tuple[str, str]]:
    """Pairs of names of colours that are too similar."""
    positions = in_cielab(colors, sight)
    return [
        pair
        for pair in combinations(positions, 2)
        if math.dist(*(positions[name] for name in pair)) < DISTINCT
    ]
