"""The wave: an animated SVG of the blocks through the first global slip."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Protocol
from xml.sax.saxutils import quoteattr

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from precursors.figures import style

XMLNS = "http://www.w3.org/2000/svg"
# Lengths are in pixels of the page that shows it.
WIDTH = 1000
HEIGHT = 390
LEFT = 80  # of the time axis, and of the first block at rest
RIGHT = 980
PLANE = 130
BLOCK = 42
FARTHEST = 44.0  # what the largest displacement is drawn as
LANES = 170  # top of the lanes, one a block
LANE = 16
SECONDS = 8  # of a loop: so many pictures move, and the rest of them rest
MOVING = 80
RESTING = 12
KINDS = {
    0: (style.PALE, "sticks"),
    1: (style.GLOBAL, "slides forward"),
    -1: (style.BACKWARD, "slides back"),
}
STYLE = f"text{{font:15px 'DejaVu Sans',sans-serif}}rect{{stroke:{style.BLACK}}}"
Slides = list[tuple[float, float, int]]


class Motion(Protocol):
    """What is drawn of a run."""

    @property
    def transitions(self) -> NDArray[Any]:
        """Rows in time order: time [s], block, mode."""

    def at(self, times: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Positions [m] and velocities [m/s], each (len(times), N)."""


def draw(run: Motion, slips: pd.DataFrame) -> str:
    """Write the first global slip, or else the longest event, as a looping SVG.

    A row of blocks moves and changes colour; lanes below it show who slides when.
    """
    over = slips.dropna(subset="end_s")
    if over.empty:
        return _tag("svg", _text(0, 24, "no slip event"), xmlns=XMLNS) + "\n"
    longest = over.sort_values(["is_global", "front"], ascending=False, kind="stable")
    onset, end = longest[["onset_s", "end_s"]].iloc[0]
    positions, _ = run.at(np.linspace(onset, end, MOVING))
    moved = positions - positions[0]
    enlarged = FARTHEST / np.abs(moved).max()  # pixels per m
    moved *= enlarged
    n = moved.shape[1]
    home = LEFT + (RIGHT - LEFT - FARTHEST - BLOCK) * np.arange(n) / max(n - 1, 1)
    slides = _slides(run.transitions, onset, end, n)
    slower = SECONDS * MOVING / (MOVING + RESTING) / (end - onset)
    pixels_per_m = (home[-1] - home[0]) / (slips["length_m"].iloc[0] * (1 - 1 / n))
    title = (
        f"A global slip runs through the row, {_rounded(slower)} times slower, "
        f"with {_rounded(enlarged / pixels_per_m)} times the movement"
    )
    parts = [
        f"<title>{title}</title><style>{STYLE}</style>",
        _tag("path", d=f"M0 0H{WIDTH}V{HEIGHT}H0z", fill="white"),
        _text(LEFT, 24, title, style="font-weight:bold"),
        _tag("path", d=f"M{LEFT} {PLANE}H{RIGHT}", stroke=style.BLACK),
        *_springs(home, moved),
    ]
    for i in range(n):
        parts.append(_block(i, home[i], moved[:, i], slides[i]))
        parts.append(_lane(i, slides[i]))
    seen = {0, *(mode for of_block in slides for *_, mode in of_block)}
    parts += _axis(n, end - onset, sorted(seen, key=list(KINDS).index))
    view = f"0 0 {WIDTH} {HEIGHT}"
    return _tag("svg", "\n".join(parts), xmlns=XMLNS, viewBox=view) + "\n"


def _slides(
    transitions: NDArray[Any], onset: float, end: float, n: int
) -> list[Slides]:
    """For each block: when it starts and stops, as shares of the event, and which way
    it slides."""
    inside = (transitions["time"] >= onset) & (transitions["time"] <= end)
    found: list[Slides] = []
    for block in range(1, n + 1):
        own = transitions[inside & (transitions["block"] == block)]
        shares = np.append((own["time"] - onset) / (end - onset), 1.0)
        rows = zip(shares, shares[1:], own["mode"], strict=False)
        found.append([(start, stop, int(mode)) for start, stop, mode in rows if mode])
    return found


def _springs(home: NDArray[np.float64], moved: NDArray[np.float64]) -> Iterable[str]:
    """The drive's spring, whose other end rests, and those between the blocks."""
    y = PLANE - BLOCK / 2
    look = {"stroke": style.GREY, "stroke_width": 6, "stroke_dasharray": "1 3"}
    for i, x in enumerate(home):
        begin = LEFT - BLOCK if i == 0 else home[i - 1] + BLOCK
        ends = {"x2": x + moved[:, i]}
        if i:
            ends["x1"] = begin + moved[:, i - 1]
        moves = "".join(_animate(name, _list(values)) for name, values in ends.items())
        yield _tag("line", moves, x1=_list([begin]), x2=_list([x]), y1=y, y2=y, **look)


