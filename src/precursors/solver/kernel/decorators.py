"""Decorators of the kernel's compiled functions."""

from pathlib import Path
from typing import Any

from precursors.support.compiled import entry, untyped

_options: dict[str, Any] = {"error_model": "numpy"}
# Numba need not make these functions ready for Python, which then must not call them:
# it would crash. `py_func` is what they were made from.
_within = {**_options, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
# Products may be fused with sums, but not in the event loop, in starts and in units.
inner: Any = untyped.njit(**_within, fastmath={"contract"}, forceinline=True)
seldom: Any = untyped.njit(**_within, fastmath={"contract"})
unfused: Any = untyped.njit(**_within)
# Parts of the event loop become one function before it is compiled: compiling one
# inside the other would do the work again at each level.
part: Any = untyped.njit(**_within, inline="always")
outer = entry(Path(__file__).parent, **_options, nogil=True)
