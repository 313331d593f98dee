"""The window of theta: a scene at evenly spaced values of theta that are near its
own."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from maegawa2010.studies.members import Study, stack


def theta_window_study(
    sliders: Mapping[str, Mapping[str, Any]],
    duration: float,
    settings: Mapping[str, Any],
) -> Study:
    """Each scene as it is (point 0), and at `points` values of theta up to `window`
    from its own."""
    sweep = np.linspace(-settings["window"], settings["window"], settings["points"])
    change = np.append(0.0, sweep)
    blocks = []
    for scene, slider in sliders.items():
        theta = np.clip(slider["theta"] + change, -1.0, 1.0)
        blocks.append(
            {
                **slider,
                "theta": theta,
                "scene": scene,
                "point": np.arange(len(theta)),
                "duration": duration,
            }
        )
    return Study(stack(blocks))
