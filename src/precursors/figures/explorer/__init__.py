"""One HTML page to look into runs with: F_X(t), which block slides when, and propagation lengths, linked."""

from precursors.figures.explorer.page import Scene, write_explorer

__all__ = ["Scene", "write_explorer"]
