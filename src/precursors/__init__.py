"""Stick-slip chains solved exactly: precursors of global slip after Maegawa, Suzuki and
Nakano (2010)."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from precursors.audit import audit  # at once, or the room would take its name

if TYPE_CHECKING:
    from precursors.analysis.slips import (
        apparent_friction,
        find_precursors,
        find_slips,
    )
    from precursors.model.chain import Chain
    from precursors.proof import certify
    from precursors.solver.run import Record, Run, RunFileError
    from precursors.solver.simulate import TransitionLimitError, simulate, simulate_many

__all__ = [
    "Chain",
    "Record",
    "Run",
    "RunFileError",
    "TransitionLimitError",
    "apparent_friction",
    "audit",
    "certify",
    "find_precursors",
    "find_slips",
    "simulate",
    "simulate_many",
]

# Imported when first asked for (PEP 562): who checks a configuration or draws a table
# waits for no compiler.
_MODULES = {
    "Chain": "model.chain",
    "Record": "solver.run",
    "Run": "solver.run",
    "RunFileError": "solver.run",
    "TransitionLimitError": "solver.simulate",
    "apparent_friction": "analysis.slips",
    "certify": "proof",
    "find_precursors": "analysis.slips",
    "find_slips": "analysis.slips",
    "simulate": "solver.simulate",
    "simulate_many": "solver.simulate",
}

if (
    not TYPE_CHECKING
):  # a type checker that saw it would take every name for one of this package

    def __getattr__(name: str) -> object:
        if name not in _MODULES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        value = getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
