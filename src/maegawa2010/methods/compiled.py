"""Compilation of the methods."""

from pathlib import Path
from typing import Any

from numba import int64, njit

from precursors.support.compiled import entry

# Numba counts references to all arrays of a tuple at each call, which costs more than a
# step. So what is called in every step is inlined. Assignments to slices are loops
# here: Numba compiles their errors' texts. A function is compiled anew for a literal
# number, unless its variable has a type.
OPTIONS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}}
apart = njit(**OPTIONS, locals={"first": int64})
inner = njit(**OPTIONS, forceinline=True)
# Numba inlines it into its only caller.
template = njit(inline="always")
# Python calls these; their code is kept until a file of this directory is edited.
FOLDER = Path(__file__).parent
outer = entry(FOLDER, **OPTIONS, nogil=True)
