"""The run of a larger chain."""

from precursors.solver.run import SteppedRun as LargerRun

__all__ = ["LargerRun"]
