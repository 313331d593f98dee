"""Distribute the normal load of a slider over its blocks by a measured profile."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from precursors.model.checks import block_array

# Conversion of units may move a position beyond the end of the slider by this share.
ROUNDING = 1e-12


def shares_of_profile(
    profile: ArrayLike, n_blocks: int, positions: ArrayLike | None, length: float
) -> NDArray[np.float64]:
    """Return the share of the normal load that each block bears, shape (N,).

    `profile` and `positions` [m] are those of `Chain.from_profile`, and `length` [m] is
    that of the slider.

    Raises
    ------
    ValueError
        If the profile is negative somewhere or zero everywhere, or if positions do not
        rise or are not on the slider.
    """
    cells = block_array("profile", profile, "any unit")
    if cells.ndim not in (1, 2) or not (
        np.isfinite(cells).all() and cells.min(initial=0) >= 0 < cells.sum()
    ):
        raise ValueError(
            "profile must be a column or matrix of numbers of at least 0, not all 0"
        )
    shape = cells if cells.ndim == 1 else cells.sum(axis=1)
    if positions is None:
        cell, part = np.divmod(np.arange(n_blocks + 1) * len(shape), n_blocks)
        up_to_edge = (
            np.append(0, shape.cumsum())[cell]
            + part / n_blocks * np.append(shape, 0)[cell]
        )
    else:
        edges = np.arange(n_blocks + 1) / n_blocks * length
        up_to_edge = _integral(positions, shape, edges)
    return np.diff(up_to_edge) / up_to_edge[-1]


def _integral(
    positions: ArrayLike, profile: NDArray[np.float64], edges: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Integrate a profile from 0 to each edge [m].

    The profile is linear between its points and constant beyond the first and the last.
    """
    x = block_array("positions", positions, "m")
    if x.shape != profile.shape or len(x) < 2 or not (np.diff(x) > 0).all():
        raise ValueError(
            "positions must rise, one for each value of the profile, at least two, but "
            f"are {' '.join(repr(x).split())}"
        )
    if not (x[0] >= 0 and x[-1] <= edges[-1] * (1 + ROUNDING)):
        raise ValueError(
            f"positions must be on the slider, from 0 to {edges[-1]:g} m, but are "
            f"{x[0]:g} to {x[-1]:g} m"
        )
    places = np.union1d(x, edges)
    values = np.interp(places, x, profile)
    pieces = np.diff(places) * (values[1:] + values[:-1]) / 2
    integral = np.append(0.0, np.cumsum(pieces))
    return integral[np.searchsorted(places, edges)]
