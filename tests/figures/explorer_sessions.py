"""What a reader does on the explorer's page, and all that the page then says and
draws."""

from __future__ import annotations

import json
import re
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd
from browser import Page, browser, find_browser

from precursors.figures.explorer.page import (
    Proved,
    Scene,
    counted_events,
    write_explorer,
)
from precursors.model.scenes import SLIDER

GOLDEN = Path(__file__).parents[1] / "golden"
KEPT = GOLDEN / "small/explorer.csv"
THETAS = {"fig10": 0.0, "fig11": -5 / 6, "fig12": 5 / 6}
FAST = SLIDER | {"theta": 5 / 6, "drive_velocity": 0.01}
ADDRESSES = "addresses"
# Places [pixels] stand behind an @, rounded to a hundredth.
PLACE, TOLERANCE = re.compile(r"@(-?[\d.]+)"), 0.02
SETTLED = (
    "!playing && runs[0] && runs.every(run => run.isFinal && run.id === asked)"
    " && document.body.dataset.drawn == asked"
)
STILL = f"{SETTLED} && isMotionThere()"
TOOLS = Path(__file__).with_suffix(".js").read_text(encoding="utf-8")

SESSIONS = {
    "five steps": [f"press('[data-step=\"{step}\"]')" for step in (1, 2, 3, 4, 5, 0)],
    "a closer look": [
        "press('[data-view=event]')",
        "press('#closer'), press('#closer')",
        "press('#wider')",
        "press('[data-view=all]')",
        "tap('load', 200)",
        "press('[data-view=first]'), tap('slips', 340), press('[data-view=first]'), tap('slips', 88)",
        "tap('slips', 130)",
        "set('#scrubber', 300)",
        "press('[data-view=first]'), tap('lengths', marks[7][0] + 3, marks[7][1] - 2)",
        "wheel('load', 300, { ctrlKey: true, deltaY: 1 }), wheel('load', 300, { deltaY: 1 })",
        "wheel('slips', 450, { metaKey: true, deltaY: -1 })",
        "key('ArrowRight'), key('ArrowRight', { ctrlKey: true }), key('ArrowRight', {}, '#theta')",
        "key('ArrowLeft'), key('ArrowLeft'), key('ArrowLeft', { altKey: true })",
        "[key(' '), playing, key(' ', {}, '#play'), playing, key(' '), playing].map(Boolean).join()",
        "document.querySelector('[aria-describedby=tip-theta]').focus()",
        "key('Escape')",
        "set('#scrubber', 400)",
        "tap('lengths', 580, 120), choose(runs[0].events.length - 1), press('#next')",
        "choose(0), press('#previous')",
        "marks = [[300, 100, 7]], tap('lengths', 323, 100), tap('lengths', 322, 100)",
        "setView({ start: 0, end: 0.02 })",
        "setView({ start: 0, end: 2e-3 })",
        "setView({ start: runs[0].events[2].onset, end: runs[0].events[5].onset }), choose(2), choose(5)",
        "choose(runs[0].events.length - 1), set('#drive_velocity', -5)",
        "set('#drive_velocity', -6)",
        "set('#drive_velocity', -4), press('[data-step=\"1\"]')",
        "save()",
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
        "give('Zeit;Kraft\\n0,0;0,0\\n0,4;50\\n0,9;30,5')",
        "give('0;1\\n1;x<b>')",
        "press('#forget'), press('[data-step=\"0\"]'), press('#reset')",
    ],
    "films": [
        "watch(200)",
        "press('[data-view=event]'), watch(250)",
        "press('#next'), watch(3)",
        "watch(130, true)",
    ],
    "worker": [
        "work([1, [0.5], false], 999)",
        "work([1, [0.5, 0.5], true], 2, [2, [0], false], [3, [-0.5], true], 999, { id: 3, event: 1 }, 99)",
        "work([1, [-0.9], false], 999, [2, [-0.9], true], 60, [3, [-0.9], true], 999, [4, [-0.9], true])",
        "work([1, [0.2], true], 999, { id: 1, event: 4 }, { id: 2, event: 0 }, 1, { id: 1, event: 0 }, 99)",
    ],
    ADDRESSES: [
        "theta=0.4&n_blocks=5&mu_s=0.6&mu_k=0.2&step=0&view=1,1.5&event=3",
        "loads=30,60,90&step=5&view=event",
        "mu_s=0.5&mu_k=0.2&twin=1&view=all&event=1",
        "drive_velocity=0.0003&view=0.1,12&step=2&loads=0,10&theta=1.5",
        "n_blocks=1&mu_s=1.5&mu_k=0.4&view=0,10&event=1",
        "theta=<img src=x onerror=alert(1)>&step=<b>&view=<script>,2&event=<i>&loads=<u>,1",
        "theta=7&n_blocks=4000&mu_s=-1&drive_velocity=NaN&event=1e99&step=9&view=5,1",
        "%%%",
    ],
}


def write_example(path: Path) -> None:
    """Write a page with the paper's three scenes, whose titles have markup."""
    scenes = []
    for name, theta in THETAS.items():
        events = counted_events(pd.read_csv(GOLDEN / f"{name}_slips.csv"))
        scenes.append(
            Scene(f"{name} a <!--<script>\"'", SLIDER | {"theta": theta}, events)
        )
    proved = [Proved(scene.slider, 10.0) for scene in scenes] + [Proved(FAST, 0.2)]
    write_explorer(scenes, proved, 10.0, path)


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
            assert (abs(places - kept_places) < TOLERANCE).all(), (page["action"], what)


def record(page: Page, address: str, session: str) -> pd.DataFrame:
    """What the page shows after each action of a session, where it shows something else
    than before."""
    rows, before = [], dict[str, str]()
    for action in SESSIONS[session]:
        if session == ADDRESSES or not rows:
            page.open(f"{address}#{action}" if session == ADDRESSES else address)
            page.evaluate(f"void (0, eval)({json.dumps(TOOLS)})")
        page.wait_for(STILL)
        film = "" if session == ADDRESSES else page.evaluate(action)
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
    path = find_browser()
    if path is None:
        raise FileNotFoundError("no Chromium or Chrome here")
    with tempfile.TemporaryDirectory() as directory, browser(path) as new_page:
        file = Path(directory, "explorer.html")
        write_example(file)
        page = new_page()
        return pd.concat([record(page, file.as_uri(), session) for session in SESSIONS])
