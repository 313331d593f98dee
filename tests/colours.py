"""Where colours lie for a reader: two are told apart if they are far enough apart."""

import math
from collections.abc import Mapping
from itertools import combinations

import numpy as np
from colorspacious import cspace_convert
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

# In CIELAB; a step of 2 can just be seen by eyes that are trained.
TOLD_APART = 20.0
SIGHTS = (None, "protanomaly", "deuteranomaly")


def in_cielab(
    colors: Mapping[str, str], sight: str | None = None
) -> dict[str, NDArray[np.float64]]:
    """Places of named colours."""
    seen = np.array([to_rgb(color) for color in colors.values()])
    if sight:
        space = {"name": "sRGB1+CVD", "cvd_type": sight, "severity": 100}
        seen = np.clip(cspace_convert(seen, space, "sRGB1"), 0.0, 1.0)
    return dict(zip(colors, cspace_convert(seen, "sRGB1", "CIELab"), strict=True))


def alike(colors: Mapping[str, str], sight: str | None = None) -> list[tuple[str, str]]:
    """Names of colours that are not told apart."""
    places = in_cielab(colors, sight)
    return [
        pair
        for pair in combinations(places, 2)
        if math.dist(*(places[name] for name in pair)) < TOLD_APART
    ]
