"""Compilation of the methods."""

from pathlib import Path
from typing import Any

from numba import int64, njit

from precursors.support.compiled import entry

# Calls are expensive, because Numba counts references to all arrays of a tuple. Functions
# called in every step are therefore inlined (`inner`). Slices are assigned in loops,
# because Numba would compile error messages with each assignment. An `apart` function is
# compiled only once, because the type of its argument `first` is declared.
OPTIONS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}}
apart = njit(**OPTIONS, locals={"first": int64})
inner = njit(**OPTIONS, forceinline=True)
# Numba inlines a template into its only caller.
template = njit(inline="always")
# Python calls `outer` functions; they are cached until a file of this folder changes.
FOLDER = Path(__file__).parent
outer = entry(FOLDER, **OPTIONS, nogil=True)
