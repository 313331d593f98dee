"""Write the explorer: a web page that simulates the chain in the browser, with sliders
for its parameters.

The page contains no runs. `solver.js` is the algorithm of `solver/plain.py`, and runs in
a worker (`worker.js`). `story.js` has the texts, `figures.js` the figures of a run, and
`studies.js` the figures of many sliders; both draw with `drawing.js`. `page.js` has the
state of the page and reacts to the reader, and `address.js` keeps the state in the
address.
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
    "page.js",
)


def write_explorer(data: Mapping[str, Any], path: str | PathLike[str]) -> None:
    """Write the explorer as one HTML file that needs no other files and no network.

    Parameters
    ----------
    data
        `scenes` of the paper. Each has its `slider`, the arguments of
        `Chain.from_slider`; its `mu_sapp`, or None; `draws`, mu_sapp of sliders with
        the same printed inputs, of which k of n (`within`) agree with the printed
        value; and `finest`, the largest number of blocks in the study and its median
        mu_sapp. The steps use the scenes with the smallest theta, the largest theta, and
        the theta nearest to 0. `tilted`: another `theta` and its `mu_sapp`. `all_six`:
        k of n sliders ([k, n]) with the same printed inputs have all six numbers of the
        paper, or None. `proved`: sliders (`slider`) with the `duration` [s] for which
        they are proved. `duration`: duration of a run [s]. `tolerance`: error of a
        transition's time up to which a run counts as predictable [s]. `printed`: range
        of the printed mu_sapp. `half_a_digit`: largest differences of inputs that are
        printed the same. `noise`: noise in the loads [%].
    path
        The HTML file.
    """

    def part(*names: str) -> str:
        folder = files("maegawa2010.explorer")
        return "\n".join(
            folder.joinpath(name).read_text(encoding="utf-8") for name in names
        )

    page = Template(part("page.html")).substitute(
        style=part("page.css"),
        data=json.dumps(data, allow_nan=False, separators=(",", ":")),
        worker=part("solver.js", "worker.js"),
        script=part(*SCRIPTS),
    )
    write_text(path, page)
