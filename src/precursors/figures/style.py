"""The look of all figures: sizes, colours, words for numbers, the page, and the
files."""

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from io import BytesIO
from math import isclose, isnan
from pathlib import Path
from textwrap import fill
from typing import Any

import matplotlib.style
import numpy as np
from matplotlib.axis import Axis
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.font_manager import findfont
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from precursors.support.files import write_whole

# Keyword arguments of a method of Matplotlib that draws.
Options = dict[str, Any]

# One colour, one meaning, in all figures and the page. Every two differ by more than 20
# in CIELAB, for readers with protanopia or deuteranopia as well.
TRAILING = "#C27400"  # the three loadings: more load at the trailing edge,
UNIFORM = "#158243"  # uniform load,
LEADING = "#BB5EB5"  # more load at the leading edge
PARTIAL = "#45BBFF"  # the kinds of slip
GLOBAL = "#A7000E"
BACKWARD = "#374DC2"
BLACK = "#000000"  # the exact solution
MEASURED = "#6200FF"
GREY = "#8C8C8C"  # everything else
# Solvers of others, in the charts that compare solvers; each has its name beside it.
OTHERS = ("#4B1FA8", "#36B3D6", "#6B5200", "#BFA800", "#84294F")
LOADINGS = {
    -1: "more load at the trailing edge",
    0: "uniform load",
    1: "more load at the leading edge",
}
PALE = "#E6E6E6"

MM_PER_M = 1e3
MM_PER_INCH = 25.4
COLUMN_MM = 85.0
PAGE_MM = 178.0
PNG_DPI = 300
SCREEN_DPI = 120
# Of a line of a key that has the name of a file, and of the name in it.
MOST_LETTERS = 45
LEAST_LETTERS = 12
LONGEST_NAME = 29
TICKS = 0.9  # size of their labels, in those of the text: 7 pt is the least in print

MU_SAPP_LABEL = r"$\mu_\mathrm{sapp}$ [-]"
DOTTED: Options = {"color": GREY, "linewidth": 0.6, "linestyle": ":", "zorder": 1}

_SETTINGS: Options = {
    "axes.linewidth": 0.6,
    "axes.axisbelow": True,
    "axes.titlesize": "medium",
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 3,
    "ytick.major.size": 3,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "legend.frameon": False,
    "legend.columnspacing": 1.4,
    "lines.linewidth": 0.8,
    "lines.markersize": 4,
    "hatch.linewidth": 0.6,
    # Mathematics in the font of the text.
    "mathtext.fontset": "custom",
    "mathtext.cal": "sans",
    # Element ids of an SVG come from this salt instead of a random number.
    "svg.hashsalt": "precursors",
    "svg.fonttype": "none",  # text stays text
    # TrueType, which programs that draw can edit; journals refuse the Type 3 that is
    # the default.
    "pdf.fonttype": 42,
    "ps.fonttype": 42,
}
# Without the date and the release of Matplotlib, the same table gives the same bytes.
_METADATA: dict[str, dict[str, str | None]] = {
    ".png": {"Software": None},
    ".svg": {"Date": None, "Creator": None},
    ".pdf": {"CreationDate": None, "Creator": None, "Producer": None},
    ".eps": {"Creator": "precursors"},
}


@dataclass(frozen=True)
class Look:
    """A journal's demands on a figure: its width [mm], None for the figure's own, and
    its text.

    Raises
    ------
    ValueError
        If the width or the size is none that can be drawn, or the font is not
        installed.
    """

    width_mm: float | None = None
    font_size: float = 8.0
    font: str = "DejaVu Sans"

    def __post_init__(self) -> None:
        if self.width_mm is not None and not 40 <= self.width_mm <= 400:
            raise ValueError(
                f"the width must be between 40 and 400 mm, but is {self.width_mm:g}"
            )
        if not 4 <= self.font_size <= 24:
            raise ValueError(
                f"the font size must be between 4 and 24 pt, but is {self.font_size:g}"
            )
        try:
            findfont(self.font, fallback_to_default=False)
        except ValueError:
            raise ValueError(f"the font {self.font!r} is not installed") from None

    @property
    def settings(self) -> Options:
        """The settings of Matplotlib that follow."""
        ticks = TICKS * self.font_size
        own = {"font.size": self.font_size, "font.sans-serif": self.font}
        return _SETTINGS | own | {"xtick.labelsize": ticks, "ytick.labelsize": ticks}


LOOK = Look()


class Page(Figure):
    """A figure that has its look wherever it is saved or shown, and that a notebook
    shows."""

    look = LOOK

    def draw(self, renderer: Any) -> None:
        """Draw it, without settings of the user's."""
        with matplotlib.style.context(self.look.settings, after_reset=True):
            super().draw(renderer)

    def savefig(self, *args: Any, **options: Any) -> None:
        """Write it, without settings of the user's."""
        with matplotlib.style.context(self.look.settings, after_reset=True):
            super().savefig(*args, **options)

    def _repr_png_(self) -> bytes:
        buffer = BytesIO()
        self.savefig(buffer, dpi=SCREEN_DPI)
        return buffer.getvalue()


