"""The wave: two precursors and the global slip, block by block, as an animated SVG."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from precursors.figures import style
from precursors.model.chain import FloatArray
from precursors.support.files import AnyPath, check_writable, write_text

XMLNS = "http://www.w3.org/2000/svg"
# Lengths are in pixels of the SVG.
LEFT = 80  # left edge of the first panel, and of block 1 at rest
RIGHT = 980
PLANE = 140
BLOCK = 42  # largest side of a block
FARTHEST = 44.0  # largest displacement
CLOSEST = 0.8  # largest share of the gap between two blocks by which it may shrink
LANES = 210  # top of the lanes: one per block, with block 1 at the bottom
LANE = 16  # largest height of a lane
ALL_LANES = 320  # largest height of all lanes
GAP = 24  # between two panels
SECONDS = 5  # duration of an act: MOVING pictures, then RESTING ones
MOVING = 80
RESTING = 12
PICTURES = MOVING + RESTING
SHARES = np.minimum(np.arange(PICTURES) / (MOVING - 1), 1.0)  # of the event
STUCK = style.PALE
DARK_INK = "#E6E6E6"  # for browsers in dark mode
DARK_PAGE = "#16191D"
KEY = "Coloured: the block slides; half as high: it slides back."
STYLE = f"""
text {{ font: 17px 'DejaVu Sans', sans-serif }}
text, path {{ fill: currentColor }}
rect, path {{ stroke: currentColor }}
.wave {{ color: {style.BLACK} }}
.page {{ fill: white; stroke: none }}
.lane {{ stroke: none }}
@media (prefers-color-scheme: dark) {{
  .wave {{ color: {DARK_INK} }}
  .page {{ fill: {DARK_PAGE} }}
  .lane {{ stroke: currentColor; stroke-width: 0.5 }}
}}
.number {{ text-anchor: end }}
.middle {{ text-anchor: middle }}
.spring {{ stroke: {style.GREY}; stroke-width: 1.5; fill: none }}
.index {{ font-size: 70% }}
.arrow {{ stroke-width: 3; fill: none }}
.reach {{ stroke-width: 2; stroke-dasharray: 5 4 }}
.now {{ stroke-width: 3 }}
"""
# Of each slide: block, start and stop as shares of the event, colour.
Slides = list[tuple[int, float, float, str]]


@dataclass(frozen=True)
class Movie:
    """An animated SVG; a notebook plays it."""

    svg: str

    def savefig(self, path: AnyPath) -> None:
        """Write the SVG file.

        Raises
        ------
        ValueError
            If the name does not end in .svg.
        """
        check_writable(path, (".svg",))
        write_text(path, self.svg)

    def _repr_html_(self) -> str:
        return self.svg


@dataclass(frozen=True)
class Act:
    """One event of the movie, with its panel."""

    event: Any  # its row of the slip table
    duration: float  # [s]
    moved: FloatArray  # displacement in each picture, of each block [pixels]
    scale: float  # pixels per m
    slides: Slides
    left: float  # of its panel
    width: float

    @property
    def name(self) -> str:
        """The kind of slip and the blocks that slide."""
        if self.event.is_global:
            return "global slip: all blocks at once"
        front = self.event.front
        if front == self.event.n_blocks:
            return "precursor: all blocks, not at once"
        return f"precursor: block{f's 1 to {front}' if front > 1 else ' 1'}"


def draw(run: Any, slips: pd.DataFrame) -> Movie:
    """Draw a precursor, the longest one and the first global slip, one after the other.

    A row of blocks moves and changes colour, and a mark shows how far the event
    reaches. Below the row, a panel for each event shows when each block slides. `run`
    is a `Run`; its transitions and positions are drawn.
    """
    shown = middle_last_and_global(slips)
    if shown.empty:
        return Movie(f'<svg xmlns="{XMLNS}"><text y="24">no slip event</text></svg>\n')
    n = int(shown["n_blocks"].iloc[0])
    pitch = (RIGHT - LEFT - FARTHEST) / n  # of the blocks
    side = min(BLOCK, 0.6 * pitch)
    width = (RIGHT - LEFT + GAP) / len(shown) - GAP
    acts = [
        _act(run, event, pitch - side, LEFT + i * (width + GAP), width)
        for i, event in enumerate(shown.itertuples())
    ]
    pixels_per_m = n * pitch / shown["slider_length_m"].iloc[0]
    lane = min(LANE, ALL_LANES / n)
    bottom = LANES + lane * n
    moved = np.concatenate([act.moved for act in acts])
    home = LEFT + pitch * np.arange(float(n))
    title = "How far slips reach, and how the blocks move in them"
    return Movie(
        "\n".join(
            [
                f'<svg xmlns="{XMLNS}" class="wave" viewBox="0 0 1000 {bottom + 70:.0f}">',
                f"<title>{title}</title><style>{STYLE}</style>",
                '<rect class="page" width="100%" height="100%"/>',
                f'<path d="M{LEFT - 40} {PLANE}H{RIGHT}"/>',
                _drive(side),
                *_springs(home, moved, side, len(acts)),
                *(_block(i, home[i], moved[:, i], side, acts) for i in range(n)),
                *(_caption(act, acts, home, side, pixels_per_m) for act in acts),
                *_numbers(n, lane),
                *(line for act in acts for line in _panel(act, lane, bottom)),
                _now(acts, bottom),
                f'<text x="{LEFT}" y="{bottom + 46:.0f}">{KEY}</text>',
                "</svg>\n",
            ]
        )
    )


def middle_last_and_global(slips: pd.DataFrame) -> pd.DataFrame:
    """Select the middle one of the counted precursors, the last one, and the global
    slip."""
    counted = slips[slips["counted"] & slips["end_s"].notna()]
    partial = counted[~counted["is_global"]]
    two = partial.iloc[sorted({(len(partial) - 1) // 2, len(partial) - 1} - {-1})]
    return pd.concat([two, counted[counted["is_global"]]])


def _act(run: Any, event: Any, room: float, left: float, width: float) -> Act:
    """Prepare an event; `room` is the gap between two blocks at rest [pixels]."""
    duration = event.end_s - event.onset_s
    positions, _ = run.at(event.onset_s + SHARES * duration)
    moved = positions - positions[0]
    closer = -np.diff(moved, axis=1).min(initial=0.0)
    most = max(np.abs(moved).max() / FARTHEST, closer / (CLOSEST * room))
    slides = _slides(run.transitions, event)
    return Act(event, duration, moved / most, 1 / most, slides, left, width)


def _slides(transitions: NDArray[Any], event: Any) -> Slides:
    """List which block slides when, and in which direction."""
    onset, end = event.onset_s, event.end_s
    colors = {1: style.GLOBAL if event.is_global else style.PARTIAL, -1: style.BACKWARD}
    inside = (transitions["time"] >= onset) & (transitions["time"] <= end)
    slides = []
    for block in np.unique(transitions["block"]):
        own = transitions[inside & (transitions["block"] == block)]
        shares = np.append((own["time"] - onset) / (end - onset), 1.0)
        for start, stop, mode in zip(shares, shares[1:], own["mode"], strict=False):
            if mode:
                slides.append((int(block), start, stop, colors[mode]))
    return slides


def _drive(side: float) -> str:
    """Draw the wall that pushes and an arrow; it moves too slowly to be animated."""
    x, y = LEFT - BLOCK, PLANE - side / 2
    return (
        f'<path d="M{x} {PLANE}v{-BLOCK}h-6v{BLOCK}z"/>'
        f'<path class="arrow" d="M4 {y:.1f}h22m-8 -6l8 6l-8 6"/>'
        f'<text x="4" y="{PLANE - BLOCK - 6}">drive</text>'
    )


def _springs(
    home: FloatArray, moved: FloatArray, side: float, n_acts: int
) -> Iterable[str]:
    """Draw the spring of the drive and those between the blocks."""
    right = home + moved
    left = np.insert(right[:, :-1] + side, 0, LEFT - BLOCK, axis=1)
    for of_spring in np.stack([left, right], axis=2).swapaxes(0, 1):
        paths = [_spring(x1, x2, PLANE - side / 2) for x1, x2 in of_spring]
        moving = _animate("d", paths, n_acts)
        yield f'<path class="spring" d="{paths[0]}">{moving}</path>'


def _spring(x1: float, x2: float, y: float) -> str:
    turn = (x2 - x1) / 4
    half, whole = f"l{turn / 2:.1f}", f"l{turn:.1f}"
    return f"M{x1:.1f} {y:.1f}{half}-6{whole} 12{whole}-12{whole} 12{half}-6"


def _block(i: int, x: float, moved: FloatArray, side: float, acts: list[Act]) -> str:
    """Draw a block with its number; it moves, and its colour shows its state."""
    share = MOVING / PICTURES
    colors = [STUCK]
    times = [0.0]
    for before, act in enumerate(acts):
        for block, start, stop, color in act.slides:
            if block == i + 1:
                colors += [color, STUCK]
                times += [(before + share * t) / len(acts) for t in (start, stop)]
    key_times = ";".join(f"{time:.4f}" for time in times)
    looks = f'calcMode="discrete" keyTimes="{key_times}"'
    fill = _animate("fill", colors, len(acts), looks)
    size = f'y="{PLANE - side:.1f}" width="{side:.1f}" height="{side:.1f}"'
    middle = f'class="middle" x="{x + side / 2:.1f}" y="{PLANE - side - 6:.1f}"'
    number = f"<text {middle}>{i + 1}</text>" if side > 20 else ""
    rect = f'<rect x="{x:.1f}" {size} fill="{STUCK}">{fill}</rect>'
    return f"<g>{_move(moved, len(acts))}{rect}{number}</g>"


def _caption(
    act: Act,
    acts: list[Act],
    home: FloatArray,
    side: float,
    pixels_per_m: float,
) -> str:
    """Draw the text about an event and the mark of its front, visible during the
    event."""
    slower = SECONDS * MOVING / PICTURES / act.duration
    scales = (
        f'F<tspan class="index" dy="4">X</tspan><tspan dy="-4"> = </tspan>'
        f"{act.event.load_before_N:.4g} N; slowed down {_rounded(slower)} times, "
        f"movement enlarged {_rounded(act.scale / pixels_per_m)} times"
    )
    x = home[act.event.front - 1] + side
    looks = ["visible" if other is act else "hidden" for other in acts]
    showing = _animate("visibility", looks, len(acts), 'calcMode="discrete"')
    return (
        f'<g visibility="{looks[0]}">{showing}'
        f'<text x="{LEFT}" y="24" style="font-weight: bold">{act.name}</text>'
        f'<text x="{LEFT}" y="46">{scales}</text>'
        f'<path d="M{x:.1f} {PLANE + 3}l7 12h-14z"/>'
        f'<text class="number" x="{x - 12:.1f}" y="{PLANE + 16}">front</text></g>'
    )


def _numbers(n: int, lane: float) -> Iterable[str]:
    yield f'<text class="number" x="{LEFT - 8}" y="{LANES - 8}">block</text>'
    for i in range(0, n, -(-n // 10)):
        y = LANES + lane * (n - i - 0.5) + 5
        yield f'<text class="number" x="{LEFT - 8}" y="{y:.1f}">{i + 1}</text>'


def _panel(act: Act, lane: float, bottom: float) -> Iterable[str]:
    """Draw the panel of an event: a bar while a block slides (half as high for backward
    sliding), a line for the front, and the axis of time."""
    for block, start, stop, color in act.slides:
        x = act.left + start * act.width
        y = bottom - lane * block
        height = 0.8 * lane / (1 + (color == style.BACKWARD))
        yield (
            f'<rect class="lane" x="{x:.1f}" y="{y:.1f}" '
            f'width="{(stop - start) * act.width:.1f}" height="{height:.1f}" '
            f'fill="{color}"/>'
        )
    reach = bottom - lane * act.event.front - 3
    yield f'<path class="reach" d="M{act.left:.1f} {reach:.1f}h{act.width:.1f}"/>'
    yield f'<text x="{act.left:.1f}" y="{reach - 6:.1f}">{act.name}</text>'
    yield f'<path d="M{act.left:.1f} {bottom:.1f}h{act.width:.1f}"/>'
    end_us = 1e6 * act.duration
    for tick in MaxNLocator(3).tick_values(0.0, 0.85 * end_us)[:-1]:
        x = act.left + act.width * tick / end_us
        yield f'<text class="middle" x="{x:.1f}" y="{bottom + 18:.0f}">{tick:g}</text>'
    x = act.left + act.width
    yield f'<text class="number" x="{x:.1f}" y="{bottom + 18:.0f}">µs</text>'


def _now(acts: list[Act], bottom: float) -> str:
    """Draw the line that marks the current time in the panels."""
    x = np.concatenate([act.left + act.width * SHARES for act in acts])
    moving = _move(x - LEFT, len(acts))
    return f'<path class="now" d="M{LEFT} {LANES - 4}V{bottom:.1f}">{moving}</path>'


def _animate(
    name: str, values: Iterable[str], n_acts: int, more: str = "", tag: str = "animate"
) -> str:
    """Animate an attribute through values in an endless loop."""
    looping = f'dur="{SECONDS * n_acts}s" repeatCount="indefinite"'
    return (
        f'<{tag} attributeName="{name}" values="{";".join(values)}" {looping} {more}/>'
    )


def _move(pixels: FloatArray, n_acts: int) -> str:
    values = [f"{x:.1f}" for x in pixels]
    return _animate("transform", values, n_acts, 'type="translate"', "animateTransform")


def _rounded(value: float) -> str:
    """Write a number with two significant digits and commas between thousands."""
    return f"{float(f'{value:.2g}'):,.0f}"
