"""How the kernel's functions are compiled and kept: the decorators.

Only the entry points (`outer`) are kept on disk (`solver.compile_cache`), stamped with all files of this
package: what they call is part of them.

What they call is typed and lowered by itself, but becomes machine code in its callers only: optimising it,
and making machine code of it, for each function anew would take as long again. `_Part`, `_OfferToCallers`,
`_PartCompiler` and the option `_nrt` use what Numba keeps to itself, and may have to follow it: they were run
with Numba 0.61.2 and 0.68.1.
"""

from __future__ import annotations

import ctypes
import gc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numba
import numpy as np
from numba import int64
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import LoweringPass, register_pass
from numba.core.typed_passes import NativeLowering

from precursors.solver.compile_cache import kept, stamp

# Numba guards every index that may be negative; unsigned ones, and constants of their kind, save that time.
index = np.uint64
ZERO, ONE, TWO, THREE, FOUR, FIVE, SIX, SEVEN, EIGHT = (np.uint64(n) for n in range(9))
# An index that starts from a literal is typed: what it goes to would be compiled for the literal anew.
INDEX = {"first": int64, "slot": int64}

Function = Callable[..., Any]
# Options and parts that its type hints leave out.
untyped: Any = numba


class _Part(JITCodeLibrary):
    """Code of a function that becomes machine code in its callers only."""

    def _optimize_final_module(self) -> None:
        """Leave it to the callers."""

    def _finalize_final_module(self) -> None:
        """End with what the function and those that it calls are, and no machine code."""
        self._finalize_dynamic_globals()
        self._finalized = True


@register_pass(mutates_CFG=False, analysis_only=False)
class _OfferToCallers(LoweringPass):
    """Let callers find a function that has no machine code of its own; a call from Python is a TypeError."""

    _name = "offer_to_callers"

    def __init__(self) -> None:
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        lowered = state["cr"]
        description = lowered.fndesc
        refuse = ctypes.cast(ctypes.pythonapi.PyErr_BadArgument, ctypes.c_void_p).value
        entry = untyped._dynfunc.make_function(
            description.lookup_module(), description.qualname, "", refuse, lowered.env, (state.library,)
        )
        state.targetctx.insert_user_function(entry, description, [state.library])
        state["cr"] = lowered._replace(cfunc=entry)
        return True


class _PartCompiler(Compiler):
    """Numba's compiler up to the point where machine code would be made."""

    def define_pipelines(self) -> list[Any]:
        state = self.state
        state.flags.no_compile = True
        state.library = _Part(state.targetctx.codegen(), state.func_id.func_qualname)
        [passes] = super().define_pipelines()
        passes.add_pass_after(_OfferToCallers, NativeLowering)
        passes.finalize()
        return [passes]


class _EntryCompiler(Compiler):
    """Numba's compiler; nothing of the millions of objects it makes is garbage before it is done."""

    def compile_extra(self, func: Function) -> Any:
        with _no_garbage_collection():
            return super().compile_extra(func)


@contextmanager
def _no_garbage_collection() -> Iterator[None]:
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


STAMP = stamp(Path(__file__).parent)

# No code counts references (`_nrt`) or allocates, as that takes longer than the arithmetic; so does passing
# arrays to a function: hence what is inlined. Products may be fused with sums, but in the event loop, starts
# and units.
_part: dict[str, Any] = {
    "error_model": "numpy",
    "locals": INDEX,
    "_nrt": False,
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
    "pipeline_class": _PartCompiler,
}
inner: Any = untyped.njit(**_part, fastmath={"contract"}, forceinline=True)
seldom: Any = untyped.njit(**_part, fastmath={"contract"})
unfused: Any = untyped.njit(**_part)
_entry: Any = untyped.njit(
    error_model="numpy",
    nogil=True,
    locals=INDEX,
    _nrt=False,
    no_cfunc_wrapper=True,
    pipeline_class=_EntryCompiler,
)


def outer(function: Function) -> Any:
    """Compile an entry point, which Python calls, and keep it."""
    return kept(_entry(function), STAMP)
