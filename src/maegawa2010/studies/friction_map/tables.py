"""The map: events counted and mu_sapp over theta and mu_k/mu_s."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from maegawa2010.studies.members import Study, stack
from precursors.model.chain import Chain

THETA = (-0.95, 0.95)
FRICTION_RATIO = (0.1, 0.95)
# Length of a run: how often the drive could load the chain to its limit mu_s F_Z.
LOADINGS = 2.0


def loading_time(slider: Mapping[str, Any]) -> float:
    """Time [s] in which the drive travels mu_s F_Z (1/K + (N - 1)/(2 k)).

    That compresses the spring of the drive by mu_s F_Z. A load that all blocks carry
    evenly compresses the other springs by half of this on average.
    """
    chain = Chain.from_slider(**slider)
    compliance = 1.0 / chain.drive_stiffness + (chain.n_blocks - 1) / (
        2.0 * chain.stiffness
    )
    return chain.mu_s * chain.normal_load * compliance / chain.drive_velocity


def map_study(slider: Mapping[str, Any], points: int) -> Study:
    """A grid of at most so many chains."""
    side = math.isqrt(points)
    ratio, theta = (
        grid.ravel()
        for grid in np.meshgrid(
            np.linspace(*FRICTION_RATIO, side),
            np.linspace(*THETA, points // side),
            indexing="ij",
        )
    )
    members = {
        **slider,
        "theta": theta,
        "friction_ratio": ratio,
        "mu_k": slider["mu_s"] * ratio,
        "duration": LOADINGS * loading_time(slider),
    }
    return Study(stack([members]))
