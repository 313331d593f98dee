"""The wave: an animated SVG of the blocks through the first global slip."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from precursors.figures import style

XMLNS = "http://www.w3.org/2000/svg"
# Lengths are in pixels of the page that shows it.
LEFT = 80  # of the time axis, and of the first block at rest
RIGHT = 980
PLANE = 130
BLOCK = 42
MIDDLE = PLANE - BLOCK / 2
FARTHEST = 44.0  # what the largest displacement is drawn as
LANES = 170  # top of the lanes, one a block
LANE = 16
SECONDS = 8  # of a loop: so many pictures move, and the rest of them rest
MOVING = 80
RESTING = 12
PICTURES = MOVING + RESTING
SHARES = np.minimum(np.arange(PICTURES) / (MOVING - 1), 1.0)  # of the event
COLORS = {0: style.PALE, 1: style.GLOBAL, -1: style.BACKWARD}
WORDS = {0: "sticks", 1: "slides forward", -1: "slides back"}
STYLE = f"""
text {{ font: 15px 'DejaVu Sans', sans-serif }}
rect, path {{ stroke: {style.BLACK} }}
.lane {{ stroke: none }}
.number {{ text-anchor: end }}
.middle {{ text-anchor: middle }}
.spring {{ stroke: {style.GREY}; stroke-width: 6; stroke-dasharray: 1 3 }}
.now {{ stroke-width: 3 }}
"""
# Block, start and stop as shares of the event, mode.
Slides = list[tuple[int, float, float, int]]


def draw(run: Any, slips: pd.DataFrame) -> str:
    """Write the first global slip, or else the longest event, as a looping SVG.

    A row of blocks moves and changes colour; lanes below it show who slides when. Of
    `run`, a `Run`, the transitions and the positions are drawn.
    """
    over = slips.dropna(subset="end_s")
    if over.empty:
        return f'<svg xmlns="{XMLNS}"><text y="24">no slip event</text></svg>\n'
    longest = over.sort_values(["is_global", "front"], ascending=False, kind="stable")
    onset, end = longest[["onset_s", "end_s"]].iloc[0]
    positions, _ = run.at(onset + SHARES * (end - onset))
    moved = positions - positions[0]
    enlarged = FARTHEST / np.abs(moved).max()  # pixels per m
    moved *= enlarged
    n = moved.shape[1]
    home = LEFT + (RIGHT - LEFT - FARTHEST - BLOCK) * np.arange(n) / max(n - 1, 1)
    slower = SECONDS * MOVING / PICTURES / (end - onset)
    pixels_per_m = (home[-1] - home[0]) / (slips["length_m"].iloc[0] * (1 - 1 / n))
    title = (
        f"A global slip runs through the row, {_rounded(slower)} times slower, "
        f"with {_rounded(enlarged / pixels_per_m)} times the movement"
    )
    slides = _slides(run.transitions, onset, end)
    bottom = LANES + LANE * n
    return "\n".join(
        [
            f'<svg xmlns="{XMLNS}" viewBox="0 0 1000 {bottom + 60}">',
            f"<title>{title}</title><style>{STYLE}</style>",
            '<rect width="100%" height="100%" style="fill: white; stroke: none"/>',
            f'<text x="{LEFT}" y="24" style="font-weight: bold">{title}</text>',
            f'<path d="M{LEFT} {PLANE}H{RIGHT}"/>',
            *_springs(home, moved),
            *(_block(i, home[i], moved[:, i], slides) for i in range(n)),
            *(_lane(*slide) for slide in slides),
            *_axis(n, bottom, end - onset),
            *_key({0, *(mode for *_, mode in slides)}, bottom),
            "</svg>\n",
        ]
    )


def _slides(transitions: NDArray[Any], onset: float, end: float) -> Slides:
    """Which block slides from when to when, and which way."""
    inside = (transitions["time"] >= onset) & (transitions["time"] <= end)
    found = []
    for block in np.unique(transitions["block"]):
        own = transitions[inside & (transitions["block"] == block)]
        shares = np.append((own["time"] - onset) / (end - onset), 1.0)
        for start, stop, mode in zip(shares, shares[1:], own["mode"], strict=False):
            if mode:
                found.append((int(block), start, stop, int(mode)))
    return found


def _springs(home: NDArray[np.float64], moved: NDArray[np.float64]) -> Iterable[str]:
    """The drive's spring, whose other end rests, and those between the blocks."""
    right = home + moved
    left = np.insert(right[:, :-1] + BLOCK, 0, LEFT - BLOCK, axis=1)
    for of_spring in np.stack([left, right], axis=2).swapaxes(0, 1):
        paths = [f"M{x1:.1f} {MIDDLE}H{x2:.1f}" for x1, x2 in of_spring]
        yield f'<path class="spring" d="{paths[0]}">{_animate("d", paths)}</path>'


