"""What a reader does on the explorer's page, and all that the page then says and
draws."""

from __future__ import annotations

import json
import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pandas as pd
from browser import Page, browser, find_browser

from maegawa2010.explorer.page import write_explorer
from maegawa2010.studies.printed_digits.tables import HALF_A_DIGIT
from precursors.analysis.slips import first_global_slip
from precursors.model.chain import SLIDER

GOLDEN = Path(__file__).parents[1] / "golden"
KEPT = GOLDEN / "small/explorer.csv"
THETAS = {"fig10": 0.0, "fig11": -5 / 6, "fig12": 5 / 6}
TOLERANCE = 1e-9  # s, of the times of a run that is called predictable
LAPTOP = (1280, 800)  # px
IN_THE_WAVE = 250e-6  # s, since the onset of the global slip
FAST = SLIDER | {"theta": 5 / 6, "drive_velocity": 0.01}
# Places [pixels] stand behind an @, rounded to a hundredth.
PLACE = re.compile(r"@(-?[\d.]+)")
SAME_PLACE = 0.02  # pixels
SETTLED = (
    "!playing && !waiting && current.isShown && run.isFinal && twin.isFinal"
    " && document.body.dataset.drawn == run.id && !dirty.size"
)
STILL = f"{SETTLED} && isMotionThere()"
TOOLS = Path(__file__).with_suffix(".js").read_text(encoding="utf-8")

SESSIONS = {
    "six steps": [
        *(f"press('[data-step=\"{step}\"]')" for step in (1, 2, 3, 5, 6, 4)),
        "press('.seen [data-theta=\"0.01\"]')",
    ],
    "a closer look": [
        "press('[data-view=event]')",
        "press('[data-view=all]')",
        "tap('load', 200)",
        "press('[data-view=first]'), tap('slips', 340), press('[data-view=first]'),"
        "tap('stairs', 88)",
        "tap('slips', 130)",
        "set('#scrubber', 300)",
        "press('[data-view=first]'), tap('lengths', marks[7][0] + 3, marks[7][1] - 2)",
        "key('ArrowRight'), key('ArrowRight', { ctrlKey: true }),"
        "key('ArrowRight', {}, '#theta')",
        "key('ArrowLeft'), key('ArrowLeft'), key('ArrowLeft', { altKey: true })",
        "[key(' '), playing, key(' ', {}, '#play'), playing, key(' '), playing]"
        ".map(Boolean).join()",
        "document.querySelector('[aria-describedby=tip-theta]').focus()",
        "key('Escape')",
        "set('#scrubber', 400)",
        "tap('lengths', 580, 120), choose(run.events.length - 1), press('#next')",
        "choose(0), press('#previous')",
        "marks = [[300, 100, 7]], tap('lengths', 323, 100), tap('lengths', 322, 100)",
        "choose(run.events.length - 1), set('#drive_velocity', -5)",
        "set('#drive_velocity', -6)",
        "set('#drive_velocity', -4), press('[data-step=\"1\"]')",
        "set('#mu_k', 0.7)",
    ],
    "sliders": [
        "set('#theta', -0.25)",
        "set('#n_blocks', 1)",
        "set('#n_blocks', 2)",
        "set('#n_blocks', 4)",
        "set('#mu_k', 0.8), set('#mu_s', 0.3), set('#mu_s', 0.9), set('#mu_k', 0.5)",
        "set('#drive_stiffness', 7.1)",
        "set('#drive_velocity', -4.2)",
        "press('#loads-part summary')",
        "set('[data-load=\"1\"]', 150)",
        "set('#theta', 0.5)",
        "press('[data-step=\"4\"]')",
    ],
    "films": [
        "watch(200)",
        "press('[data-view=event]'), watch(250)",
        "press('#next'), watch(3)",
        "watch(130, true)",
    ],
    "worker": [
        "work([1, 0.5, false], 999)",
        "work([1, 0.5, true], 2, [2, 0, false], [3, -0.5, true], 999)",
        "work([1, -0.9, false], 999, [2, -0.9, true], 60, [3, -0.9, true], 999)",
        "work([1, 0.2, true, true], 999)",
        "work({ event: 4, onset: 0.35, end: 0.3501 }, 99)",
    ],
}


