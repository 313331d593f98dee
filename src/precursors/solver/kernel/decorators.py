"""Decorators of the kernel's compiled functions."""

from pathlib import Path
from typing import Any

from precursors.support.compiled import entry, untyped

_options: dict[str, Any] = {"error_model": "numpy"}
# Numba makes no Python wrapper for these functions, so Python crashes if it calls them.
# Their attribute `py_func` is the original function.
_within = {**_options, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
# `unfused` functions (event loop, starts and units) must not fuse products with sums.
inner: Any = untyped.njit(**_within, fastmath={"contract"}, forceinline=True)
seldom: Any = untyped.njit(**_within, fastmath={"contract"})
unfused: Any = untyped.njit(**_within)
# Parts of the event loop are inlined before it is compiled: compiling one inside the
# other would repeat the work at each level.
part: Any = untyped.njit(**_within, inline="always")
outer = entry(Path(__file__).parent, **_options, nogil=True)