def _block(i: int, x: float, moved: NDArray[np.float64], slides: Slides) -> str:
    """A block, with its number, that moves and has the colour of what it does."""
    colors = [KINDS[0][0]]
    times = [0.0]
    for start, stop, mode in slides:
        colors += [KINDS[mode][0], KINDS[0][0]]
        times += [start, stop]
    times = [t * MOVING / (MOVING + RESTING) for t in times]
    look = {"calcMode": "discrete", "keyTimes": _list(times, 4)}
    fill = _animate("fill", ";".join(colors), **look)
    y = PLANE - BLOCK
    box = _tag("rect", fill, x=_list([x]), y=y, width=BLOCK, height=BLOCK)
    number = _text(x + BLOCK / 2, y - 6, f"{i + 1}", text_anchor="middle")
    path = {"type": "translate"}
    return _tag(
        "g", _animate("transform", _list(moved), "Transform", **path) + box + number
    )


def _lane(i: int, slides: Slides) -> str:
    """When a block slides: bars over time, those of sliding back half as high."""
    bars = []
    for start, stop, mode in slides:
        width = (stop - start) * (RIGHT - LEFT)
        look = {"fill": KINDS[mode][0], "stroke": "none"}
        height = LANE - 3 if mode > 0 else (LANE - 3) / 2
        x = LEFT + start * (RIGHT - LEFT)
        place = {"x": _list([x]), "width": _list([width])}
        bars.append(_tag("rect", y=LANES + LANE * i, height=height, **place, **look))
    return "".join(bars) + _text(
        LEFT - 8, LANES + LANE * i + 12, f"{i + 1}", text_anchor="end"
    )


def _axis(n: int, duration: float, kinds: Iterable[int]) -> Iterable[str]:
    """Time, the moment that moves along, and the key."""
    bottom = LANES + LANE * n
    yield _text(LEFT - 8, LANES - 8, "block", text_anchor="end")
    yield _tag("path", d=f"M{LEFT} {bottom}H{RIGHT}", stroke=style.BLACK)
    for tick in np.arange(0.0, duration * 1e3, 0.1):
        x = LEFT + (RIGHT - LEFT) * tick / (duration * 1e3)
        yield _text(x, bottom + 18, f"{tick:.1f}", text_anchor="middle")
    yield _text(RIGHT, bottom + 18, "ms", text_anchor="end")
    now = np.linspace(LEFT, RIGHT, MOVING)
    moves = _animate("x1", _list(now)) + _animate("x2", _list(now))
    yield _tag(
        "line",
        moves,
        x1=LEFT,
        x2=LEFT,
        y1=LANES - 4,
        y2=bottom,
        stroke=style.BLACK,
        stroke_width=3,
    )
    for k, kind in enumerate(kinds):
        color, words = KINDS[kind]
        x = LEFT + 200 * k
        yield _tag("rect", x=x, y=bottom + 30, width=14, height=14, fill=color)
        yield _text(x + 22, bottom + 43, words)


def _animate(name: str, values: str, what: str = "", **more: Any) -> str:
    """Let an attribute take values in turn, again and again."""
    look = {"dur": f"{SECONDS}s", "repeatCount": "indefinite"}
    return _tag(f"animate{what}", attributeName=name, values=values, **look, **more)


def _list(values: Iterable[float], digits: int = 1) -> str:
    """Numbers; many of them are pictures, after which the last one rests."""
    numbers = [f"{value:.{digits}f}" for value in values]
    resting = RESTING if len(numbers) == MOVING else 0
    return ";".join(numbers + numbers[-1:] * resting)


def _rounded(value: float) -> str:
    """Two significant digits, and a space between thousands."""
    return f"{float(f'{value:.2g}'):,.0f}".replace(",", " ")


def _text(x: float, y: float, text: str, **look: Any) -> str:
    return _tag("text", text, x=f"{x:.1f}", y=y, **look)


def _tag(tag: str, inside: str = "", **attributes: Any) -> str:
    look = " ".join(
        f"{name.replace('_', '-')}={quoteattr(str(value))}"
        for name, value in attributes.items()
    )
    return f"<{tag} {look}>{inside}</{tag}>" if inside else f"<{tag} {look}/>"