def _block(i: int, x: float, moved: NDArray[np.float64], slides: Slides) -> str:
    """A block, with its number, that moves and has the colour of what it does."""
    colors = [COLORS[0]]
    times = [0.0]
    for block, start, stop, mode in slides:
        if block == i + 1:
            colors += [COLORS[mode], COLORS[0]]
            times += [start, stop]
    when = ";".join(f"{time * MOVING / PICTURES:.4f}" for time in times)
    fill = _animate("fill", colors, f'calcMode="discrete" keyTimes="{when}"')
    size = f'y="{PLANE - BLOCK}" width="{BLOCK}" height="{BLOCK}"'
    number = f'<text class="middle" x="{x + BLOCK / 2:.1f}" y="{PLANE - BLOCK - 6}">'
    return (
        f'<g>{_move(moved)}<rect x="{x:.1f}" {size}>{fill}</rect>'
        f"{number}{i + 1}</text></g>"
    )


def _lane(block: int, start: float, stop: float, mode: int) -> str:
    """When a block slides: a bar over time, half as high where it slides back."""
    x = LEFT + start * (RIGHT - LEFT)
    width = (stop - start) * (RIGHT - LEFT)
    height = LANE - 3 if mode > 0 else (LANE - 3) / 2
    return (
        f'<rect class="lane" x="{x:.1f}" y="{LANES + LANE * (block - 1)}" '
        f'width="{width:.1f}" height="{height}" fill="{COLORS[mode]}"/>'
    )


def _axis(n: int, bottom: int, duration: float) -> Iterable[str]:
    """The lanes' blocks, time, and the moment that moves along."""
    yield f'<text class="number" x="{LEFT - 8}" y="{LANES - 8}">block</text>'
    for i in range(n):
        y = LANES + LANE * i + 12
        yield f'<text class="number" x="{LEFT - 8}" y="{y}">{i + 1}</text>'
    yield f'<path d="M{LEFT} {bottom}H{RIGHT}"/>'
    for tick in np.arange(0.0, duration * 1e3, 0.1):
        x = LEFT + (RIGHT - LEFT) * tick / (duration * 1e3)
        yield f'<text class="middle" x="{x:.1f}" y="{bottom + 18}">{tick:.1f}</text>'
    yield f'<text class="number" x="{RIGHT}" y="{bottom + 18}">ms</text>'
    now = _move((RIGHT - LEFT) * SHARES)
    yield f'<path class="now" d="M{LEFT} {LANES - 4}V{bottom}">{now}</path>'


def _key(modes: Iterable[int], bottom: int) -> Iterable[str]:
    for k, mode in enumerate(mode for mode in COLORS if mode in modes):
        x = LEFT + 200 * k
        size = 'width="14" height="14"'
        yield f'<rect x="{x}" y="{bottom + 30}" {size} fill="{COLORS[mode]}"/>'
        yield f'<text x="{x + 22}" y="{bottom + 43}">{WORDS[mode]}</text>'


def _animate(
    name: str, values: Iterable[str], more: str = "", tag: str = "animate"
) -> str:
    """Let an attribute take values in turn, again and again."""
    looping = f'dur="{SECONDS}s" repeatCount="indefinite"'
    return (
        f'<{tag} attributeName="{name}" values="{";".join(values)}" {looping} {more}/>'
    )


def _move(pixels: NDArray[np.float64]) -> str:
    values = [f"{x:.1f}" for x in pixels]
    return _animate("transform", values, 'type="translate"', "animateTransform")


def _rounded(value: float) -> str:
    """Two significant digits, and a space between thousands."""
    return f"{float(f'{value:.2g}'):,.0f}".replace(",", " ")
