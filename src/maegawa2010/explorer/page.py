"""Write the explorer: a page that solves the chain in the browser and lets the reader
play with it.

The page holds no run. `solver.js` does what `solver/plain.py` does, in a worker
(`worker.js`). `story.js` has the words, `figures.js` the figures of a run, and
`studies.js` those of many sliders, with the means of `drawing.js`. `explorer.js` links
them to what the reader does, and `address.js` writes it as an address.
"""

import json
from collections.abc import Mapping
from importlib.resources import files
from os import PathLike
from string import Template
from typing import Any

from precursors.support.files import write_text

SCRIPTS = (
    "drawing.js",
    "story.js",
    "studies.js",
    "figures.js",
    "address.js",
    "explorer.js",
)


def write_explorer(data: Mapping[str, Any], path: str | PathLike[str]) -> None:
    """Write the explorer as one HTML file that needs no other file and no network.

    Parameters
    ----------
    data
        `scenes` of the paper: the `slider` of each, as arguments of
        `Chain.from_slider`; its `mu_sapp`, or None; mu_sapp of sliders with the same
        printed inputs, `draws`, of which k of n are `within` what the paper prints; and
        `finest`: the largest number of blocks tried, and its median mu_sapp. The steps
        use the scenes with the smallest and largest theta, and the nearest to 0.
        `tilted`: another `theta` and its `mu_sapp`. `all_six`: [k, n] of the sliders
        with the same printed inputs have all numbers of the paper, or None. `proved`: a
        `slider` and the `duration` [s] up to which its transitions are proved.
        `duration` [s] of a run; `tolerance` [s] of the times of a run that is called
        predictable; `printed`: range of mu_sapp; `half_a_digit`: by how much sliders
        with the same printed inputs differ; `noise` of the loads [%].
    path
        The file that is written.
    """

    def part(*names: str) -> str:
        room = files("maegawa2010.explorer")
        return "\n".join(
            room.joinpath(name).read_text(encoding="utf-8") for name in names
        )

    page = Template(part("page.html")).substitute(
        style=part("explorer.css"),
        data=json.dumps(data, allow_nan=False, separators=(",", ":")),
        worker=part("solver.js", "worker.js"),
        script=part(*SCRIPTS),
    )
    write_text(path, page)
