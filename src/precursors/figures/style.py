"""What the figures share: the style, the colours, reading of tables and writing of files."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager
from fractions import Fraction
from pathlib import Path

import matplotlib
import matplotlib.style
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from precursors.support.files import read_table, write_whole

# Okabe and Ito (2008): told apart by colour-blind readers too.
BLACK = "#000000"
BLUE = "#0072B2"
GREEN = "#009E73"
ORANGE = "#E69F00"
PURPLE = "#CC79A7"
SKY = "#56B4E9"
VERMILION = "#D55E00"
GREY = "#8C8C8C"

# By the sign of theta: larger load at the trailing edge, uniform, at the leading edge.
SIGN_COLORS = {-1: VERMILION, 0: BLACK, 1: BLUE}

MM_PER_M = 1e3
MM_PER_INCH = 25.4
COLUMN_MM = 85.0
PAGE_MM = 178.0
PNG_DPI = 150

SLIP_COLUMNS = {
    "onset_s": float,
    "end_s": float,
    "load_before_N": float,
    "load_after_N": float,
    "front": int,
    "is_global": bool,
    "kept": bool,
}
TRACE_COLUMNS = {"time_s": float, "tangential_load_N": float}

_SETTINGS = {
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "axes.labelsize": 8,
    "axes.linewidth": 0.6,
    "axes.axisbelow": True,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 3,
    "ytick.major.size": 3,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "legend.fontsize": 7,
    "legend.frameon": False,
    "lines.linewidth": 0.8,
    "hatch.linewidth": 0.6,
    # Element ids of an SVG come from this salt instead of a random number.
    "svg.hashsalt": "precursors",
    "svg.fonttype": "path",
}
# Neither the hour nor the release of Matplotlib: the same table gives the same bytes.
_METADATA: dict[str, dict[str, None]] = {"png": {"Software": None}, "svg": {"Date": None, "Creator": None}}


def styled() -> AbstractContextManager[None]:
    """Enter the settings in which figures are made and written; a matplotlibrc of the user has no say."""
    return matplotlib.style.context(_SETTINGS, after_reset=True)


def inches(millimetres: float) -> float:
    """Convert a length on paper from mm to inches."""
    return millimetres / MM_PER_INCH


def new_figure(width_mm: float, height_mm: float) -> Figure:
    """Make an empty figure of a given size [mm], to be finished by `lay_out`."""
    return Figure(figsize=(inches(width_mm), inches(height_mm)), dpi=PNG_DPI, facecolor="white")


def lay_out(figure: Figure) -> None:
    """Make room for the labels, once and for all: a layout done anew for each file would differ by a hair."""
    ConstrainedLayoutEngine().execute(figure)


def save(figure: Figure, path: str | Path) -> None:
    """Write a figure as PNG (150 dpi) or SVG, whole or not at all, with the same bytes every time.

    Raises
    ------
    ValueError
        If the name ends neither in .png nor in .svg.
    """
    path = Path(path)
    kind = path.suffix.removeprefix(".").lower()
    if kind not in _METADATA:
        raise ValueError(f"figure {path} has the ending {path.suffix!r}: allowed are .png and .svg")
    with styled(), write_whole(path) as temporary:
        figure.savefig(temporary, format=kind, dpi=PNG_DPI, metadata=_METADATA[kind])


def read_slips(path: str | Path) -> pd.DataFrame:
    """Read a slip table (tables/{scene}_slips.csv); an unfinished event has end_s = NaN.

    Raises
    ------
    ValueError
        If a column is missing or holds something else than it should.
    """
    return read_columns(path, SLIP_COLUMNS)


def read_trace(path: str | Path) -> pd.DataFrame:
    """Read a trace (tables/{scene}_trace.csv): straight lines between its rows draw the tangential load.

    Raises
    ------
    ValueError
        If a column is missing or holds something else than it should.
    """
    return read_columns(path, TRACE_COLUMNS)


def fraction_text(value: float) -> str:
    """Write a number as a fraction if it has a small denominator (-5/6), else as a decimal number."""
    fraction = Fraction(value).limit_denominator(12)
    return str(fraction) if abs(float(fraction) - value) < 1e-12 else f"{value:.4g}"


def theta_text(theta: float) -> str:
    """Write theta as mathematics."""
    return rf"$\theta = {fraction_text(theta)}$"


def theta_color(theta: float) -> str:
    """Colour of a scene by the sign of its theta."""
    return SIGN_COLORS[int(theta > 0) - int(theta < 0)]


def plain(text: str) -> str:
    """Keep Matplotlib from reading a dollar sign in a user's text as mathematics."""
    return text.replace("$", r"\$")


def read_columns(path: str | Path, columns: Mapping[str, type]) -> pd.DataFrame:
    """Read a table that has at least some columns, of some types.

    Raises
    ------
    ValueError
        If a column is missing or holds something else than it should.
    """
    return read_table(path, columns)