def write_example(path: Path) -> None:
    """Write a page with the paper's three scenes."""
    scenes = []
    for name, theta in THETAS.items():
        friction = first_global_slip(pd.read_csv(GOLDEN / f"{name}_slips.csv"))
        assert friction is not None
        slider = SLIDER | {"theta": theta}
        scenes.append({"slider": slider, "mu_sapp": friction.mu_sapp})
    proved = [{"slider": scene["slider"], "duration": 10.0} for scene in scenes]
    proved.append({"slider": FAST, "duration": 0.2})
    data = {"scenes": scenes, "proved": proved, "half_a_digit": HALF_A_DIGIT}
    write_explorer(data | {"duration": 10.0, "tolerance": TOLERANCE}, path)


def states(table: pd.DataFrame) -> list[dict[str, str]]:
    """All that a page shows after each action, from what the actions change."""
    state, found = dict[str, str](), []
    for action, rows in table.groupby(["session", "action"], sort=False):
        state = (
            state
            | dict(zip(rows["what"], rows["shown"], strict=True))
            | {"action": ": ".join(action)}
        )
        found.append({what: text for what, text in state.items() if text})
    return found


def assert_same_page(found: pd.DataFrame, kept: pd.DataFrame) -> None:
    """Texts are equal, and points of figures lie where they lay."""
    for page, kept_page in zip(states(found), states(kept), strict=True):
        assert page.keys() == kept_page.keys(), page["action"]
        for what, text in page.items():
            assert PLACE.sub("@", text) == PLACE.sub("@", kept_page[what]), (
                page["action"],
                what,
            )
            places, kept_places = (
                np.array(PLACE.findall(t), float) for t in (text, kept_page[what])
            )
            assert (abs(places - kept_places) < SAME_PLACE).all(), (
                page["action"],
                what,
            )


def record(page: Page, address: str, session: str) -> pd.DataFrame:
    """What the page shows after each action of a session, where it shows something else
    than before."""
    rows, before = [], dict[str, str]()
    for action in SESSIONS[session]:
        if not rows:
            page.open(address)
            page.evaluate(f"void (0, eval)({json.dumps(TOOLS)})")
        page.wait_for(STILL)
        film = page.evaluate(action)
        page.wait_for(STILL)
        page.settle()
        page.wait_for(STILL)
        shown = page.evaluate("shownNow()") | {
            "film": film if isinstance(film, str) else ""
        }
        rows += [
            (session, action, what, text)
            for what, text in shown.items()
            if text != before.get(what, "")
        ]
        before = shown
    return pd.DataFrame(rows, columns=["session", "action", "what", "shown"])


def recorded() -> pd.DataFrame:
    """All sessions, in a browser of their own."""
    with _example() as (page, address):
        return pd.concat([record(page, address, session) for session in SESSIONS])


def picture() -> bytes:
    """The page's fifth step in the middle of a global slip, as a PNG."""
    with _example() as (page, address):
        page.open(address, *LAPTOP)
        page.evaluate("goToStep(5)")
        for share in range(1, 9):  # the page draws for longer than a test waits
            page.wait_for(f"found.digits.length >= {share / 8} * STUDIES.digits.count")
        page.evaluate(f"state.time = event().onset + {IN_THE_WAVE}, redraw('row')")
        page.wait_for(f"motions.has(state.event) && {SETTLED}")
        page.evaluate("redraw('row')")
        page.settle()
        return page.picture()


@contextmanager
def _example() -> Iterator[tuple[Page, str]]:
    path = find_browser()
    if path is None:
        raise FileNotFoundError("no Chromium or Chrome here")
    with tempfile.TemporaryDirectory() as directory, browser(path) as new_page:
        file = Path(directory, "explorer.html")
        write_example(file)
        yield new_page(), file.as_uri()
