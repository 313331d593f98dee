"""Shared by the scripts that draw."""

import gc
from collections.abc import Iterable

from matplotlib.figure import Figure

from precursors.figures import style

# looking for garbage among a figure's many objects takes a seventh of the time
gc.disable()


def save(
    figure: Figure, paths: Iterable[str], title: str, look: style.Look = style.LOOK
) -> None:
    """Write a figure to its files; `title` is what a reader of an SVG hears."""
    for path in paths:
        style.save(figure, path, look, title)
