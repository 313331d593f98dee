"""Compilation of the methods."""

from pathlib import Path
from typing import Any

from numba import int64, njit

from precursors.support.compiled import entry

# Calls are expensive: Numba counts references to all arrays of a tuple. So functions
# called in every step are `inner`, that is, inlined. Slices are assigned in loops,
# because Numba would compile error messages with each assignment. An `apart` function
# declares the type of `first`; otherwise it would be compiled again for a literal.
OPTIONS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}}
apart = njit(**OPTIONS, locals={"first": int64})
inner = njit(**OPTIONS, forceinline=True)
# Numba inlines it into its only caller.
template = njit(inline="always")
# Python calls `outer` functions; they are cached until a file of this folder changes.
FOLDER = Path(__file__).parent
outer = entry(FOLDER, **OPTIONS, nogil=True)
