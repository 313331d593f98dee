"""Stick-slip chains solved exactly: precursors of global slip after Maegawa, Suzuki and Nakano (2010)."""

from precursors.chain import Chain
from precursors.exact import TransitionLimitError, simulate
from precursors.run import Run, RunFileError
from precursors.slips import find_precursors, find_slips

__all__ = [
    "Chain",
    "Run",
    "RunFileError",
    "TransitionLimitError",
    "find_precursors",
    "find_slips",
    "simulate",
]
