"""Write the explorer: a page that solves the chain in the browser and lets the reader
play with it.

The page holds no run. `solver.js` is the twin of `solver/plain.py` and runs in a worker
(`worker.js`); `drawing.js` draws, and `explorer.js` links them to what the reader does.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from importlib.resources import files
from os import PathLike
from string import Template
from typing import Any

import numpy as np
import pandas as pd

from precursors.model.chain import parse_theta
from precursors.model.scenes import SLIDER
from precursors.support.files import write_text


@dataclass(frozen=True)
class Scene:
    """A slider of the paper: its title, the arguments of `Chain.from_slider`, and its
    `counted_events`."""

    title: str
    slider: Mapping[str, Any]
    events: Sequence[Sequence[float]]


@dataclass(frozen=True)
class Proved:
    """A chain whose transitions are proved up to a time [s], as arguments of
    `Chain.from_slider`."""

    slider: Mapping[str, Any]
    duration: float


def counted_events(slips: pd.DataFrame) -> list[list[float]]:
    """Onset [s], tangential load [N] and front length over the slider's length of the
    events of Fig. 13."""
    counted = slips[slips["counted"]]
    share = counted["front"] / counted["n_blocks"]
    return np.column_stack(
        [counted["onset_s"], counted["load_before_N"], share]
    ).tolist()


def proved_slider(values: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments of `Chain.from_slider` of a chain of the configuration's
    `accuracy.proved`."""
    slider = {
        name: values.get(name, value)
        for name, value in SLIDER.items()
        if name != "weights"
    }
    return slider | {"theta": parse_theta(values.get("theta", 0))}


def write_explorer(
    scenes: Sequence[Scene],
    proved: Sequence[Proved],
    duration: float,
    path: str | PathLike[str],
) -> None:
    """Write the explorer as one HTML file that needs no other file and no network.

    The page simulates `duration` [s]. Its steps use the `scenes` with the smallest and
    largest theta, and the nearest to 0. It says of the `proved` chains that they are.
    """

    def part(*names: str) -> str:
        room = files("precursors.figures.explorer")
        return "\n".join(
            room.joinpath(name).read_text(encoding="utf-8") for name in names
        )

    data = {
        "duration": duration,
        "scenes": [asdict(scene) for scene in scenes],
        "proved": [asdict(one) for one in proved],
    }
    page = Template(part("page.html")).substitute(
        style=part("explorer.css"),
        data=json.dumps(data, allow_nan=False, separators=(",", ":")).replace(
            "<", "\\u003c"
        ),
        worker=part("solver.js", "worker.js"),
        script=part("drawing.js", "explorer.js"),
    )
    write_text(path, page)
