"""The explorer's page with the paper's scenes, and its picture for README."""

from __future__ import annotations

import tempfile
from pathlib import Path

import pandas as pd
from browser import browser, find_browser

from maegawa2010.explorer.page import write_explorer
from maegawa2010.studies.printed_digits.tables import HALF_A_DIGIT
from precursors.analysis.summary import summary_of
from precursors.model.chain import SLIDER

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src/maegawa2010/explorer"
GOLDEN = ROOT / "tests/golden"
THETAS = {"fig10": 0.0, "fig11": -5 / 6, "fig12": 5 / 6}
TOLERANCE = 1e-9  # s, of the times of a run that is called predictable
LAPTOP = (1280, 800)  # px
SETTLED = (
    "!playing && !waiting && current.isShown && run.isFinal && twin.isFinal"
    " && document.body.dataset.drawn == run.id && !dirty.size"
)


def write_example(path: Path) -> None:
    """Write a page with the paper's three scenes."""
    scenes = []
    for name, theta in THETAS.items():
        found = summary_of(pd.read_csv(GOLDEN / f"{name}_slips.csv"))
        slider = SLIDER | {"theta": theta}
        scenes.append({"slider": slider, "mu_sapp": found.mu_sapp})
    proved = [{"slider": scene["slider"], "duration": 10.0} for scene in scenes]
    data = {"scenes": scenes, "proved": proved, "half_a_digit": HALF_A_DIGIT}
    write_explorer(data | {"duration": 10.0, "tolerance": TOLERANCE}, path)


def picture() -> bytes:
    """The fourth step in the middle of a precursor, without the sliders, as a small
    PNG."""
    path = find_browser()
    if path is None:
        raise FileNotFoundError("no Chromium or Chrome here")
    with tempfile.TemporaryDirectory() as directory, browser(path) as page:
        file = Path(directory, "explorer.html")
        write_example(file)
        page.open(file.as_uri(), *LAPTOP)
        page.evaluate("goToStep(4)")
        page.wait_for(f"found.tilts.length === THETAS.length && {SETTLED}")
        page.evaluate("choose(run.events.indexOf(run.counted.at(-3)))")
        page.evaluate(
            "state.time += 0.6 * (event().end - event().onset), redraw('row')"
        )
        page.wait_for(f"motions.has(state.event) && {SETTLED}")
        page.evaluate("redraw('row')")
        page.settle()
        bottom = page.evaluate("element('sliders').getBoundingClientRect().top")
        return page.picture(x=0, y=0, width=LAPTOP[0], height=bottom, scale=0.75)
