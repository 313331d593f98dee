"""Stick-slip chains solved exactly: precursors of global slip after Maegawa, Suzuki and
Nakano (2010).

This is the library, for any chain; the package `maegawa2010` reproduces the paper with it.

    >>> from precursors import Chain, apparent_friction, find_slips, plot, simulate
    >>> run = simulate(Chain.from_slider(theta="-5/6"))  # else as in the paper
    >>> round(apparent_friction(run), 4)
    0.4845
    >>> len(find_slips(run))
    41
    >>> plot(run).savefig("run.png")
"""

from importlib import import_module
from importlib.metadata import version
from typing import TYPE_CHECKING

from precursors.audit import audit  # at once, or the room would take its name

if TYPE_CHECKING:
    from precursors.analysis.load_curve import load_curve
    from precursors.analysis.slips import find_precursors, find_slips, slip_table
    from precursors.analysis.summary import apparent_friction, summarise
    from precursors.figures.run import plot
    from precursors.model.chain import Chain
    from precursors.proof import certify
    from precursors.solver.many import simulate_many
    from precursors.solver.run import Record, Run, RunFileError
    from precursors.solver.simulate import TransitionLimitError, simulate

    __version__: str

# Written out for type checkers and editors.
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
    "load_curve",
    "plot",
    "simulate",
    "simulate_many",
    "slip_table",
    "summarise",
]
# Imported when first asked for (PEP 562): checking a configuration or drawing a table
# must not load the compiler.
_MODULES = {
    "Chain": "model.chain",
    "Record": "solver.run",
    "Run": "solver.run",
    "RunFileError": "solver.run",
    "TransitionLimitError": "solver.simulate",
    "apparent_friction": "analysis.summary",
    "certify": "proof",
    "find_precursors": "analysis.slips",
    "find_slips": "analysis.slips",
    "load_curve": "analysis.load_curve",
    "plot": "figures.run",
    "simulate": "solver.simulate",
    "simulate_many": "solver.many",
    "slip_table": "analysis.slips",
    "summarise": "analysis.summary",
}

# A type checker that saw it would take every name for one of this package.
if not TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        if name == "__version__":
            return version("precursors")
        if name in _MODULES:
            module = import_module(f"{__name__}.{_MODULES[name]}")
            value = globals()[name] = getattr(module, name)
            return value
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