@contextmanager
def page(width_mm: float, height_mm: float, look: Look = LOOK) -> Iterator[Figure]:
    """Make a figure of a given size on paper [mm], with room for its labels when the
    block ends.

    The settings of a user's matplotlibrc have no effect. The layout is done once,
    because a layout for each file would make the files differ slightly.
    """
    with matplotlib.style.context(look.settings, after_reset=True):
        size = ((look.width_mm or width_mm) / MM_PER_INCH, height_mm / MM_PER_INCH)
        figure = Page(figsize=size, dpi=PNG_DPI, facecolor="white")
        figure.look = look
        yield figure
        ConstrainedLayoutEngine().execute(figure)
        for axes in figure.axes:
            # The layout differs in the last bits from one run to the next, and ids of an
            # SVG with them.
            axes.set_position(np.round(axes.get_position(original=True).bounds, 12))


def save(
    figure: Figure, path: str | Path, look: Look = LOOK, title: str | None = None
) -> None:
    """Write a figure as PNG (300 dpi), SVG, PDF or EPS, complete or not at all, always
    the same bytes.

    `look` is that of its page, and `title` what a reader of an SVG hears.
    """
    ending = Path(path).suffix.lower()
    metadata = _METADATA[ending]
    if title and ending == ".svg":
        metadata = metadata | {"Title": title}
    buffer = BytesIO()
    with matplotlib.style.context(look.settings, after_reset=True):
        figure.savefig(buffer, format=ending[1:], dpi=PNG_DPI, metadata=metadata)
    write_whole(path, re.sub(rb"%%CreationDate: .*\n", b"", buffer.getvalue()))


def columns(figure: Figure, label: str, n: int) -> NDArray[Any]:
    """Make `n` panels side by side with the same axes, and a label of the y axis."""
    panels = figure.subplots(1, n, sharex=True, sharey=True, squeeze=False)[0]
    panels[0].set_ylabel(label)
    return panels


def pale(color: str, share: float) -> str:
    """Mix a colour with white: EPS, which knows no transparency, shows it as the others
    do."""
    red, green, blue = 1 - share * (1 - np.array(to_rgb(color)))
    return to_hex((red, green, blue))


def set_ticks(axis: Axis, values: Sequence[float]) -> None:
    """Put ticks at some values of an axis and nowhere else, labelled as decimal
    numbers."""
    axis.set_ticks(values)
    axis.set_ticks([], minor=True)
    axis.set_major_formatter("{x:g}")


def theta_text(theta: float) -> str:
    """Write theta, as a fraction if it has a small denominator (-5/6), else as a
    decimal number; without one, the loads are measured."""
    if isnan(theta):
        return "loads as measured"
    fraction = Fraction(theta).limit_denominator(12)
    text = str(fraction) if isclose(fraction, theta) else f"{theta:.4g}"
    return rf"$\theta = {text}$"


def theta_color(theta: float) -> str:
    """Colour of a scene: by the end that carries the larger load."""
    return TRAILING if theta < 0 else LEADING if theta > 0 else UNIFORM


@dataclass(frozen=True)
class Measured:
    """Measured points, shape (n, 2): loads F_X or, if so marked, front lengths; the key
    names them."""

    name: str
    points: NDArray[np.float64]
    are_lengths: bool = False

    @property
    def label(self) -> str:
        """The name in the key, of which a long one has its beginning and end."""
        is_long = len(self.name) > LONGEST_NAME
        return plain(f"{self.name[:13]}...{self.name[-13:]}" if is_long else self.name)

    def beside(self, curve: NDArray[np.float64], first_global: float, unit: str) -> str:
        """The name, and how far the points are from the lines between points of a run,
        up to its first global slip, or NaN."""
        seen, values = self.points[~(self.points[:, 0] > first_global)].T
        if not (len(seen) and len(curve)):
            return self.label
        rms = np.sqrt(np.mean((values - np.interp(seen, *curve.T)) ** 2))
        until = "end" if isnan(first_global) else "first global slip"
        distance = f"{rms:.3g} {unit} rms from the run up to its {until}"
        return fill(f"{self.label}: {distance}", MOST_LETTERS)


def plain(text: str) -> str:
    """Keep Matplotlib from reading a dollar sign in a user's text as mathematics.

    Raises
    ------
    ValueError
        If the text has characters that no SVG may have.
    """
    if re.search(r"[\x00-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]", text):
        raise ValueError(f"the title must have no control characters, but is {text!r}")
    return text.replace("$", r"\$")


def draw_key(figure: Figure, entries: Sequence[Any] = (), ncols: int = 0) -> None:
    """Draw a key below the panels, for marks that mean the same in all of them; by
    default of all that is drawn and has a label. It has fewer columns, or shorter
    lines, if they would be wider than the page."""
    handles = {
        label: handle
        for axes in figure.axes
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    entries = entries or list(handles.values())
    for columns in range(ncols or len(entries), 0, -1):
        key = figure.legend(handles=entries, loc="outside lower center", ncols=columns)
        if key.get_window_extent().width <= figure.bbox.width:
            return
        if columns > 1:
            key.remove()
    words = {text: text.get_text() for text in key.get_texts()}
    for letters in range(MOST_LETTERS, LEAST_LETTERS, -2):
        for text, label in words.items():
            text.set_text(label if "$" in label else fill(label, letters))
        if key.get_window_extent().width <= figure.bbox.width:
            return


def mark(label: str, **look: Any) -> Line2D:
    """Make an entry of a key that looks like a plotted line or marker; black where no
    color is given."""
    return Line2D([], [], **{"color": BLACK, **look}, label=label)
