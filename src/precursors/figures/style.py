"""The look of all figures: sizes, colours, labels, pages and files."""

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

# Keyword arguments of a drawing method of Matplotlib.
Options = dict[str, Any]

# Each colour has one meaning in all figures and on the interactive page. Any two differ
# by more than 20 in CIELAB, also for readers with protanopia or deuteranopia.
TRAILING = "#C27400"  # more normal load at the trailing edge
UNIFORM = "#158243"  # uniform normal load
LEADING = "#BB5EB5"  # more normal load at the leading edge
PARTIAL = "#45BBFF"  # the kinds of slip
GLOBAL = "#A7000E"
BACKWARD = "#374DC2"
BLACK = "#000000"  # the exact solution
MEASURED = "#6200FF"
GREY = "#8C8C8C"  # everything else
# Other solvers, in charts that compare solvers; each has its name beside it.
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
# Lengths of a line of the key, and of a file name in it [letters].
MOST_LETTERS = 45
LEAST_LETTERS = 12
LONGEST_NAME = 29
TICKS = 0.9  # font size of tick labels over that of the text; print needs 7 pt or more

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
    # TrueType, which drawing programs can edit; journals refuse the default, Type 3.
    "pdf.fonttype": 42,
    "ps.fonttype": 42,
}
# The date and the release of Matplotlib are left out, so that the same table always
# gives the same bytes.
_METADATA: dict[str, dict[str, str | None]] = {
    ".png": {"Software": None},
    ".svg": {"Date": None, "Creator": None},
    ".pdf": {"CreationDate": None, "Creator": None, "Producer": None},
    ".eps": {"Creator": "precursors"},
}


@dataclass(frozen=True)
class Look:
    """Requirements of a journal: width [mm] (None for the default of the figure), font
    size [pt] and font.

    Raises
    ------
    ValueError
        If the width or the font size is out of range, or the font is not installed.
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
        """The settings of Matplotlib for this look."""
        ticks = TICKS * self.font_size
        own = {"font.size": self.font_size, "font.sans-serif": self.font}
        return _SETTINGS | own | {"xtick.labelsize": ticks, "ytick.labelsize": ticks}


LOOK = Look()


class Page(Figure):
    """A figure with the same look wherever it is saved or shown; a notebook displays
    it."""

    look = LOOK

    def draw(self, renderer: Any) -> None:
        """Draw the figure, ignoring the settings of the user."""
        with matplotlib.style.context(self.look.settings, after_reset=True):
            super().draw(renderer)

    def savefig(self, *args: Any, **options: Any) -> None:
        """Save the figure, ignoring the settings of the user."""
        with matplotlib.style.context(self.look.settings, after_reset=True):
            super().savefig(*args, **options)

    def _repr_png_(self) -> bytes:
        buffer = BytesIO()
        self.savefig(buffer, dpi=SCREEN_DPI)
        return buffer.getvalue()


@contextmanager
def page(width_mm: float, height_mm: float, look: Look = LOOK) -> Iterator[Figure]:
    """Make a figure of a given size on paper [mm], and lay it out when the `with` block
    ends.

    A user's matplotlibrc has no effect. The layout is computed once, because a new one
    for each file would make the files differ slightly.
    """
    with matplotlib.style.context(look.settings, after_reset=True):
        size = ((look.width_mm or width_mm) / MM_PER_INCH, height_mm / MM_PER_INCH)
        figure = Page(figsize=size, dpi=PNG_DPI, facecolor="white")
        figure.look = look
        yield figure
        ConstrainedLayoutEngine().execute(figure)
        for axes in figure.axes:
            # The last bits of the layout, and ids of an SVG with them, differ between
            # runs.
            axes.set_position(np.round(axes.get_position(original=True).bounds, 12))


def save(
    figure: Figure, path: str | Path, look: Look = LOOK, title: str | None = None
) -> None:
    """Write a figure as PNG (300 dpi), SVG, PDF or EPS, completely or not at all.

    The same figure always gives the same bytes. `look` is that of the page. `title` is
    the title of an SVG, which screen readers read.
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
    """Make `n` panels side by side with shared axes and a label of the y axis."""
    panels = figure.subplots(1, n, sharex=True, sharey=True, squeeze=False)[0]
    panels[0].set_ylabel(label)
    return panels


def pale(color: str, share: float) -> str:
    """Mix a colour with white; unlike transparency, this also works in EPS."""
    red, green, blue = 1 - share * (1 - np.array(to_rgb(color)))
    return to_hex((red, green, blue))


def set_ticks(axis: Axis, values: Sequence[float]) -> None:
    """Put ticks only at these values of an axis, labelled as decimal numbers."""
    axis.set_ticks(values)
    axis.set_ticks([], minor=True)
    axis.set_major_formatter("{x:g}")


def theta_text(theta: float) -> str:
    """Write theta as a fraction if its denominator is small (-5/6), else as a decimal
    number; NaN means measured loads."""
    if isnan(theta):
        return "loads as measured"
    fraction = Fraction(theta).limit_denominator(12)
    text = str(fraction) if isclose(fraction, theta) else f"{theta:.4g}"
    return rf"$\theta = {text}$"


def theta_color(theta: float) -> str:
    """Return the colour of a scene, which shows the end with the larger load."""
    return TRAILING if theta < 0 else LEADING if theta > 0 else UNIFORM


@dataclass(frozen=True)
class Measured:
    """Measured points, shape (n, 2), and their name in the key: loads F_X, or front
    lengths if `are_lengths`."""

    name: str
    points: NDArray[np.float64]
    are_lengths: bool = False

    @property
    def label(self) -> str:
        """The name in the key; a long one is shortened in the middle."""
        is_long = len(self.name) > LONGEST_NAME
        return plain(f"{self.name[:13]}...{self.name[-13:]}" if is_long else self.name)

    def beside(self, curve: NDArray[np.float64], first_global: float, unit: str) -> str:
        """Return the name with the rms distance of the points from a curve of the run.

        Points after `first_global` are ignored, unless it is NaN (no global slip).
        """
        seen, values = self.points[~(self.points[:, 0] > first_global)].T
        if not (len(seen) and len(curve)):
            return self.label
        rms = np.sqrt(np.mean((values - np.interp(seen, *curve.T)) ** 2))
        until = "end" if isnan(first_global) else "first global slip"
        distance = f"{rms:.3g} {unit} rms from the run up to its {until}"
        return fill(f"{self.label}: {distance}", MOST_LETTERS)


def plain(text: str) -> str:
    """Escape dollar signs in a user's text, which Matplotlib would read as mathematics.

    Raises
    ------
    ValueError
        If the text has characters that are not allowed in SVG.
    """
    if re.search(r"[\x00-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]", text):
        raise ValueError(f"the title must have no control characters, but is {text!r}")
    return text.replace("$", r"\$")


def draw_key(figure: Figure, entries: Sequence[Any] = (), ncols: int = 0) -> None:
    """Draw one key for all panels below them, by default with everything that has a
    label.

    If the key is wider than the page, it gets fewer columns, then shorter lines.
    """
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
    """Make an entry of a key that looks like a plotted line or marker, black by
    default."""
    return Line2D([], [], **{"color": BLACK, **look}, label=label)
