"""A film of slip events in slow motion: the blocks, their velocities, and friction over strength, as a GIF.

GIF, because Pillow, which Matplotlib needs anyway, writes it, and every browser and viewer plays it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from PIL import Image

from precursors.analysis.slip_rows import require_first_global
from precursors.analysis.slips import find_precursors, find_slips
from precursors.figures import style
from precursors.model.chain import Chain, FloatArray, positive
from precursors.solver.run import Run
from precursors.support.files import write_whole

WIDTH_MM, HEIGHT_MM, DPI = 165.0, 118.0, 100
FRAMES_PER_SECOND = 12.5  # GIF counts time in hundredths of a second
SECONDS_PER_EVENT = 8.0
LEAD = 0.08  # of an event's duration, shown before and after it
STILL_FRAMES = 8  # how often the last frame of an event is repeated
N_COLORS = 64
STUCK = "#D9D9D9"
# In units of the pitch of the blocks: their size, and how far a block moves and comes near another at most.
BLOCK_WIDTH, BLOCK_HEIGHT, LARGEST_SHIFT, LARGEST_APPROACH = 0.62, 0.62, 1.0, 0.24
COILS = 4


@dataclass(frozen=True)
class Clip:
    """One slip event, frame by frame.

    Attributes
    ----------
    title : str
        What is seen.
    color : str
        Colour of a block that slides.
    onset : float
        Time of the onset [s].
    chain : Chain
        The chain.
    times : array, shape (n_frames,)
        Time since the onset [s].
    displacements, velocities, friction : array, shape (n_frames, N)
        Displacement since the first frame [m], velocity [m/s], and friction force over strength [1], positive
        where it resists sliding forward.
    loads : array, shape (n_frames,)
        Tangential load F_X [N].
    """

    title: str
    color: str
    onset: float
    chain: Chain
    times: FloatArray
    displacements: FloatArray
    velocities: FloatArray
    friction: FloatArray
    loads: FloatArray


def film_clips(run: Run, seconds_per_event: float = SECONDS_PER_EVENT) -> list[Clip]:
    """The farthest precursor and the first global slip of a run, slowed down to so many seconds each.

    Raises
    ------
    ValueError
        If the run has no finished global slip, or no precursor before it, or its interface is elastic.
    """
    if run.chain.interface_stiffness:
        raise ValueError(
            f"interface_stiffness = {run.chain.interface_stiffness!r} [N/m]: allowed is 0 in a film, which "
            "shows stuck blocks at rest"
        )
    n_frames = round(positive("seconds_per_event", seconds_per_event, "s") * FRAMES_PER_SECOND) + 1
    slips = find_slips(run)
    number = require_first_global(slips)
    if np.isnan(slips["end"].iloc[number]):
        raise ValueError("the first global slip is not over when the run ends: run the chain for longer")
    precursors = find_precursors(slips).drop(index=slips.index[number])
    if precursors.empty:
        raise ValueError("the run has no precursor before its first global slip: nothing to film")
    farthest = int(precursors["front"].idxmax())
    events = ((farthest, "precursor", style.BLUE), (number, "first global slip", style.VERMILION))
    return [
        _clip(run, slips["onset"].iloc[i], slips["end"].iloc[i], f"Event {i + 1}, {what}", color, n_frames)
        for i, what, color in events
    ]


def write_film(clips: Sequence[Clip], path: str | Path) -> None:
    """Write clips one after the other as a GIF, the same bytes every time.

    Raises
    ------
    ValueError
        If there is no clip, or the name does not end in .gif.
    OSError
        If the file cannot be written.
    """
    if not clips:
        raise ValueError("the film has no clip: allowed is at least one")
    if Path(path).suffix != ".gif":
        raise ValueError(f"film {path} has the ending {Path(path).suffix!r}: allowed is .gif")
    pictures = [picture for clip in clips for picture in _pictures(clip)]
    palette = _palette(pictures)
    frames = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    with write_whole(path) as temporary:
        frames[0].save(
            temporary,
            format="GIF",
            save_all=True,
            append_images=frames[1:],
            duration=round(1000 / FRAMES_PER_SECOND),
            loop=0,
            optimize=False,
        )


def friction_over_strength(chain: Chain, spring_forces: FloatArray, velocities: FloatArray) -> FloatArray:
    """Friction force over strength mu_s w_i, positive where it resists sliding forward (Eqs. 5, 6).

    A stuck block's friction balances its springs and dashpots; a sliding one's is mu_k w_i against its
    velocity. The interface is rigid: a block whose velocity is zero sticks.

    Parameters
    ----------
    chain : Chain
        The chain.
    spring_forces, velocities : array, shape (n, N)
        Force in the spring behind each block [N] and velocity of each block [m/s].
    """
    behind = np.array(spring_forces)
    behind[:, 1:] -= chain.viscosity * np.diff(velocities, axis=1)
    ahead = np.column_stack([behind[:, 1:], np.zeros(len(behind))])
    friction = np.where(velocities == 0, behind - ahead, np.sign(velocities) * chain.kinetic_friction)
    return np.divide(friction, chain.strength, out=np.zeros_like(friction), where=chain.strength > 0)


def _clip(run: Run, onset: float, end: float, title: str, color: str, n_frames: int) -> Clip:
    lead = LEAD * (end - onset)
    times = np.linspace(max(onset - lead, 0.0), min(end + lead, run.duration), n_frames)
    positions, velocities = run.at(times)
    return Clip(
        title=title,
        color=color,
        onset=onset,
        chain=run.chain,
        times=times - onset,
        displacements=positions - positions[0],
        velocities=velocities,
        friction=friction_over_strength(run.chain, run.spring_forces(times), velocities),
        loads=run.tangential_load(times),
    )


def _pictures(clip: Clip) -> Iterator[Image.Image]:
    """Frames of a clip: what stands still is drawn once, what moves is drawn over it."""
    with style.styled():
        figure = Figure(figsize=(style.inches(WIDTH_MM), style.inches(HEIGHT_MM)), dpi=DPI, facecolor="white")
        canvas = FigureCanvasAgg(figure)
        scene = _Stage(figure, clip)
        style.lay_out(figure)
        canvas.draw()
        background = canvas.copy_from_bbox(figure.bbox)  # type: ignore[attr-defined]
        for frame in range(len(clip.times)):
            canvas.restore_region(background)  # type: ignore[attr-defined]
            scene.show(frame)
            picture = Image.fromarray(np.asarray(canvas.buffer_rgba()).copy()).convert("RGB")
            yield picture
    yield from [picture] * STILL_FRAMES


class _Stage:
    """The panels of a film and what moves in them."""

    def __init__(self, figure: Figure, clip: Clip) -> None:
        self.clip = clip
        blocks, self.load, self.velocity, self.friction = figure.subplots(
            4, 1, height_ratios=[1.25, 1.1, 1.0, 1.0]
        )
        self.blocks = blocks
        n = clip.chain.n_blocks
        self.numbers = np.arange(1, n + 1)
        pitch = clip.chain.length / n
        farthest = np.abs(clip.displacements).max()
        nearest = np.abs(np.diff(clip.displacements, axis=1)).max(initial=0.0)
        exaggeration = pitch * min(LARGEST_SHIFT / farthest, LARGEST_APPROACH / max(nearest, 1e-300))
        self.shifts = exaggeration * clip.displacements / pitch
        slowdown = (len(clip.times) - 1) / FRAMES_PER_SECOND / np.ptp(clip.times)
        blocks.set_title(
            f"{clip.title} at {clip.onset:.6f} s, {_two_digits(slowdown):,} times slower; "
            f"displacements drawn {_two_digits(exaggeration):,} times larger",
            loc="left",
            fontsize=8,
        )
        self.rectangles, self.springs = self._lay_blocks(blocks)
        self._draw_load(self.load)
        (self.point,) = self.load.plot([], [], "o", color=clip.color, markersize=5, animated=True)
        self.clock = self.load.text(
            0.985, 0.86, "", transform=self.load.transAxes, ha="right", va="top", fontsize=9, animated=True
        )
        self.velocity_bars = self._bars(self.velocity, "Velocity\n[m/s]", clip.velocities)
        self.friction_bars = self._bars(self.friction, "Friction\n/ strength", np.array([-0.05, 1.12]))
        for level in (1.0, clip.chain.mu_k / clip.chain.mu_s if clip.chain.mu_s else 0.0):
            self.friction.axhline(level, color=style.GREY, linewidth=0.6, linestyle=(0, (4, 2)))
        self.friction.set_xlabel("Block (1 at the trailing edge)")
        figure.align_ylabels([self.load, self.velocity, self.friction])

    def show(self, frame: int) -> None:
        """Draw what moves as it is in a frame."""
        clip = self.clip
        sliding = clip.velocities[frame] != 0
        colors = [clip.color if slides else STUCK for slides in sliding]
        places = self.numbers + self.shifts[frame]
        for rectangle, place, color in zip(self.rectangles, places, colors, strict=True):
            rectangle.set_x(place - BLOCK_WIDTH / 2)
            rectangle.set_facecolor(color)
        ends = np.concatenate([[0.0], places + BLOCK_WIDTH / 2])
        for spring, start, end in zip(self.springs, ends[:-1], places - BLOCK_WIDTH / 2, strict=True):
            spring.set_data(*_coil(start, end))
        for bars, heights in (
            (self.velocity_bars, clip.velocities[frame]),
            (self.friction_bars, clip.friction[frame]),
        ):
            for bar, height, color in zip(bars, heights, colors, strict=True):
                bar.set_height(height)
                bar.set_facecolor(color)
        self.point.set_data([1e6 * clip.times[frame]], [clip.loads[frame]])
        self.clock.set_text(f"{1e6 * clip.times[frame]:.0f} µs,  {clip.loads[frame]:.1f} N")
        moving: dict[Axes, list[Any]] = {
            self.blocks: [*self.springs, *self.rectangles],
            self.load: [self.point, self.clock],
            self.velocity: self.velocity_bars,
            self.friction: self.friction_bars,
        }
        for axes, artists in moving.items():
            for artist in artists:
                axes.draw_artist(artist)

    def _lay_blocks(self, axes: Axes) -> tuple[list[Rectangle], list[Any]]:
        """Ground and wall, and the blocks and springs that move over it."""
        n = self.clip.chain.n_blocks
        axes.set_xlim(-0.25, n + LARGEST_SHIFT + BLOCK_WIDTH)
        axes.set_ylim(-0.25, 1.0)
        axes.set_axis_off()
        axes.axhspan(-0.12, 0.0, facecolor="none", edgecolor=style.GREY, hatch="//////", linewidth=0)
        axes.axhline(0.0, color=style.BLACK, linewidth=0.8)
        axes.fill_between([-0.12, 0.0], 0.05, 0.75, color=style.BLACK, linewidth=0)
        rectangles = [
            Rectangle((0, 0), BLOCK_WIDTH, BLOCK_HEIGHT, edgecolor=style.BLACK, linewidth=0.8, animated=True)
            for _ in range(n)
        ]
        for rectangle in rectangles:
            axes.add_patch(rectangle)
        springs = [axes.plot([], [], color=style.BLACK, linewidth=0.8, animated=True)[0] for _ in range(n)]
        return rectangles, springs

    def _draw_load(self, axes: Axes) -> None:
        axes.plot(1e6 * self.clip.times, self.clip.loads, color=style.BLACK, linewidth=0.9)
        axes.set_xlim(1e6 * self.clip.times[0], 1e6 * self.clip.times[-1])
        axes.margins(y=0.15)
        axes.set_ylabel("$F_X$ [N]")
        axes.set_xlabel("Time since the onset [µs]")

    def _bars(self, axes: Axes, label: str, values: FloatArray) -> list[Any]:
        low, high = min(values.min(), 0.0), max(values.max(), 1e-12)
        axes.set_ylim(low - 0.05 * (high - low), high + 0.05 * (high - low))
        axes.axhline(0.0, color=style.BLACK, linewidth=0.6)
        axes.set_ylabel(label)
        step = -(-len(self.numbers) // 20)
        axes.set_xticks(self.numbers[::step])
        axes.set_xlim(0.4, len(self.numbers) + 0.6)
        bars = axes.bar(
            self.numbers, np.zeros(len(self.numbers)), width=0.7, edgecolor=style.BLACK, linewidth=0.5
        )
        for bar in bars:
            bar.set_animated(True)
        return list(bars)


def _coil(start: float, end: float) -> tuple[FloatArray, FloatArray]:
    """Points of a spring between two places."""
    along = np.array([0.0, 0.15, *np.linspace(0.2, 0.8, 2 * COILS), 0.85, 1.0])
    across = np.array([0, 0, *(0.1 * (-1) ** k for k in range(2 * COILS)), 0, 0])
    return start + (end - start) * along, BLOCK_HEIGHT / 2 + across


def _two_digits(value: float) -> int:
    return int(float(f"{value:.2g}"))


def _palette(pictures: Sequence[Image.Image]) -> Image.Image:
    """One palette for all frames, so that what stands still has the same bytes: the most frequent colours."""
    some = pictures[:: max(len(pictures) // 16, 1)]
    counts = np.zeros(2**24, dtype=np.int64)
    for picture in some:
        red, green, blue = np.asarray(picture, dtype=np.int64).reshape(-1, 3).T
        np.add.at(counts, red << 16 | green << 8 | blue, 1)
    present = np.flatnonzero(counts)
    most = present[np.argsort(-counts[present], kind="stable")[:N_COLORS]]
    palette = Image.new("P", (1, 1))
    palette.putpalette(most.astype(">u4").view(np.uint8).reshape(-1, 4)[:, 1:].ravel().tolist())
    return palette
