"""The page that the build wrote, and its picture for README."""

from __future__ import annotations

import hashlib
from pathlib import Path

from browser import browser, find_browser

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src/maegawa2010/explorer"
PAGE = ROOT / "results/explorer.html"
PICTURE = ROOT / "docs/explorer.png"
THETAS = {"fig10": 0.0, "fig11": -5 / 6, "fig12": 5 / 6}
TOLERANCE = 1e-9  # s, of the times of a run that is called predictable
LAPTOP = (1280, 800)  # px
SETTLED = (
    "run && !state.playing && request.isShown && !request.next && run.isFinal"
    " && run.id === request.id && !dirty.size"
)


def drawn_from() -> str:
    """Digest of what the picture shows: all of the page but what only answers a
    reader."""
    parts = sorted(file for file in SOURCE.iterdir() if file.suffix != ".py")
    return hashlib.sha256(b"".join(file.read_bytes() for file in parts)).hexdigest()


def picture() -> bytes:
    """The second step in the middle of a precursor, without the sliders, as a small
    PNG that says in its end what it was drawn from."""
    path = find_browser()
    if path is None:
        raise FileNotFoundError("no Chromium or Chrome here")
    with browser(path) as page:
        page.open(PAGE.as_uri(), *LAPTOP)
        page.evaluate("goToStep(2), stop()")
        page.wait_for(SETTLED)
        page.evaluate(
            "state.time = event().onset + 0.6 * (event().end - event().onset), redraw()"
        )
        page.wait_for(f"run.motions.has(state.event) && {SETTLED}")
        page.evaluate("redraw()")
        page.settle()
        bottom = page.evaluate("element('readout').getBoundingClientRect().bottom")
        png = page.picture(x=0, y=0, width=LAPTOP[0], height=bottom, scale=0.75)
    return png + drawn_from().encode()
