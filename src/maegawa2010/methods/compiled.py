"""Compilation of the methods."""

from __future__ import annotations

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
# Written into its only caller before that is compiled, not compiled for itself as well.
template = njit(inline="always")
# Python calls these; their code is kept until one of these files is edited.
NAMES = (
    "columns compiled dop853 equations events fixed_step karnopp leapfrog moreau_jean "
    "rk4 rk4_located"
)
COMPILED = [f"{name}.py" for name in NAMES.split()]
outer = entry(Path(__file__).parent, COMPILED, **OPTIONS, nogil=True)
