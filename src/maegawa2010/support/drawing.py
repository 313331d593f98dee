"""Saving of figures, shared by the scripts that draw."""

import gc
from collections.abc import Iterable

from matplotlib.figure import Figure

from precursors.figures import style

# A figure has so many objects that the garbage collector would take a seventh of the time.
gc.disable()


def save(
    figure: Figure, paths: Iterable[str], title: str, look: style.Look = style.LOOK
) -> None:
    """Write a figure to its files; `title` is the accessible name of an SVG."""
    for path in paths:
        style.save(figure, path, look, title)
