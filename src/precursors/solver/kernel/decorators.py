"""Decorators of the kernel's compiled functions."""

from pathlib import Path
from typing import Any

from numba import int64

from precursors.support.compiled import entry, untyped

# Numba compiles a function anew for an argument that is a literal number, unless its
# variable has a type.
INDEX = dict.fromkeys(("block_1", "first_row", "last_row"), int64)
_options: dict[str, Any] = {"error_model": "numpy", "locals": INDEX}
# Products may be fused with sums, but not in the event loop, in starts and in units.
inner: Any = untyped.njit(**_options, fastmath={"contract"}, forceinline=True)
seldom: Any = untyped.njit(**_options, fastmath={"contract"})
inner_unfused: Any = untyped.njit(**_options, forceinline=True)
unfused: Any = untyped.njit(**_options)
outer = entry(Path(__file__).parent, **_options, nogil=True)
